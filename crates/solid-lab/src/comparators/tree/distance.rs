use solid3d::Aabb;
use solid3d::glam::DAffine3;

use super::{AlignedBox, Child, Counters, Tree, triangle_distance};

/// The distance of two meshes: depth first, the nearer child first, past what is farther than the best so far. Boxes of B are
/// enclosed in the frame of A; the gap of two boxes bounds the distance of what is in them.
pub fn distance(
    a: &Tree<AlignedBox>,
    b: &Tree<AlignedBox>,
    b_to_a: &DAffine3,
    counters: &mut Counters,
) -> f64 {
    let gap = |i: u32, j: u32| {
        let enclosed: Aabb = b.nodes[j as usize].volume.bounds().transformed(b_to_a);
        a.nodes[i as usize].volume.bounds().gap(&enclosed).length()
    };
    let mut best = f64::INFINITY;
    let mut stack = vec![(0, 0, 0.0)];
    while let Some((i, j, bound)) = stack.pop() {
        if bound >= best {
            continue;
        }
        let (node_a, node_b) = (&a.nodes[i as usize], &b.nodes[j as usize]);
        let a_first = node_a.volume.half.length_squared() > node_b.volume.half.length_squared();
        let children = match (node_a.child, node_b.child) {
            (Child::Leaf(x), Child::Leaf(y)) => {
                counters.triangle_tests += 1;
                let moved = b.triangles[y as usize].map(|p| b_to_a.transform_point3(p));
                best = best.min(triangle_distance(&a.triangles[x as usize], &moved));
                continue;
            }
            (Child::Inner(first), other) if a_first || matches!(other, Child::Leaf(_)) => {
                [(first, j), (first + 1, j)]
            }
            (_, Child::Inner(first)) => [(i, first), (i, first + 1)],
            (Child::Inner(_), Child::Leaf(_)) => unreachable!("the first inner arm takes it"),
        };
        counters.box_tests += 2;
        let [near, far] = children.map(|(i, j)| (i, j, gap(i, j)));
        let (near, far) = if far.2 < near.2 { (far, near) } else { (near, far) };
        stack.extend([far, near]);
    }
    best
}
