//! Bringing rules into a world's response table.

use anyhow::{Result, bail};
use solid3d::{ObjectId, Response, World};

use super::file::{Names, PairRule, Rules};
use super::names::NameIndex;

/// How many pairs of objects the rules for pairs may make: each is an entry of the world's table, of some 100 bytes. A rule
/// for all pairs (`*` with `*`) makes none.
const PAIRS_MAX: usize = 10_000_000;

/// The objects that rules are about, by their place in the scene.
pub struct Objects<'a> {
    /// Unique.
    pub names: &'a [&'a str],
    pub ids: &'a [ObjectId],
    /// Pairs that are not tested unless a rule for the pair says so.
    pub exempt: &'a [(usize, usize)],
}

/// The places of the objects whose mesh rules want to be something else, each once.
#[derive(Debug)]
pub struct Bodies {
    /// The solid that it bounds.
    pub solid: Vec<usize>,
    /// A union of convex pieces.
    pub decomposed: Vec<usize>,
}

/// What rules want the objects to be, and warnings, for patterns that match nothing. What has a name of its own is wanted whatever it is.
pub fn bodies(
    rules: &Rules,
    names: &[&str],
    is_mesh: impl Fn(usize) -> bool,
) -> Result<(Bodies, Vec<String>)> {
    let mut index = NameIndex::new(names);
    let mut places = |wanted: &[Names]| -> Result<Vec<usize>> {
        let (mut places, mut is_found) = (Vec::new(), vec![false; names.len()]);
        for wanted in wanted {
            let found = index.meshes_matching(wanted, &is_mesh)?.into_iter();
            places.extend(found.filter(|&place| !std::mem::replace(&mut is_found[place], true)));
        }
        Ok(places)
    };
    let bodies = Bodies { solid: places(&rules.solid)?, decomposed: places(&rules.decompose)? };
    Ok((bodies, index.into_warnings()))
}

/// Sets the responses of a world. Returns warnings, for patterns that match nothing.
pub fn apply(
    rules: &Rules,
    default: Option<Response>,
    objects: &Objects,
    world: &mut World,
) -> Result<Vec<String>> {
    let mut index = NameIndex::new(objects.names);
    // A rule for all pairs overrides all that is before and below it, without an entry for each pair.
    let of_all = rules.pairs.iter().enumerate().rev().filter(|(_, rule)| is_universal(rule));
    let of_all = of_all.filter_map(|(i, rule)| Some((i, rule.response?))).next();
    let default = default.or(rules.default).unwrap_or(Response::Witness);
    world.set_default_response(of_all.map_or(default, |(_, response)| response));
    // One after the other: what all of them match may be any number of objects for each.
    for rule in &rules.objects {
        let found = index.matching(&rule.name)?;
        for object in found.into_iter().filter(|_| of_all.is_none()) {
            world.set_object_response(objects.ids[object], rule.response)?;
        }
    }
    for &(a, b) in objects.exempt.iter().filter(|_| of_all.is_none()) {
        world.clear_pair_response(objects.ids[a], objects.ids[b])?;
    }
    let mut count = PairCount::default();
    for (i, rule) in rules.pairs.iter().enumerate() {
        let paired = Paired::find(rule, &mut index)?;
        let is_overridden = of_all.is_some_and(|(of_all, _)| i <= of_all);
        let Some(response) = rule.response.filter(|_| !is_overridden) else { continue };
        for (a, b) in paired.pairs(objects.ids, &mut count)? {
            world.set_pair_response(a, b, response)?;
        }
    }
    Ok(index.into_warnings())
}

/// Sets the clearances of a world; `default` overrides that of the rules. Returns the greatest, if there is any. Of the rules for a pair the
/// last that has a clearance holds. [`apply`] warns of patterns that match nothing.
pub fn set_clearances(
    rules: &Rules,
    default: Option<f64>,
    objects: &Objects,
    world: &mut World,
) -> Result<Option<f64>> {
    let default = default.or(rules.clearance);
    world.set_clearance(default.unwrap_or(0.0))?;
    let mut index = NameIndex::new(objects.names);
    let mut greatest = default;
    let mut count = PairCount::default();
    for rule in &rules.pairs {
        let Some(clearance) = rule.clearance else { continue };
        greatest = Some(greatest.map_or(clearance, |greatest| greatest.max(clearance)));
        for (a, b) in Paired::find(rule, &mut index)?.pairs(objects.ids, &mut count)? {
            world.set_pair_clearance(a, b, clearance)?;
        }
    }
    Ok(greatest)
}

fn is_universal(rule: &PairRule) -> bool {
    rule.a.pattern.is_universal() && rule.b.pattern.is_universal()
}

/// A rule for pairs, with the objects that its two sides name.
struct Paired<'a> {
    rule: &'a PairRule,
    these: Vec<usize>,
    those: Vec<usize>,
}

