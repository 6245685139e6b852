use solid_oracle::generate::*;
use solid_oracle::*;
use solid3d::{Shape, query};
fn shape(c: &Convex) -> Shape {
    match c {
        Convex::Sphere { radius } => Shape::sphere(*radius),
        Convex::Cuboid { half } => Shape::cuboid(*half * 2.0),
        Convex::Cone { radius, half_height } => Shape::cone(*radius, half_height * 2.0),
        Convex::Cylinder { radius, half_height } => Shape::cylinder(*radius, half_height * 2.0),
        Convex::Capsule { radius, half_height } => Shape::capsule(*radius, half_height * 2.0),
        Convex::Hull { points } => Shape::convex_hull(points),
    }
    .unwrap()
}
#[test]
fn one() {
    let c: usize = std::env::var("CASE").unwrap().parse().unwrap();
    let mut rng = seeded(7);
    let regime = match std::env::var("REG").unwrap().as_str() {
        "t" => Regime::NearTouching { relative_gap: 1e-9 },
        "s" => Regime::SizeRatio,
        "v" => Regime::Sliver,
        "r" => Regime::Random,
        "11" => Regime::NearTouching { relative_gap: 1e-11 },
        _ => Regime::Flat,
    };
    let mut p = random_pair(&mut rng, regime);
    for _ in 0..c {
        p = random_pair(&mut rng, regime);
    }
    println!("{p:?} {:?}", verdict(&p.a, &p.pa, &p.b, &p.pb));
    let (a, b) = (shape(&p.a), shape(&p.b));
    println!("intersects {:?}", query::intersects(&a, &p.pa, &b, &p.pb));
    println!(
        "distance {:?} {:?}",
        query::distance(&a, &p.pa, &b, &p.pb),
        distance_bounds(&p.a, &p.pa, &p.b, &p.pb)
    );
}
