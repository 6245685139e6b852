//! The connected parts of a soup.

/// The least vertex of each connected part, ascending. Primitives are connected when they share a vertex, or `twins`, which
/// are vertices that always are at the same position. Cost: linear, nearly.
///
/// Vertices that merely coincide do not connect primitives, for a deformation may part them: so what is returned holds for
/// every deformation, and a soup that shares no vertices has as many parts as primitives.
pub(super) fn parts<'a>(
    vertex_count: usize,
    primitives: impl Iterator<Item = &'a [u32]> + Clone,
    twins: &[[u32; 2]],
) -> Vec<u32> {
    // A forest over the vertices: a root is the least vertex of its tree.
    let mut parent: Vec<u32> = (0..vertex_count as u32).collect();
    for primitive in primitives.clone() {
        for pair in primitive.windows(2) {
            unite(&mut parent, pair[0], pair[1]);
        }
    }
    for &[i, j] in twins {
        unite(&mut parent, i, j);
    }
    let mut roots: Vec<u32> = primitives.map(|primitive| root(&mut parent, primitive[0])).collect();
    roots.sort_unstable();
    roots.dedup();
    roots
}

fn unite(parent: &mut [u32], i: u32, j: u32) {
    let (i, j) = (root(parent, i), root(parent, j));
    parent[i.max(j) as usize] = i.min(j);
}

/// The root of a vertex; the way to it is halved (Tarjan and van Leeuwen, *Worst-case analysis of set union algorithms*,
/// 1984).
fn root(parent: &mut [u32], mut i: u32) -> u32 {
    while parent[i as usize] != i {
        parent[i as usize] = parent[parent[i as usize] as usize];
        i = parent[i as usize];
    }
    i
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(primitives: &[&[u32]], twins: &[[u32; 2]]) -> Vec<u32> {
        parts(10, primitives.iter().copied(), twins)
    }

    #[test]
    fn a_part_is_named_by_its_least_vertex() {
        assert_eq!(of(&[&[7, 8, 9], &[3, 5], &[5, 7], &[6]], &[]), [3, 6]);
        assert_eq!(of(&[&[9, 9, 9], &[8]], &[]), [8, 9]);
    }

    #[test]
    fn twins_connect() {
        assert_eq!(of(&[&[1, 2, 3], &[4, 5, 6]], &[]), [1, 4]);
        assert_eq!(of(&[&[1, 2, 3], &[4, 5, 6]], &[[2, 6]]), [1]);
    }
}
