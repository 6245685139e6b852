//! Rules as they stand in a TOML file.

use std::ops::Range;
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};
use serde::Deserialize;
use solid3d::Response;
use solid3d::convex::MAGNITUDE_MAX;
use solid3d::glam::DVec3;
use solid3d::query::Ray;
use toml::Spanned;

use super::pattern::Pattern;
use crate::rays::NamedRay;
use crate::text;

/// The most bytes of a file of rules: the parser takes up to 75 times as many.
const BYTES_MAX: u64 = 1 << 24;

/// The rules of a file, in its order.
#[derive(Debug, Default)]
pub struct Rules {
    pub(super) default: Option<Response>,
    pub(super) solid: Vec<Names>,
    pub(super) decompose: Vec<Names>,
    pub(super) clearance: Option<f64>,
    pub(super) objects: Vec<ObjectRule>,
    pub(super) pairs: Vec<PairRule>,
    pub(super) rays: Vec<NamedRay>,
}

/// What is wanted of all pairs with some objects.
#[derive(Debug)]
pub(super) struct ObjectRule {
    pub name: Names,
    pub response: Response,
}

/// What is wanted of the pairs of some objects with others.
#[derive(Debug)]
pub(super) struct PairRule {
    pub a: Names,
    pub b: Names,
    /// One of the two there is.
    pub response: Option<Response>,
    pub clearance: Option<f64>,
}

/// A pattern, with where it stands.
#[derive(Debug)]
pub(super) struct Names {
    pub pattern: Pattern,
    pub text: String,
    /// `rules.toml:7`
    pub place: String,
}

impl Names {
    fn new(text: String, place: String) -> Self {
        Names { pattern: Pattern::new(&text), text, place }
    }
}

impl Rules {
    /// Reads a file.
    pub fn read(path: &Path) -> Result<Rules> {
        let text = text::read(path, BYTES_MAX)?;
        Rules::parse(path, &text)
    }

    /// Adds objects that are to be solid, as the command line names them.
    pub fn declare_solid(&mut self, patterns: &[String]) {
        self.solid.extend(given("--solid", patterns));
    }

    /// Adds objects that are to be decomposed, as the command line names them.
    pub fn declare_decomposed(&mut self, patterns: &[String]) {
        self.decompose.extend(given("--decompose", patterns));
    }

    /// The rays that are to be cast in every frame.
    pub fn rays(&self) -> &[NamedRay] {
        &self.rays
    }

    /// Whether the response of some pair may tell a depth; `default` overrides that of the rules.
    pub fn tell_depth(&self, default: Option<Response>) -> bool {
        self.responses(default).any(|response| matches!(response, Response::Depth | Response::Contacts))
    }

    /// Whether the response of some pair may tell any number of points; `default` overrides that of the rules.
    pub fn tell_many_points(&self, default: Option<Response>) -> bool {
        self.responses(default).any(|response| matches!(response, Response::Curve | Response::Contacts))
    }

    /// The responses that pairs may have; `default` overrides that of the rules.
    fn responses(&self, default: Option<Response>) -> impl Iterator<Item = Response> {
        let of_objects = self.objects.iter().map(|rule| rule.response);
        let of_pairs = self.pairs.iter().filter_map(|rule| rule.response);
        default.or(self.default).into_iter().chain(of_objects).chain(of_pairs)
    }

    /// The rules of a text; `path` is where it is from, for messages.
    pub(super) fn parse(path: &Path, text: &str) -> Result<Rules> {
        let source = Source::new(path, text);
        let written: Written = toml::from_str(text).map_err(|error| source.fault(&error))?;
        let object = |rule: WrittenObject| ObjectRule {
            name: source.names(rule.name),
            response: rule.response.into(),
        };
        for clearance in
            written.pair.iter().filter_map(|pair| pair.clearance.as_ref()).chain(&written.clearance)
        {
            source.check_clearance(clearance)?;
        }
        Ok(Rules {
            default: written.default.map(Response::from),
            clearance: written.clearance.map(Spanned::into_inner),
            solid: written.solid.into_iter().map(|text| source.names(text)).collect(),
            decompose: written.decompose.into_iter().map(|text| source.names(text)).collect(),
            objects: written.object.into_iter().map(object).collect(),
            pairs: written.pair.into_iter().map(|pair| source.pair(pair)).collect::<Result<_>>()?,
            rays: written.ray.into_iter().map(|ray| source.ray(ray)).collect::<Result<_>>()?,
        })
    }
}

/// The patterns of an option of the command line.
fn given<'a>(option: &'a str, patterns: &'a [String]) -> impl Iterator<Item = Names> + 'a {
    patterns.iter().map(move |text| Names::new(text.clone(), option.to_owned()))
}

