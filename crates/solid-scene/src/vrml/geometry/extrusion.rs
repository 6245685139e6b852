//! Extrusion (ISO/IEC 14772-1, 6.18): a cross-section moved along a spine.

use glam::{DMat3, DQuat, DVec2, DVec3};

use super::{Builder, Geometry};
use crate::error::SceneError;
use crate::soup::Soup;
use crate::text::counted;
use crate::vrml::graph::Node;

impl Builder<'_> {
    pub(super) fn extrusion(&mut self, node: Node) -> Result<Option<Geometry>, SceneError> {
        let graph = self.graph;
        let (section, spine) = (graph.vectors2(node, "crossSection")?, graph.vectors(node, "spine")?);
        if section.len() < 2 || spine.len() < 2 {
            return self.empty(node);
        }
        let vertices = section.len().saturating_mul(spine.len());
        let of_sides = (2 * (section.len() - 1)).saturating_mul(spine.len() - 1);
        self.room_for(node, vertices.saturating_add(of_sides))?;
        self.count(node, vertices)?;
        let scale = self.for_each(node, "scale", graph.vectors2(node, "scale")?, spine.len(), DVec2::ONE);
        let turn = graph.rotations(node, "orientation")?;
        let turn = self.for_each(node, "orientation", turn, spine.len(), DQuat::IDENTITY);
        let mut points = Vec::with_capacity(vertices);
        for (i, plane) in planes(&spine).into_iter().enumerate() {
            let flat = section.iter().map(|&p| p * scale[i]).map(|p| DVec3::new(p.x, 0.0, p.y));
            points.extend(flat.map(|p| spine[i] + plane * (turn[i] * p)));
        }
        let triangles = sides(section.len(), spine.len());
        let mut soup = Soup { vertices: points, triangles, ..Soup::default() };
        self.caps(node, &section, &mut soup);
        self.soup(node, soup, None)
    }

    /// A value for each point of the spine: one is for all of them, too many are cut, too few (which the standard
    /// leaves undefined) are filled up with the last.
    fn for_each<T: Copy>(
        &mut self,
        node: Node,
        name: &str,
        mut values: Vec<T>,
        count: usize,
        default: T,
    ) -> Vec<T> {
        if values.len() > 1 && values.len() < count {
            let values = counted(values.len(), "value");
            self.warn(node, format!("{name} holds {values} for {count} points of the spine"));
        }
        let last = values.last().copied().unwrap_or(default);
        values.resize(count, last);
        values
    }

    /// The caps face away from each other, as the sides face outwards: together they are closed where the cross-section is.
    fn caps(&mut self, node: Node, section: &[DVec2], soup: &mut Soup) {
        let mut corners: Vec<u32> = (0..section.len() as u32).collect();
        // A closed cross-section ends where it begins, an open one is closed by its cap.
        corners.dedup_by_key(|corner| section[*corner as usize].to_array());
        if section.first() == section.last() {
            corners.pop();
        }
        if corners.len() < 3 {
            return;
        }
        let last = (soup.vertices.len() - section.len()) as u32;
        let mut folded = 0;
        for (flag, first, is_turned) in [("beginCap", 0, true), ("endCap", last, false)] {
            if self.graph.flag(node, flag) {
                let corners: Vec<u32> = corners.iter().map(|corner| first + corner).collect();
                let before = soup.triangles.len();
                folded += usize::from(Self::face(&corners, soup));
                if is_turned {
                    soup.triangles[before..].iter_mut().for_each(|triangle| triangle.swap(1, 2));
                }
            }
        }
        self.warn_of_folded(node, folded);
    }
}

/// Two triangles for each edge of the cross-section and each step of the spine.
fn sides(section: usize, spine: usize) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(2 * (section - 1) * (spine - 1));
    for ring in 0..spine - 1 {
        for corner in 0..section - 1 {
            let a = (ring * section + corner) as u32;
            let b = a + section as u32;
            triangles.push([a, a + 1, b + 1]);
            triangles.push([a, b + 1, b]);
        }
    }
    triangles
}

/// For each point of a spine, the spine-aligned cross-section plane: the axes into which x, y and z of the
/// cross-section are turned. Points that coincide have the same.
fn planes(spine: &[DVec3]) -> Vec<DMat3> {
    let mut distinct = vec![spine[0]];
    let mut which = vec![0];
    for &point in &spine[1..] {
        if distinct.last() != Some(&point) {
            distinct.push(point);
        }
        which.push(distinct.len() - 1);
    }
    let planes = distinct_planes(&distinct);
    which.into_iter().map(|i| planes[i]).collect()
}

/// [`planes`] for points of which no two in a row coincide.
fn distinct_planes(spine: &[DVec3]) -> Vec<DMat3> {
    let neighbours = Neighbours { spine, closed: spine.len() > 2 && spine.first() == spine.last() };
    let Some(normals) = neighbours.normals() else {
        let turn = along_y(spine[spine.len() - 1] - spine[0], neighbours.tangent(0));
        return vec![turn; spine.len()];
    };
    let plane = |(i, z): (usize, DVec3)| {
        let y = neighbours.tangent(i);
        DMat3::from_cols(y.cross(z).normalize_or(DVec3::X), y, z)
    };
    normals.into_iter().enumerate().map(plane).collect()
}

