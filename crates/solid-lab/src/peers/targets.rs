use super::Peer;

/// How many times as fast as a peer the library is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Target {
    /// The beginning of the names of the works that are meant.
    pub work: &'static str,
    /// In comparison with whom.
    pub peer: Peer,
    /// How many times.
    pub ratio: f64,
}

/// The name of the targets of a work: the longest that it begins with.
pub fn name(work: &str) -> Option<&'static str> {
    let names = |target: &&Target| {
        work.strip_prefix(target.work).is_some_and(|rest| rest.is_empty() || rest.starts_with(", "))
    };
    TARGETS.iter().filter(names).map(|target| target.work).max_by_key(|name| name.len())
}

/// The ratio asked of a work.
pub fn ratio(work: &str, peer: Peer) -> Option<f64> {
    let name = name(work)?;
    TARGETS.iter().find(|target| target.work == name && target.peer == peer).map(|target| target.ratio)
}

const fn thesis(work: &'static str, ratio: f64) -> Target {
    Target { work, peer: Peer::Thesis, ratio }
}

const fn parry(work: &'static str, ratio: f64) -> Target {
    Target { work, peer: Peer::ParryDouble, ratio }
}

const fn limit(work: &'static str) -> Target {
    Target { work, peer: Peer::Limit, ratio: 1.0 }
}

/// All of them.
pub const TARGETS: &[Target] = &[
    thesis("20 vertices, intersection", 1.5),
    parry("20 vertices, intersection", 4.0),
    thesis("100 vertices, intersection", 2.8),
    parry("100 vertices, intersection", 5.0),
    thesis("1,000 vertices, intersection", 5.0),
    parry("1,000 vertices, intersection", 12.0),
    thesis("20 vertices, intersection, coherent", 3.4),
    parry("20 vertices, intersection, coherent", 25.0),
    thesis("100 vertices, intersection, coherent", 5.6),
    parry("100 vertices, intersection, coherent", 18.0),
    thesis("1,000 vertices, intersection, coherent", 7.8),
    parry("1,000 vertices, intersection, coherent", 45.0),
    thesis("20 vertices, closest points", 1.5),
    parry("20 vertices, closest points", 2.5),
    thesis("20 vertices, closest points, coherent", 7.0),
    parry("20 vertices, closest points, coherent", 10.0),
    parry("sphere-sphere, intersection", 1.2),
    parry("sphere-box, intersection", 1.5),
    parry("capsule-capsule, intersection", 25.0),
    parry("box-box, intersection", 2.0),
    thesis("tori of 5,000 triangles, first hit", 7.0),
    parry("tori of 5,000 triangles, first hit", 45.0),
    thesis("tori of 5,000 triangles, all pairs", 8.0),
    thesis("tori of 5,000 triangles, distance", 15.0),
    parry("tori of 5,000 triangles, distance", 250.0),
    thesis("tori of 5,000 triangles, distance, coherent", 30.0),
    thesis("tori of 100,000 triangles, first hit", 7.5),
    parry("tori of 100,000 triangles, first hit", 700.0),
    thesis("tori of 100,000 triangles, all pairs", 7.0),
    thesis("tori of 100,000 triangles, distance", 100.0),
    parry("tori of 100,000 triangles, distance", 7000.0),
    parry("mesh of 100,000 triangles and sphere, intersection", 15.0),
    parry("mesh of 100,000 triangles and box, intersection", 15.0),
    parry("mesh of 100,000 triangles and hull, intersection", 15.0),
    parry("mesh of 100,000 triangles and sphere, distance", 50.0),
    parry("mesh of 100,000 triangles and box, distance", 50.0),
    parry("mesh of 100,000 triangles and hull, distance", 50.0),
    parry("closest ray, 100,000 triangles", 2.0),
    thesis("refit of 5,000 triangles", 5.5),
    parry("refit of 5,000 triangles", 5.0),
    thesis("refit of 100,000 triangles", 5.5),
    parry("refit of 100,000 triangles", 5.0),
    thesis("refit of 1,000,000 triangles", 3.0),
    parry("refit of 1,000,000 triangles", 3.0),
    thesis("build of 100,000 triangles", 1.0),
    parry("build of 100,000 triangles", 2.0),
    thesis("build of 1,000,000 triangles", 1.0),
    parry("build of 1,000,000 triangles", 2.0),
    thesis("broad phase of 10,000 boxes, 1 % moving", 10.0),
    parry("broad phase of 10,000 boxes, 1 % moving", 20.0),
    thesis("broad phase of 100,000 boxes, 1 % moving", 50.0),
    parry("broad phase of 100,000 boxes, 1 % moving", 20.0),
    thesis("broad phase of 1,000,000 boxes, 1 % moving", 500.0),
    parry("broad phase of 1,000,000 boxes, 1 % moving", 20.0),
    thesis("broad phase of 10,000 boxes, 100 % moving", 10.0),
    parry("broad phase of 10,000 boxes, 100 % moving", 5.0),
    thesis("broad phase of 100,000 boxes, 100 % moving", 40.0),
    parry("broad phase of 100,000 boxes, 100 % moving", 5.0),
    parry("broad phase of 1,000,000 boxes, 100 % moving", 5.0),
    thesis("I-COLLIDE, 20 polyhedra, a frame", 3.0),
    parry("I-COLLIDE, 20 polyhedra, a frame", 3.0),
    thesis("I-COLLIDE, 1,000 polyhedra, a frame", 10.0),
    parry("I-COLLIDE, 1,000 polyhedra, a frame", 5.0),
    parry("I-COLLIDE, 10,000 polyhedra, a frame", 6.0),
    limit("memory of a mesh, a triangle"),
    limit("memory of a world, an object"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_name_counts() {
        assert_eq!(ratio("20 vertices, intersection, 10 % overlap", Peer::Thesis), Some(1.5));
        assert_eq!(ratio("20 vertices, intersection, coherent, 10 % overlap", Peer::Thesis), Some(3.4));
        assert_eq!(ratio("tori of 5,000 triangles, distance, coherent", Peer::ParryDouble), None);
        assert_eq!(ratio("broad phase of 10,000 boxes, 10 % moving", Peer::Thesis), None);
    }
}
