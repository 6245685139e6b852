//! Pairs of objects on one root path, which are one thing (thesis, section 2.2).

use std::collections::HashMap;

use solid_scene::SceneObject;

/// The pairs of which one holds the other in the scene graph, the first before the second in the scene.
///
/// Cost: linear in the lengths of the paths and in the number of pairs.
pub fn pairs(objects: &[SceneObject]) -> Vec<(usize, usize)> {
    pairs_of(objects.iter().map(|object| (object.file(), object.path())))
}

/// A node of the scene graphs: the objects that hang on it.
type Node = Vec<usize>;

fn pairs_of<'a>(paths: impl Iterator<Item = (usize, &'a [u32])> + Clone) -> Vec<(usize, usize)> {
    let (mut graph, mut nodes) = (Graph::default(), Vec::<Node>::new());
    for (object, (file, path)) in paths.clone().enumerate() {
        let node = graph.nodes(file, path).last().unwrap_or_default();
        nodes.resize_with(graph.len(), Vec::new);
        nodes[node].push(object);
    }
    let mut pairs = Vec::new();
    for (object, (file, path)) in paths.enumerate() {
        let own = graph.nodes(file, path).last().unwrap_or_default();
        for node in graph.nodes(file, path) {
            // Those that hang on the same node are met from both sides.
            let others = nodes[node].iter().filter(|&&other| node != own || other < object);
            pairs.extend(others.map(|&other| (object.min(other), object.max(other))));
        }
    }
    pairs.sort_unstable();
    pairs
}

/// Numbers the beginnings of paths.
#[derive(Default)]
struct Graph {
    /// The number of a beginning, by that of the one a step shorter, and the step. Files are roots.
    children: HashMap<(Option<usize>, usize), usize>,
}

impl Graph {
    fn len(&self) -> usize {
        self.children.len()
    }

    fn child(&mut self, parent: Option<usize>, step: usize) -> usize {
        let next = self.children.len();
        *self.children.entry((parent, step)).or_insert(next)
    }

    /// The beginnings of a path, from the root of the file to the whole.
    fn nodes(&mut self, file: usize, path: &[u32]) -> impl Iterator<Item = usize> + use<> {
        let mut node = self.child(None, file);
        let mut nodes = vec![node];
        for &step in path {
            node = self.child(Some(node), step as usize);
            nodes.push(node);
        }
        nodes.into_iter()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    type Path = (usize, Vec<u32>);

    fn quick(paths: &[Path]) -> Vec<(usize, usize)> {
        pairs_of(paths.iter().map(|(file, path)| (*file, path.as_slice())))
    }

    /// The definition, pair by pair.
    fn slow(paths: &[Path]) -> Vec<(usize, usize)> {
        let related = |(f, p): &Path, (g, q): &Path| f == g && (p.starts_with(q) || q.starts_with(p));
        let all = (0..paths.len()).flat_map(|a| (a + 1..paths.len()).map(move |b| (a, b)));
        all.filter(|&(a, b)| related(&paths[a], &paths[b])).collect()
    }

    #[test]
    fn ancestors_count_and_siblings_do_not() {
        let paths = [(0, vec![0]), (0, vec![0, 1]), (0, vec![0, 2]), (0, vec![0, 1, 5]), (1, vec![0])];
        assert_eq!(quick(&paths), [(0, 1), (0, 2), (0, 3), (1, 3)]);
    }

    proptest! {
        #[test]
        fn the_pairs_are_those_of_the_definition(
            paths in prop::collection::vec((0..2usize, prop::collection::vec(0..3u32, 0..4)), 0..20)
        ) {
            prop_assert_eq!(quick(&paths), slow(&paths));
        }
    }
}