/// Where a text is from, and where its lines end.
struct Source {
    path: PathBuf,
    line_ends: Vec<usize>,
}

impl Source {
    fn new(path: &Path, text: &str) -> Self {
        let line_ends = text.match_indices('\n').map(|(end, _)| end).collect();
        Source { path: path.to_owned(), line_ends }
    }

    fn names(&self, text: Spanned<String>) -> Names {
        let place = self.place(text.span());
        Names::new(text.into_inner(), place)
    }

    fn check_clearance(&self, clearance: &Spanned<f64>) -> Result<()> {
        let value = *clearance.get_ref();
        if (0.0..=MAGNITUDE_MAX).contains(&value) {
            return Ok(());
        }
        let place = self.place(clearance.span());
        Err(anyhow!("{place}: clearance is {value}; expected a length from 0 to {MAGNITUDE_MAX:e}"))
    }

    fn pair(&self, WrittenPair { a, b, response, clearance }: WrittenPair) -> Result<PairRule> {
        let (response, clearance) = (response.map(Response::from), clearance.map(Spanned::into_inner));
        let (a, b) = (self.names(a), self.names(b));
        if response.is_none() && clearance.is_none() {
            return Err(anyhow!("{}: a pair needs a response or a clearance", a.place));
        }
        Ok(PairRule { a, b, response, clearance })
    }

    fn ray(&self, written: WrittenRay) -> Result<NamedRay> {
        let WrittenRay { name, origin, direction, to } = written;
        let place = self.place(name.span());
        let origin = DVec3::from(origin);
        let ray = match (direction, to) {
            (Some(direction), None) => Ray::new(origin, direction.into()),
            (None, Some(to)) if origin == to.into() => {
                return Err(anyhow!("{place}: the end of a ray (to) is its origin"));
            }
            (None, Some(to)) => Ray::segment(origin, to.into()),
            (Some(_), Some(_)) => {
                return Err(anyhow!("{place}: a ray has a direction or an end (to), not both"));
            }
            (None, None) => return Err(anyhow!("{place}: a ray needs a direction or an end (to)")),
        };
        NamedRay::new(name.into_inner(), ray, place)
    }

    fn fault(&self, error: &toml::de::Error) -> anyhow::Error {
        let place = error.span().map_or_else(|| self.path.display().to_string(), |span| self.place(span));
        let message = error.message().replace('\n', "; ");
        let instead = match message.strip_suffix(", expected a sequence") {
            Some("invalid type: map") => "; rules begin with two brackets, as in [[object]]",
            Some(_) => "; lists stand in brackets, as in [\"ship*\"]",
            None => "",
        };
        anyhow!("{place}: {message}{instead}")
    }

