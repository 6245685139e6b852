//! Bringing rules into a world's response table.

use anyhow::{Result, bail};
use solid3d::{ObjectId, Response, World};

use super::file::{PairRule, Rules};
use super::names::NameIndex;

/// How many pairs of objects the rules for pairs may name: each becomes an entry of the world's table, of some 100 bytes.
const PAIRS_MAX: usize = 10_000_000;

/// The objects that rules are about, by their place in the scene.
pub struct Objects<'a> {
    /// Unique.
    pub names: &'a [&'a str],
    pub ids: &'a [ObjectId],
    /// Pairs that are not tested unless a rule for the pair says so.
    pub exempt: &'a [(usize, usize)],
}

/// Sets the responses of a world. Returns warnings, for patterns that match nothing.
pub fn apply(
    rules: &Rules,
    default: Option<Response>,
    objects: &Objects,
    world: &mut World,
) -> Result<Vec<String>> {
    let index = NameIndex::new(objects.names);
    let mut warnings = Vec::new();
    let named: Vec<_> = rules.objects.iter().map(|rule| index.matching(&rule.name)).collect();
    let paired: Vec<_> =
        rules.pairs.iter().map(|rule| [&rule.a, &rule.b].map(|names| index.matching(names))).collect();
    let sides = rules
        .pairs
        .iter()
        .zip(&paired)
        .flat_map(|(rule, found)| [(&rule.a, &found[0]), (&rule.b, &found[1])]);
    let all = rules.objects.iter().map(|rule| &rule.name).zip(&named).chain(sides);
    warnings.extend(all.filter(|(_, found)| found.is_empty()).map(|(names, _)| index.nothing_matches(names)));

    // A rule for all pairs overrides all that is below it, without an entry for each pair.
    let universal = rules.pairs.iter().rposition(is_universal);
    match universal {
        Some(rule) => world.set_default_response(rules.pairs[rule].response),
        None => {
            world.set_default_response(default.or(rules.default).unwrap_or(Response::Witness));
            for (rule, found) in rules.objects.iter().zip(&named) {
                for &object in found {
                    world.set_object_response(objects.ids[object], rule.response)?;
                }
            }
            for &(a, b) in objects.exempt {
                world.clear_pair_response(objects.ids[a], objects.ids[b])?;
            }
        }
    }
    let first = universal.map_or(0, |rule| rule + 1);
    set_pairs(&rules.pairs[first..], &paired[first..], objects.ids, world)?;
    Ok(warnings)
}

fn is_universal(rule: &PairRule) -> bool {
    rule.a.pattern.is_universal() && rule.b.pattern.is_universal()
}

/// Sets the responses of pairs; `paired` are the objects that the two sides of each rule name.
fn set_pairs(
    rules: &[PairRule],
    paired: &[[Vec<usize>; 2]],
    ids: &[ObjectId],
    world: &mut World,
) -> Result<()> {
    let mut count = 0usize;
    for (rule, [these, those]) in rules.iter().zip(paired) {
        count = count.saturating_add(these.len().saturating_mul(those.len()));
        if count > PAIRS_MAX {
            let place = &rule.a.place;
            bail!(
                "{place}: the rules for pairs name {count} pairs so far; the limit is {PAIRS_MAX} (an [[object]] rule names any number)"
            );
        }
        for &a in these {
            for &b in those.iter().filter(|&&b| b != a) {
                world.set_pair_response(ids[a], ids[b], rule.response)?;
            }
        }
    }
    Ok(())
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
}