impl<'a> Paired<'a> {
    fn find(rule: &'a PairRule, index: &mut NameIndex) -> Result<Self> {
        let (these, those) = (index.matching(&rule.a)?, index.matching(&rule.b)?);
        if rule.a.pattern.is_name() && rule.a.text == rule.b.text && !these.is_empty() {
            index.note_one_object(&rule.a);
        }
        Ok(Paired { rule, these, those })
    }

    /// The pairs of objects, unless they make too many.
    fn pairs(
        &self,
        ids: &'a [ObjectId],
        count: &mut PairCount,
    ) -> Result<impl Iterator<Item = (ObjectId, ObjectId)> + use<'_, 'a>> {
        count.add(self)?;
        Ok(self.these.iter().flat_map(move |&a| {
            let others = self.those.iter().filter(move |&&b| b != a);
            others.map(move |&b| (ids[a], ids[b]))
        }))
    }
}

/// How many pairs of objects rules for pairs made.
#[derive(Default)]
struct PairCount(usize);

impl PairCount {
    fn add(&mut self, Paired { rule, these, those }: &Paired) -> Result<()> {
        self.0 = self.0.saturating_add(these.len().saturating_mul(those.len()));
        if self.0 > PAIRS_MAX {
            let place = &rule.a.place;
            bail!("{place}: the rules for pairs make {} pairs so far; the limit is {PAIRS_MAX}", self.0);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use solid3d::Shape;
    use solid3d::glam::DAffine3;

    use super::*;

    /// A world of some objects, with rules.
    struct Case {
        world: World,
        ids: Vec<ObjectId>,
        warnings: Vec<String>,
    }

    const NAMES: [&str; 4] = ["ship", "mine1", "mine2", "sweeper"];

    fn case(rules: &str, default: Option<Response>, exempt: &[(usize, usize)]) -> Case {
        let mut world = World::new();
        let ball = Shape::sphere(1.0).expect("the radius is fine");
        let add = |_: &&str| world.add(&ball, DAffine3::IDENTITY).expect("the placement is fine");
        let ids: Vec<_> = NAMES.iter().map(add).collect();
        let rules = Rules::parse(Path::new("r.toml"), rules).expect("the rules are well formed");
        let objects = Objects { names: &NAMES, ids: &ids, exempt };
        let warnings = apply(&rules, default, &objects, &mut world).expect("the rules are few");
        Case { world, ids, warnings }
    }

    impl Case {
        fn of(&self, a: usize, b: usize) -> Response {
            self.world.response(self.ids[a], self.ids[b]).expect("both are there")
        }
    }

    #[test]
    fn pair_goes_before_object_and_object_before_default() {
        let case = case(
            "default = \"simple\"\n[[object]]\nname = \"mine*\"\nresponse = \"ignore\"\n\
             [[pair]]\na = \"sweeper\"\nb = \"mine?\"\nresponse = \"smart\"",
            None,
            &[],
        );
        assert_eq!(case.of(0, 3), Response::Simple);
        assert_eq!(case.of(0, 1), Response::Ignore);
        assert_eq!(case.of(2, 3), Response::Smart);
        assert!(case.warnings.is_empty());
    }

    #[test]
    fn later_rules_override_earlier_ones() {
        let object = |response| format!("[[object]]\nname = \"ship\"\nresponse = \"{response}\"\n");
        let case = case(&(object("ignore") + &object("smart")), None, &[]);
        assert_eq!(case.of(0, 3), Response::Smart);
    }

    #[test]
    fn the_command_line_overrides_the_default() {
        let case = case("default = \"simple\"", Some(Response::Smart), &[]);
        assert_eq!(case.of(0, 1), Response::Smart);
    }

    #[test]
    fn without_rules_it_is_witness() {
        assert_eq!(case("", None, &[]).of(0, 1), Response::Witness);
    }

    #[test]
    fn a_root_path_is_exempt_unless_a_pair_rule_says_otherwise() {
        let objects = "[[object]]\nname = \"*\"\nresponse = \"simple\"\n";
        let case_of = |pair: &str| case(&format!("{objects}{pair}"), None, &[(0, 1), (2, 3)]);
        assert_eq!(case_of("").of(0, 1), Response::Ignore);
        let case = case_of("[[pair]]\na = \"mine1\"\nb = \"ship\"\nresponse = \"smart\"");
        assert_eq!((case.of(0, 1), case.of(2, 3)), (Response::Smart, Response::Ignore));
    }

    #[test]
    fn a_rule_for_all_pairs_is_one_for_each() {
        let before = "[[object]]\nname = \"ship\"\nresponse = \"simple\"\n\
                      [[pair]]\na = \"ship\"\nb = \"sweeper\"\nresponse = \"ignore\"\n";
        let after = "[[pair]]\na = \"mine1\"\nb = \"mine2\"\nresponse = \"witness\"\n";
        let universal = "[[pair]]\na = \"*\"\nb = \"*\"\nresponse = \"smart\"\n";
        let spelled = "[[pair]]\na = \"*?\"\nb = \"*?\"\nresponse = \"smart\"\n";
        let quick = case(&format!("{before}{universal}{after}"), None, &[(0, 1)]);
        let slow = case(&format!("{before}{spelled}{after}"), None, &[(0, 1)]);
        for (a, b) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            assert_eq!(quick.of(a, b), slow.of(a, b), "{a} {b}");
        }
        assert_eq!((quick.of(0, 3), quick.of(1, 2)), (Response::Smart, Response::Witness));
    }

    #[test]
    fn the_greatest_clearance_is_told() {
        let names = ["a", "b"];
        let rule = |clearance: f64| format!("[[pair]]\na = \"a\"\nb = \"b\"\nclearance = {clearance}\n");
        let greatest = |text: &str, default| {
            let mut world = World::new();
            let ball = Shape::sphere(1.0).expect("the radius is fine");
            let ids = names.map(|_| world.add(&ball, DAffine3::IDENTITY).expect("the placement is fine"));
            let rules = Rules::parse(Path::new("r.toml"), text).expect("the rules are well formed");
            let objects = Objects { names: &names, ids: &ids, exempt: &[] };
            set_clearances(&rules, default, &objects, &mut world).expect("the rules are few")
        };
        assert_eq!(greatest("", None), None);
        for (text, default, expected) in [
            (rule(2.0) + &rule(1.0), None, 2.0),
            (rule(1.0) + &rule(2.0), None, 2.0),
            (rule(1.0), Some(3.0), 3.0),
            ("clearance = 2.0\n".to_owned() + &rule(1.0), None, 2.0),
            ("clearance = 2.0\n".to_owned() + &rule(1.0), Some(0.5), 1.0),
        ] {
            assert_eq!(greatest(&text, default), Some(expected), "{text}, {default:?}");
        }
    }

    #[test]
    fn rules_that_make_too_many_pairs_are_refused_before_they_do() {
        let names: Vec<String> = (0..3200).map(|i| i.to_string()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let ids = vec![ObjectId::default(); names.len()];
        let objects = Objects { names: &names, ids: &ids, exempt: &[] };
        let rules = |a: &str| {
            let text = format!("[[pair]]\na = \"{a}\"\nb = \"*\"\nresponse = \"smart\"");
            Rules::parse(Path::new("r.toml"), &text).expect("the rules are well formed")
        };
        let error = apply(&rules("*?"), None, &objects, &mut World::new()).expect_err("10 million pairs");
        assert!(
            error.to_string().starts_with("r.toml:2: the rules for pairs make 10240000 pairs"),
            "{error}"
        );
        assert!(apply(&rules("*"), None, &objects, &mut World::new()).is_ok());
    }

    #[test]
    fn patterns_that_match_nothing_are_named() {
        let case = case(
            "[[object]]\nname = \"shpi\"\nresponse = \"ignore\"\n[[pair]]\na = \"x*\"\nb = \"ship\"\nresponse = \"ignore\"",
            None,
            &[],
        );
        let expected = [
            "r.toml:2: \"shpi\" matches no object; did you mean \"ship\"?",
            "r.toml:5: \"x*\" matches no object",
        ];
        assert_eq!(case.warnings, expected);
    }

    /// However often a rule is given again, what it matches is kept once.
    #[test]
    fn bodies_are_there_once() {
        let text = format!("solid = [{}]\ndecompose = [\"*2\", \"mine2\"]", "\"mine*\",".repeat(3));
        let rules = Rules::parse(Path::new("r.toml"), &text).expect("the rules are well formed");
        let (Bodies { solid, decomposed }, _) = bodies(&rules, &NAMES, |_| true).expect("the names are few");
        assert_eq!((solid, decomposed), (vec![1, 2], vec![2]));
    }

    /// Many names beside many objects take no minutes.
    #[test]
    fn of_many_names_that_match_nothing_the_first_have_hints() {
        let rule = |i: usize| format!("[[object]]\nname = \"shpi{i}\"\nresponse = \"ignore\"\n");
        let warnings = case(&(0..25).map(rule).collect::<String>(), None, &[]).warnings;
        let have: Vec<bool> = warnings.iter().map(|warning| warning.contains("did you mean")).collect();
        assert_eq!(have, [[true; 20].as_slice(), &[false; 5]].concat());
    }

    #[test]
    fn long_patterns_are_told_by_their_beginning() {
        let rule = format!("[[object]]\nname = \"{}\"\nresponse = \"ignore\"\n", "x*".repeat(100));
        let told = format!("r.toml:2: \"{}\"... matches no object", "x*".repeat(40));
        assert_eq!(case(&rule, None, &[]).warnings, [told]);
    }

    #[test]
    fn a_pair_of_one_object_is_named() {
        let of = |a: &str, b: &str| {
            case(&format!("[[pair]]\na = \"{a}\"\nb = \"{b}\"\nresponse = \"ignore\""), None, &[]).warnings
        };
        assert_eq!(of("ship", "ship"), ["r.toml:2: a and b are both \"ship\"; a pair needs two objects"]);
        assert_eq!(of("ship*", "ship*"), [""; 0]); // there may be others in another scene
        let of_none = of("x", "x");
        assert!(of_none.iter().all(|warning| warning.contains("\"x\" matches no object")), "{of_none:?}");
    }
}