    fn place(&self, span: Range<usize>) -> String {
        let line = 1 + self.line_ends.partition_point(|&end| end < span.start);
        format!("{}:{line}", self.path.display())
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Written {
    default: Option<WrittenResponse>,
    clearance: Option<Spanned<f64>>,
    #[serde(default)]
    solid: Vec<Spanned<String>>,
    #[serde(default)]
    decompose: Vec<Spanned<String>>,
    #[serde(default)]
    object: Vec<WrittenObject>,
    #[serde(default)]
    pair: Vec<WrittenPair>,
    #[serde(default)]
    ray: Vec<WrittenRay>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenObject {
    name: Spanned<String>,
    response: WrittenResponse,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenPair {
    a: Spanned<String>,
    b: Spanned<String>,
    response: Option<WrittenResponse>,
    clearance: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WrittenRay {
    name: Spanned<String>,
    origin: [f64; 3],
    direction: Option<[f64; 3]>,
    to: Option<[f64; 3]>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum WrittenResponse {
    Ignore,
    Simple,
    Witness,
    Smart,
    Curve,
    Depth,
    Contacts,
}

impl From<WrittenResponse> for Response {
    fn from(response: WrittenResponse) -> Response {
        match response {
            WrittenResponse::Ignore => Response::Ignore,
            WrittenResponse::Simple => Response::Simple,
            WrittenResponse::Witness => Response::Witness,
            WrittenResponse::Smart => Response::Smart,
            WrittenResponse::Curve => Response::Curve,
            WrittenResponse::Depth => Response::Depth,
            WrittenResponse::Contacts => Response::Contacts,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Rules> {
        Rules::parse(Path::new("rules.toml"), text)
    }

    #[test]
    fn rules_keep_their_order_and_place() {
        let rules = parse(
            "default = \"smart\"\n\n[[object]]\nname = \"mine*\"\nresponse = \"ignore\"\n\
             [[pair]]\na = \"x\"\nb = \"y\"\nresponse = \"simple\"\n",
        )
        .expect("the rules are well formed");
        assert_eq!(rules.default, Some(Response::Smart));
        assert_eq!(
            (rules.objects[0].name.place.as_str(), rules.objects[0].response),
            ("rules.toml:4", Response::Ignore)
        );
        assert_eq!((rules.pairs[0].b.text.as_str(), rules.pairs[0].b.place.as_str()), ("y", "rules.toml:8"));
    }

    /// The option is in the place of the default, and of nothing else.
    #[test]
    fn what_responses_tell_is_told_by_those_that_pairs_may_have() {
        let depths = |text: &str, option| parse(text).expect("the rules are well formed").tell_depth(option);
        assert!(
            depths("default = \"depth\"", None) && !depths("default = \"depth\"", Some(Response::Simple))
        );
        assert!(
            !depths("default = \"simple\"", None) && depths("default = \"simple\"", Some(Response::Contacts))
        );
        let object = "[[object]]\nname = \"x\"\nresponse = \"depth\"";
        assert!(depths(object, Some(Response::Simple)));
    }

    #[test]
    fn mistakes_name_their_line_and_what_was_expected() {
        for (text, expected) in [
            (
                "default = \"none\"",
                "rules.toml:1: unknown variant `none`, expected one of `ignore`, `simple`",
            ),
            (
                "\ncolour = 1",
                "rules.toml:2: unknown field `colour`, expected one of `default`, `clearance`, `solid`, `decompose`, `object`, `pair`, `ray`",
            ),
            ("[[object]]\nname = \"x\"", "rules.toml:1: missing field `response`"),
            ("[[pair]]\na = \"x\"\nb = 3\nresponse = \"simple\"", "rules.toml:3: invalid type: integer"),
            ("[[pair]\n", "rules.toml:1: "),
            ("\nclearance = -0.5", "rules.toml:2: clearance is -0.5; expected a length from 0 to 1e100"),
            (
                "[[pair]]\na = \"x\"\nb = \"y\"\nresponse = \"simple\"\nclearance = nan",
                "rules.toml:5: clearance is NaN; expected a length",
            ),
            ("\n[[pair]]\na = \"x\"\nb = \"y\"", "rules.toml:3: a pair needs a response or a clearance"),
            ("object = 3", "rules.toml:1: invalid type: integer"),
            (
                "\n[object]\nname = \"x\"",
                "rules.toml:2: invalid type: map, expected a sequence; rules begin with two brackets, as in [[object]]",
            ),
            (
                "solid = \"x\"",
                "rules.toml:1: invalid type: string \"x\", expected a sequence; lists stand in brackets, as in [\"ship*\"]",
            ),
            ("[[ray]]\nname = \"x\"\norigin = [0, 0, 0]", "rules.toml:2: a ray needs a direction or an end"),
            (
                "[[ray]]\nname = \"x\"\norigin = [0, 0, 0]\nto = [1, 0, 0]\ndirection = [1, 0, 0]",
                "rules.toml:2: a ray has a direction or an end (to), not both",
            ),
            (
                "[[ray]]\nname = \"x\"\norigin = [0, 0, 0]\ndirection = [0, 0, 0]",
                "rules.toml:2: ray.direction is (0.0, 0.0, 0.0)",
            ),
            (
                "[[ray]]\nname = \"x\"\norigin = [0, 0, 1]\nto = [0, 0, 1]",
                "rules.toml:2: the end of a ray (to) is its origin",
            ),
            ("[[ray]]\nname = \"x\"\norigin = [0, 0]\nto = [0, 0, 1]", "rules.toml:3: invalid length 2"),
        ] {
            let error = format!("{:#}", parse(text).expect_err(text));
            assert!(error.starts_with(expected) && !error.contains('\n'), "{text}: {error}");
        }
    }

    /// Every rule has a place; to find it takes no time in proportion to what is before it, or these would take minutes.
    #[test]
    fn many_rules_have_their_lines() {
        let rule = "[[pair]]\na = \"a\"\nb = \"b\"\nresponse = \"simple\"\n";
        let count = 100_000;
        let rules = parse(&rule.repeat(count)).expect("the rules are well formed");
        assert_eq!(rules.pairs[count - 1].b.place, format!("rules.toml:{}", 4 * count - 1));
    }

    #[test]
    fn no_text_panics() {
        for text in ["\u{feff}", "[[object]]\nname=\"ü", "default = \"\\ud800\"", "\0", "[[object]]\r\nname"]
        {
            assert!(parse(text).is_err() || text == "\u{feff}", "{text:?}");
        }
    }
}
