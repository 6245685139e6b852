use solid3d::glam::DVec3;

use super::body::Body;
use super::gjk_distance::ITERATIONS_MAX;
use super::{ConvexTest, Counters, Memory, Pair};

/// A vertex, an edge or a face of a polyhedron.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Feature {
    /// By its number.
    Vertex(u32),
    /// By its number among the edges.
    Edge(u32),
    /// A triangle, by its number.
    Face(u32),
}

/// Lin-Canny in Mirtich's variant V-Clip: walks from feature to feature until each of two has its closest point in the Voronoi region of
/// the other (thesis, section 4.3). What I-COLLIDE tests polytopes with.
///
/// Sources: Lin and Canny, *A fast algorithm for incremental distance calculation*, 1991; Mirtich, *V-Clip: fast and robust polyhedral
/// collision detection*, 1998.
#[derive(Clone, Copy, Debug, Default)]
pub struct LinCanny {
    counters: Counters,
}

/// What a step found.
enum Step {
    /// Other features are closer.
    To(Feature, Feature),
    /// These are the closest.
    Apart,
    /// They pierce each other.
    Inside,
}

use Feature::{Edge, Face, Vertex};

impl ConvexTest for LinCanny {
    fn name(&self) -> &'static str {
        "Lin-Canny (V-Clip)"
    }

    fn intersects(&mut self, pair: &Pair, memory: &mut Memory) -> bool {
        self.counters.tests += 1;
        let a = Body { shape: pair.a, placement: pair.placement_a };
        let b = Body { shape: pair.b, placement: pair.placement_b };
        let (mut x, mut y) = memory.features.unwrap_or((Vertex(0), Vertex(0)));
        for _ in 0..ITERATIONS_MAX {
            self.counters.iterations += 1;
            memory.features = Some((x, y));
            match step(&a, x, &b, y) {
                Step::To(next_x, next_y) => (x, y) = (next_x, next_y),
                Step::Apart => return false,
                Step::Inside => return true,
            }
        }
        self.counters.gave_up += 1;
        false
    }

    fn counters(&self) -> Counters {
        self.counters
    }
}

/// From a pair of features to a closer one.
fn step(a: &Body, x: Feature, b: &Body, y: Feature) -> Step {
    match (x, y) {
        (Vertex(v), Vertex(w)) => vertex_vertex(a, v, b, w),
        (Vertex(v), Edge(e)) => vertex_edge(a, v, b, e),
        (Vertex(v), Face(f)) => vertex_face(a, v, b, f),
        (Edge(e), Edge(f)) => edge_edge(a, e, b, f),
        (Edge(e), Face(f)) => edge_face(a, e, b, f),
        // Two faces are never closest without an edge or a vertex of one.
        (Face(f), Face(_)) => Step::To(Edge(a.edges().of_face[f as usize][0]), y),
        (Edge(_) | Face(_), _) => match step(b, y, a, x) {
            Step::To(next_y, next_x) => Step::To(next_x, next_y),
            end => end,
        },
    }
}

fn vertex_vertex(a: &Body, v: u32, b: &Body, w: u32) -> Step {
    if let Some(edge) = b.edge_beyond_vertex(w, a.vertex(v)) {
        return Step::To(Vertex(v), Edge(edge));
    }
    if let Some(edge) = a.edge_beyond_vertex(v, b.vertex(w)) {
        return Step::To(Edge(edge), Vertex(w));
    }
    Step::Apart
}

fn vertex_edge(a: &Body, v: u32, b: &Body, e: u32) -> Step {
    let point = a.vertex(v);
    if let Some(feature) = b.feature_beyond_edge(e, point) {
        return Step::To(Vertex(v), feature);
    }
    // Where along the edge v is still the closest vertex.
    let ends = b.ends(e);
    let mut clip = Clip::new(ends);
    for &g in &a.edges().of_vertex[v as usize] {
        let along = a.far_end(g, v) - point;
        clip.cut(|x| -(x - point).dot(along), Edge(g));
    }
    if let Some(next) = clip.beyond(a, |_| Some(point)) {
        return Step::To(next, Edge(e));
    }
    Step::Apart
}

fn vertex_face(a: &Body, v: u32, b: &Body, f: u32) -> Step {
    let point = a.vertex(v);
    let beyond = b.edges().of_face[f as usize]
        .map(|e| (b.inside_of_edge(f, e, point), e))
        .into_iter()
        .min_by(|x, y| x.0.total_cmp(&y.0))
        .expect("a face has edges");
    if beyond.0 < 0.0 {
        return Step::To(Vertex(v), Edge(beyond.1));
    }
    let height = b.height(f, point);
    for &g in &a.edges().of_vertex[v as usize] {
        let other = b.height(f, a.far_end(g, v));
        if if height > 0.0 { other < height } else { other > height } {
            return Step::To(Edge(g), Face(f));
        }
    }
    if height > 0.0 {
        return Step::Apart;
    }
    // A local minimum below the face: is there a face that v is above?
    let faces = 0..b.edges().of_face.len() as u32;
    let highest =
        faces.map(|f| (b.height(f, point), f)).max_by(|x, y| x.0.total_cmp(&y.0)).expect("there are faces");
    if highest.0 > 0.0 { Step::To(Vertex(v), Face(highest.1)) } else { Step::Inside }
}

fn edge_edge(a: &Body, e: u32, b: &Body, f: u32) -> Step {
    if let Some(next) = clip_to_edge(a.ends(e), b, f) {
        return Step::To(Edge(e), next);
    }
    if let Some(next) = clip_to_edge(b.ends(f), a, e) {
        return Step::To(next, Edge(f));
    }
    Step::Apart
}