/// The plane of a straight spine: y turned into its direction.
fn along_y(whole: DVec3, tangent: DVec3) -> DMat3 {
    // A straight spine that returns to its start has a direction all the same: that of its first step.
    let direction = whole.try_normalize().unwrap_or(tangent);
    match direction.try_normalize() {
        // The opposite of y: no axis is given, and z is taken.
        Some(direction) if direction.y < -1.0 + 1e-12 => DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0)),
        Some(direction) => DMat3::from_quat(DQuat::from_rotation_arc(DVec3::Y, direction)),
        None => DMat3::IDENTITY,
    }
}

/// A spine with the points before and after each.
struct Neighbours<'a> {
    spine: &'a [DVec3],
    closed: bool,
}

impl Neighbours<'_> {
    /// The directions to the point before and to the point after; at the ends of an open spine, one is missing.
    fn steps(&self, i: usize) -> (Option<DVec3>, Option<DVec3>) {
        let last = self.spine.len() - 1;
        let step = |to: usize| Some(self.spine[to] - self.spine[i]);
        match i {
            _ if last == 0 => (None, None),
            _ if self.closed && (i == 0 || i == last) => (step(last - 1), step(1)),
            0 => (None, step(1)),
            i if i == last => (step(i - 1), None),
            i => (step(i - 1), step(i + 1)),
        }
    }

    /// The y axis: from the point before to the point after.
    fn tangent(&self, i: usize) -> DVec3 {
        let (before, after) = self.steps(i);
        let tangent = after.unwrap_or(DVec3::ZERO) - before.unwrap_or(DVec3::ZERO);
        // The spine turns back on itself: the way on is as good as any.
        tangent.try_normalize().or(after.and_then(DVec3::try_normalize)).unwrap_or(DVec3::Y)
    }

    /// The z axes: across the steps to both neighbours. Where the spine is straight, that of the point before (at the
    /// beginning, the first there is); none is more than a right angle from the one before. `None` for a straight spine.
    fn normals(&self) -> Option<Vec<DVec3>> {
        let own: Vec<Option<DVec3>> = (0..self.spine.len()).map(|i| self.normal(i)).collect();
        let mut previous = own.iter().flatten().next().copied()?;
        let follow = |normal: Option<DVec3>| {
            let normal = normal.unwrap_or(previous);
            previous = if normal.dot(previous) < 0.0 { -normal } else { normal };
            previous
        };
        Some(own.into_iter().map(follow).collect())
    }

    fn normal(&self, i: usize) -> Option<DVec3> {
        /// The sine of the angle between steps that still count as straight, for coordinates in single precision.
        const STRAIGHT: f64 = 1e-6;
        let (before, after) = self.steps(i);
        let (before, after) = (before?, after?);
        let across = after.cross(before);
        (across.length() > STRAIGHT * before.length() * after.length()).then(|| across.normalize())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_spine_along_y_leaves_the_section_alone() {
        assert_eq!(planes(&[DVec3::ZERO, DVec3::Y, 2.0 * DVec3::Y]), [DMat3::IDENTITY; 3]);
    }

    #[test]
    fn a_straight_spine_turns_y_into_its_direction() {
        for direction in [DVec3::X, DVec3::NEG_Y, DVec3::new(1.0, 2.0, 3.0)] {
            let plane = planes(&[DVec3::ONE, DVec3::ONE + direction])[0];
            assert!((plane.y_axis - direction.normalize()).length() < 1e-12);
            assert!((plane.determinant() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn points_that_coincide_have_one_plane() {
        let spine = [DVec3::ZERO, DVec3::X, DVec3::X, DVec3::new(1.0, 1.0, 0.0)];
        let planes = planes(&spine);
        assert_eq!(planes[1], planes[2]);
        assert_eq!(super::planes(&[DVec3::ONE; 3]), [DMat3::IDENTITY; 3]);
    }

    #[test]
    fn the_planes_of_a_closed_spine_meet() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y, DVec3::ZERO];
        let planes = planes(&square);
        assert_eq!(planes[0], planes[4]);
        let expected = DVec3::new(1.0, -1.0, 0.0).normalize();
        assert!((planes[0].y_axis - expected).length() < 1e-12);
    }

    #[test]
    fn z_does_not_flip_where_the_spine_bends_the_other_way() {
        let zigzag = [
            DVec3::ZERO,
            DVec3::X,
            DVec3::new(1.0, 1.0, 0.0),
            DVec3::new(2.0, 1.0, 0.0),
            DVec3::new(2.0, 2.0, 0.0),
        ];
        let planes = planes(&zigzag);
        assert!(planes.windows(2).all(|pair| pair[0].z_axis.dot(pair[1].z_axis) > 0.99));
    }
}
