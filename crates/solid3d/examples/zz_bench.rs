//! x
#![allow(clippy::print_stdout)]
use solid3d::{
    Response, Shape, World,
    glam::{DAffine3, DQuat, DVec3},
    query,
};
fn main() {
    let mut s: u64 = 12345;
    let mut r = move || {
        s ^= s << 13;
        s ^= s >> 7;
        s ^= s << 17;
        (s >> 11) as f64 / (1u64 << 53) as f64
    };
    for n in [20, 100, 1000] {
        let shapes: Vec<Shape> = (0..50)
            .map(|_| {
                let p: Vec<DVec3> = (0..n)
                    .map(|_| {
                        loop {
                            let v = DVec3::new(r() - 0.5, r() - 0.5, r() - 0.5);
                            if v.length() < 0.5 && v.length() > 0.01 {
                                break v.normalize();
                            }
                        }
                    })
                    .collect();
                Shape::convex_hull(&p).unwrap()
            })
            .collect();
        let poses: Vec<DAffine3> = (0..2000)
            .map(|_| {
                DAffine3::from_rotation_translation(
                    DQuat::from_xyzw(r() - 0.5, r() - 0.5, r() - 0.5, r() - 0.5).normalize(),
                    DVec3::new(r(), r(), r()) * 2.2,
                )
            })
            .collect();
        let t = std::time::Instant::now();
        let mut hits = 0;
        let m = 200_000;
        for i in 0..m {
            if query::intersects(
                &shapes[i % 50],
                &poses[i % 2000],
                &shapes[(i * 7 + 3) % 50],
                &poses[(i * 13 + 5) % 1999],
            )
            .unwrap()
            {
                hits += 1
            }
        }
        println!("{n}: {:?} per intersects, hits {}%", t.elapsed() / m as u32, hits * 100 / m);
        let t = std::time::Instant::now();
        for i in 0..m {
            std::hint::black_box(
                query::distance(
                    &shapes[i % 50],
                    &poses[i % 2000],
                    &shapes[(i * 7 + 3) % 50],
                    &poses[(i * 13 + 5) % 1999],
                )
                .unwrap(),
            );
        }
        println!("{n}: {:?} per distance", t.elapsed() / m as u32);
    }
    // tori
    for (nu, nv) in [(50, 50), (250, 200)] {
        let mut v = vec![];
        let mut tri = vec![];
        for i in 0..nu {
            for j in 0..nv {
                let (a, b) = (
                    i as f64 / nu as f64 * std::f64::consts::TAU,
                    j as f64 / nv as f64 * std::f64::consts::TAU,
                );
                v.push(DVec3::new(
                    (10. + 2. * b.cos()) * a.cos(),
                    (10. + 2. * b.cos()) * a.sin(),
                    2. * b.sin(),
                ));
                let id = |i: usize, j: usize| ((i % nu) * nv + (j % nv)) as u32;
                tri.push([id(i, j), id(i + 1, j), id(i + 1, j + 1)]);
                tri.push([id(i, j), id(i + 1, j + 1), id(i, j + 1)]);
            }
        }
        let t = std::time::Instant::now();
        let torus = Shape::mesh(v, tri).unwrap();
        println!("build {} triangles {:?}", torus.primitive_count(), t.elapsed());
        let poses: Vec<DAffine3> = (0..2000)
            .map(|_| {
                DAffine3::from_rotation_translation(
                    DQuat::from_xyzw(r() - 0.5, r() - 0.5, r() - 0.5, r() - 0.5).normalize(),
                    DVec3::new(r(), r(), r()) * 12.0,
                )
            })
            .collect();
        let t = std::time::Instant::now();
        let mut hits = 0;
        let m = 20_000;
        for i in 0..m {
            if query::intersects(&torus, &poses[i % 2000], &torus, &poses[(i * 13 + 5) % 1999]).unwrap() {
                hits += 1
            }
        }
        println!("torus intersects {:?}, hits {}%", t.elapsed() / m as u32, hits * 100 / m);
        let m = 200;
        let t = std::time::Instant::now();
        for i in 0..m {
            std::hint::black_box(
                query::distance(&torus, &poses[i % 2000], &torus, &poses[(i * 13 + 5) % 1999]).unwrap(),
            );
        }
        println!("torus distance {:?}", t.elapsed() / m as u32);
    }
    // world
    let mut w = World::new();
    w.set_default_response(Response::Simple);
    let shapes: Vec<Shape> = (0..20)
        .map(|_| {
            let p: Vec<DVec3> = (0..20)
                .map(|_| {
                    loop {
                        let v = DVec3::new(r() - 0.5, r() - 0.5, r() - 0.5);
                        if v.length() < 0.5 && v.length() > 0.01 {
                            break v.normalize();
                        }
                    }
                })
                .collect();
            Shape::convex_hull(&p).unwrap()
        })
        .collect();
    let side = (1000f64 * 4.19 / 0.05).cbrt();
    let mut pos: Vec<(DVec3, DVec3)> = (0..1000)
        .map(|_| (DVec3::new(r(), r(), r()) * side, DVec3::new(r() - 0.5, r() - 0.5, r() - 0.5) * 0.1))
        .collect();
    let ids: Vec<_> = pos
        .iter()
        .enumerate()
        .map(|(i, p)| w.add(&shapes[i % 20], DAffine3::from_translation(p.0)).unwrap())
        .collect();
    let t = std::time::Instant::now();
    let frames = 500;
    let mut c = 0;
    for f in 0..frames {
        for (i, p) in pos.iter_mut().enumerate() {
            p.0 += p.1;
            for k in 0..3 {
                if p.0[k] < 0. || p.0[k] > side {
                    p.1[k] = -p.1[k]
                }
            }
            w.set_placement(
                ids[i],
                DAffine3::from_rotation_translation(DQuat::from_rotation_y(f as f64 * 0.17), p.0),
            )
            .unwrap();
        }
        c += w.test().len();
        w.proceed();
    }
    println!(
        "world 1000 objects: {:?} a frame, {} collisions a frame {:?}",
        t.elapsed() / frames,
        c / frames as usize,
        w.statistics()
    );
}