/// Clips a segment to the Voronoi region of an edge: a feature that is closer to the segment.
fn clip_to_edge(segment: [DVec3; 2], b: &Body, f: u32) -> Option<Feature> {
    let mut clip = Clip::new(segment);
    let edge = b.edges().edges[f as usize];
    let [tail, head] = b.ends(f);
    clip.cut(|x| (x - tail).dot(head - tail), Vertex(edge.ends[0]));
    clip.cut(|x| (x - head).dot(tail - head), Vertex(edge.ends[1]));
    for face in edge.faces {
        clip.cut(|x| -b.inside_of_edge(face, f, x), Face(face));
    }
    clip.beyond(b, |vertex| Some(b.vertex(vertex)))
}

fn edge_face(a: &Body, e: u32, b: &Body, f: u32) -> Step {
    let ends = a.ends(e);
    let mut clip = Clip::new(ends);
    for g in b.edges().of_face[f as usize] {
        clip.cut(|x| b.inside_of_edge(f, g, x), Edge(g));
    }
    if clip.is_empty() {
        return Step::To(Edge(e), nearest_on_boundary(ends, b, f));
    }
    let [low, high] = [clip.low, clip.high].map(|t| b.height(f, clip.at(t)));
    if (low <= 0.0) != (high <= 0.0) || low == 0.0 {
        return Step::Inside;
    }
    let edge = a.edges().edges[e as usize];
    // The nearer end of what is over the face.
    let (cut_by, end) =
        if low.abs() < high.abs() { (clip.cut_low, edge.ends[0]) } else { (clip.cut_high, edge.ends[1]) };
    match cut_by {
        Some(boundary) => Step::To(Edge(e), boundary),
        None => Step::To(Vertex(end), Face(f)),
    }
}

/// The part of a segment in a Voronoi region, by shares of its length, and what cut its ends off.
struct Clip {
    segment: [DVec3; 2],
    low: f64,
    high: f64,
    cut_low: Option<Feature>,
    cut_high: Option<Feature>,
    excluded: Option<Feature>,
}

impl Clip {
    fn new(segment: [DVec3; 2]) -> Self {
        Clip { segment, low: 0.0, high: 1.0, cut_low: None, cut_high: None, excluded: None }
    }

    fn at(&self, share: f64) -> DVec3 {
        self.segment[0] + (self.segment[1] - self.segment[0]) * share
    }

    fn is_empty(&self) -> bool {
        self.excluded.is_some() || self.low > self.high
    }

    /// Keeps where `inside` is not negative; beyond lies the region of `neighbour`.
    fn cut(&mut self, inside: impl Fn(DVec3) -> f64, neighbour: Feature) {
        let [p, q] = self.segment.map(inside);
        if p < 0.0 && q < 0.0 {
            self.excluded = self.excluded.or(Some(neighbour));
        } else if p < 0.0 {
            let share = p / (p - q);
            if share > self.low {
                (self.low, self.cut_low) = (share, Some(neighbour));
            }
        } else if q < 0.0 {
            let share = p / (p - q);
            if share < self.high {
                (self.high, self.cut_high) = (share, Some(neighbour));
            }
        }
    }

    /// The neighbour to which the distance still falls, where an end was cut off.
    fn beyond(&self, body: &Body, point_of: impl Fn(u32) -> Option<DVec3>) -> Option<Feature> {
        if self.excluded.is_some() {
            return self.excluded;
        }
        let along = self.segment[1] - self.segment[0];
        // The derivative of the distance to the neighbour, going along the segment.
        let slope = |share: f64, neighbour: Feature| match neighbour {
            Face(f) => body.height(f, self.at(share)).signum() * body.normal(f).dot(along),
            Vertex(v) | Edge(v) => point_of(v).map_or(0.0, |point| (self.at(share) - point).dot(along)),
        };
        self.cut_low
            .filter(|&neighbour| slope(self.low, neighbour) > 0.0)
            .or(self.cut_high.filter(|&neighbour| slope(self.high, neighbour) < 0.0))
    }
}

/// The edge or the vertex of a face that is closest to a segment beside the face.
fn nearest_on_boundary([p, q]: [DVec3; 2], b: &Body, f: u32) -> Feature {
    let nearest = |g: u32| {
        let [r, s] = b.ends(g);
        let (d, e, between) = (q - p, s - r, p - r);
        let (dd, ee, de) = (d.length_squared(), e.length_squared(), d.dot(e));
        let (db, eb) = (d.dot(between), e.dot(between));
        let share = |x: f64, of: f64| if of > 0.0 { (x / of).clamp(0.0, 1.0) } else { 0.0 };
        let first = share(de * eb - db * ee, dd * ee - de * de);
        let along_e = share(de * first + eb, ee);
        let along_d = share(de * along_e - db, dd);
        let [tail, head] = b.edges().edges[g as usize].ends;
        let feature = if along_e == 0.0 {
            Vertex(tail)
        } else if along_e == 1.0 {
            Vertex(head)
        } else {
            Edge(g)
        };
        ((p + d * along_d - r - e * along_e).length_squared(), feature)
    };
    let [x, y, z] = b.edges().of_face[f as usize].map(nearest);
    let closer = |x: (f64, Feature), y: (f64, Feature)| if y.0 < x.0 { y } else { x };
    closer(closer(x, y), z).1
}
