//! Distinct points in a scale in which determinants can neither overflow nor underflow, and exact signs of them.

use glam::{DVec2, DVec3};

use crate::exact::{flatten, height, orient2d, power_of_two};

/// A distinct point: an index into [`Sites`].
pub(super) type Site = u32;

/// On each axis the greatest magnitude is scaled to just below 2^320: a determinant of three differences stays below
/// 6 * (2^321)^3 < 2^966, with room for the splitting constant of exact products.
const EXPONENT_MAX: i32 = 320;

/// Scaled coordinates below this count as zero: so the last bit of any is at least 2^(-306-52), the product of three
/// such bits is at least 2^-1074, the least positive number, and no exact product loses anything.
const EXPONENT_MIN: i32 = -306;

/// The distinct points, in lexicographic order.
#[derive(Debug)]
pub(super) struct Sites {
    points: Vec<DVec3>,
    /// For each site the first of the input points that are equal to it.
    input: Vec<u32>,
}

impl Sites {
    /// From finite points, at least one.
    pub fn new(points: &[DVec3]) -> Self {
        let greatest = points.iter().fold(DVec3::ZERO, |g, p| g.max(p.abs()));
        let shift = greatest.to_array().map(|g| EXPONENT_MAX - exponent(g));
        let least = power_of_two(EXPONENT_MIN);
        let scaled = |p: &DVec3| {
            DVec3::from_array(std::array::from_fn(|k| {
                // In two steps, because the factor itself may be out of range. Exact: results are normal numbers.
                let half = shift[k] / 2;
                let x = p[k] * power_of_two(half) * power_of_two(shift[k] - half);
                // Adding zero makes -0 into 0.
                if x.abs() < least { 0.0 } else { x + 0.0 }
            }))
        };
        let mut all: Vec<(DVec3, u32)> = points.iter().map(scaled).zip(0..).collect();
        all.sort_unstable_by(|(p, i), (q, j)| {
            p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)).then(p.z.total_cmp(&q.z)).then(i.cmp(j))
        });
        all.dedup_by(|(p, _), (q, _)| p == q);
        let (points, input) = all.into_iter().unzip();
        Sites { points, input }
    }

    pub fn len(&self) -> Site {
        self.points.len() as Site
    }

    pub fn input(&self, site: Site) -> u32 {
        self.input[site as usize]
    }

    /// Positive where `d` lies above the plane through `a`, `b`, `c`, from where they appear counter-clockwise; negative
    /// below. The sign is exact; the magnitude is about six times the volume of the tetrahedron, in the scale of the sites.
    pub fn height(&self, [a, b, c]: [Site; 3], d: Site) -> f64 {
        height(self.at(a), self.at(b), self.at(c), self.at(d))
    }

    /// Positive where `a`, `b`, `c` turn to the left when `dropped_axis` is left out; the sign is exact.
    pub fn turn(&self, dropped_axis: usize, [a, b, c]: [Site; 3]) -> f64 {
        let at = |site: Site| self.projected(dropped_axis, site);
        orient2d(at(a), at(b), at(c))
    }

    /// A site without one of its coordinates.
    pub fn projected(&self, dropped_axis: usize, site: Site) -> DVec2 {
        flatten(dropped_axis, self.at(site))
    }

    fn at(&self, site: Site) -> DVec3 {
        self.points[site as usize]
    }

    /// A site off the line through two, about the farthest, and an axis along which the three are seen to be no line.
    /// `None` exactly if all sites lie on the line.
    pub fn farthest_from_line(&self, a: Site, b: Site) -> Option<(Site, usize)> {
        let mut best = (0.0, None);
        for site in 0..self.len() {
            for axis in 0..3 {
                let turn = self.turn(axis, [a, b, site]).abs();
                if turn > best.0 {
                    best = (turn, Some((site, axis)));
                }
            }
        }
        best.1
    }

    /// The site farthest from a plane, about; `None` exactly if all lie on it.
    pub fn farthest_from_plane(&self, plane: [Site; 3]) -> Option<Site> {
        let mut best = (0.0, None);
        for site in 0..self.len() {
            let height = self.height(plane, site).abs();
            if height > best.0 {
                best = (height, Some(site));
            }
        }
        best.1
    }
}

/// The least `e` with `|x| < 2^e`; 0 for zero.
fn exponent(x: f64) -> i32 {
    if x == 0.0 {
        return 0;
    }
    let biased = (x.to_bits() >> 52 & 0x7FF) as i32;
    // Subnormal numbers are made normal first.
    if biased == 0 { exponent(x * power_of_two(64)) - 64 } else { biased - 1022 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_bracket_their_numbers() {
        for x in [1.0, 0.75, 1e100, 1e-100, f64::MAX, f64::MIN_POSITIVE, 5e-324] {
            let e = exponent(x);
            // x / 2^e in two steps, as above.
            let scaled = x * power_of_two(-e / 2) * power_of_two(-e - -e / 2);
            assert!((0.5..1.0).contains(&scaled), "{x}: {e}");
        }
    }

    #[test]
    fn signs_are_exact_at_both_ends_of_the_range() {
        // The last point is one unit in the last place above the plane of the others.
        for scale in [1e100, 1.0, 1e-100] {
            let above = DVec3::new(1.0, 1.0, f64::EPSILON);
            let points = [DVec3::ZERO, DVec3::X + DVec3::Z, DVec3::Y - DVec3::Z, above].map(|p| p * scale);
            let sites = Sites::new(&points);
            let site = |input: u32| (0..4).find(|&s| sites.input(s) == input).expect("all are distinct");
            assert!(sites.height([site(0), site(1), site(2)], site(3)) > 0.0, "{scale}");
            assert!(sites.height([site(0), site(2), site(1)], site(3)) < 0.0, "{scale}");
        }
    }
}
