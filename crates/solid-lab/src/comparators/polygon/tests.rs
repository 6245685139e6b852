use solid_oracle::generate::seeded;
use solid3d::polygon::{Counters, Polygon, intersect_straightforward};

use super::*;
use crate::experiments::star;

#[test]
fn both_tests_agree_with_the_library() {
    let mut rng = seeded(32);
    let mut hits = 0;
    for round in 0..600 {
        let [a, b] = [0.0, 0.9].map(|reach| star(&mut rng, 3 + round % 20, reach));
        let [exact_a, exact_b] = [&a, &b].map(|v| Polygon::new(v.clone()).expect("stars are flat"));
        let expected = intersect_straightforward(&exact_a, &exact_b, &mut Counters::default());
        let [a, b] = [a, b].map(FlatPolygon::new);
        assert_eq!(straightforward(&a, &b), expected, "{a:?}, {b:?}");
        assert_eq!(Sorted::default().intersect(&a, &b), expected, "{a:?}, {b:?}");
        hits += usize::from(expected);
    }
    assert!((180..420).contains(&hits), "{hits} of 600: not representative");
}
