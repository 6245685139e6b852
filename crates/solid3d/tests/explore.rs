use solid_oracle::generate::*;
use solid_oracle::*;
use solid3d::convex::gjk;
use solid3d::{Shape, query};
fn shape(c: &Convex) -> Option<Shape> {
    match c {
        Convex::Sphere { radius } => Shape::sphere(*radius),
        Convex::Cuboid { half } => Shape::cuboid(*half * 2.0),
        Convex::Cone { radius, half_height } => Shape::cone(*radius, half_height * 2.0),
        Convex::Cylinder { radius, half_height } => Shape::cylinder(*radius, half_height * 2.0),
        Convex::Capsule { radius, half_height } => Shape::capsule(*radius, half_height * 2.0),
        Convex::Hull { points } => Shape::convex_hull(points),
    }
    .ok()
}
#[test]
fn explore() {
    let n: usize = std::env::var("N").map(|s| s.parse().unwrap()).unwrap_or(2000);
    let regimes = [
        Regime::Random,
        Regime::NearTouching { relative_gap: 1e-6 },
        Regime::NearTouching { relative_gap: 1e-9 },
        Regime::NearTouching { relative_gap: 1e-11 },
        Regime::NearTouching { relative_gap: 1e-12 },
        Regime::SizeRatio,
        Regime::Flat,
        Regime::Concentric,
        Regime::Sliver,
        Regime::FarFromOrigin,
    ];
    for regime in regimes {
        let mut rng = seeded(7);
        let (mut sep, mut hit, mut unc, mut wrong_hit, mut wrong_miss, mut dist_bad) = (0, 0, 0, 0, 0, 0);
        let mut worst: f64 = 0.0;
        let mut worst_d: f64 = 0.0;
        let mut time_o = std::time::Duration::ZERO;
        let mut time_l = time_o;
        for i in 0..n {
            let p = random_pair(&mut rng, regime);
            let (Some(a), Some(b)) = (shape(&p.a), shape(&p.b)) else { continue };
            let size =
                extent(&p.a, &p.pa) + extent(&p.b, &p.pb) + (p.pa.translation - p.pb.translation).length();
            let t = std::time::Instant::now();
            let v = verdict(&p.a, &p.pa, &p.b, &p.pb);
            time_o += t.elapsed();
            let t = std::time::Instant::now();
            let r = query::intersects(&a, &p.pa, &b, &p.pb).unwrap();
            time_l += t.elapsed();
            match v {
                Verdict::Separated { gap } => {
                    sep += 1;
                    if r {
                        wrong_hit += 1;
                        if gap / size > worst {
                            worst = gap / size;
                            println!(
                                "  hit at relative gap {:e} case {i} {:?} {:?}",
                                gap / size,
                                kind(&p.a),
                                kind(&p.b)
                            );
                        }
                    }
                }
                Verdict::Intersecting { .. } => {
                    hit += 1;
                    if !r {
                        wrong_miss += 1;
                        println!("  MISS {i} {:?} {:?}", kind(&p.a), kind(&p.b));
                    }
                }
                Verdict::Uncertain { .. } => unc += 1,
            }
            let d = query::distance(&a, &p.pa, &b, &p.pb).unwrap();
            let (lo, hi) = distance_bounds(&p.a, &p.pa, &p.b, &p.pb);
            let err = (lo - d.distance).max(d.distance - hi).max(0.0) / size;
            if err > 1e-12 {
                dist_bad += 1;
                if err > worst_d {
                    worst_d = err;
                    println!(
                        "  distance off by {err:e} ({} not in {lo} {hi}; size {size}) case {i} {:?} {:?}",
                        d.distance,
                        kind(&p.a),
                        kind(&p.b)
                    );
                }
            }
        }
        println!(
            "{regime:?}: sep {sep} hit {hit} unc {unc}; wrong hits {wrong_hit} (worst {worst:e}), misses {wrong_miss}, distances off {dist_bad} worst {worst_d:e}; oracle {time_o:?} lib {time_l:?}"
        );
    }
    let _ = gjk::TOUCHING_ERROR;
}
fn kind(c: &Convex) -> &'static str {
    match c {
        Convex::Sphere { .. } => "sphere",
        Convex::Cuboid { .. } => "box",
        Convex::Cone { .. } => "cone",
        Convex::Cylinder { .. } => "cyl",
        Convex::Capsule { .. } => "caps",
        Convex::Hull { .. } => "hull",
    }
}
fn extent(c: &Convex, p: &glam::DAffine3) -> f64 {
    let r = match c {
        Convex::Sphere { radius } => glam::DVec3::splat(*radius),
        Convex::Cuboid { half } => *half,
        Convex::Cone { radius, half_height } | Convex::Cylinder { radius, half_height } => {
            glam::DVec3::new(*radius, *half_height, *radius)
        }
        Convex::Capsule { radius, half_height } => glam::DVec3::new(*radius, radius + half_height, *radius),
        Convex::Hull { points } => points.iter().fold(glam::DVec3::ZERO, |m, p| m.max(p.abs())),
    };
    let m = p.matrix3;
    (m.x_axis.abs() * r.x + m.y_axis.abs() * r.y + m.z_axis.abs() * r.z).max_element()
}
