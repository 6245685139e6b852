//! Joining pieces: those first whose hull adds the least.

use std::collections::HashMap;

use crate::piece::Piece;

/// Joins pieces until there are at most so many, and then for as long as no piece covers more than `allowance` that the pieces which
/// it was made of did not.
///
/// Only pieces whose boxes touch are tried; others only when there are too many pieces, and no such pair is left. Cost: a hull
/// for each pair that is tried, some ten for each piece.
pub fn join(pieces: Vec<Piece>, pieces_max: usize, allowance: f64) -> Vec<Piece> {
    let mut numbers = pieces.len();
    // With numbers that last, in ascending order.
    let mut pieces: Vec<(usize, Piece)> = pieces.into_iter().enumerate().collect();
    let mut tried = HashMap::new();
    while let Some((i, j, added)) = best(&pieces, pieces_max, &mut tried) {
        if pieces.len() <= pieces_max && added > allowance {
            break;
        }
        let (_, other) = pieces.remove(j);
        let (_, one) = pieces.remove(i);
        pieces.push((numbers, one.joined(&other)));
        numbers += 1;
    }
    pieces.into_iter().map(|(_, piece)| piece).collect()
}

/// The places of the two pieces that add the least, with what their hull would have added.
fn best(
    pieces: &[(usize, Piece)],
    pieces_max: usize,
    tried: &mut HashMap<[usize; 2], f64>,
) -> Option<(usize, usize, f64)> {
    let mut least = |only_neighbours: bool| {
        let mut least: Option<(usize, usize, f64)> = None;
        for (i, (number, one)) in pieces.iter().enumerate() {
            for (j, (other_number, other)) in pieces.iter().enumerate().skip(i + 1) {
                if only_neighbours && !one.bounds.overlaps(&other.bounds) {
                    continue;
                }
                let added = *tried.entry([*number, *other_number]).or_insert_with(|| one.joined(other).added);
                if least.is_none_or(|(_, _, least)| added < least) {
                    least = Some((i, j, added));
                }
            }
        }
        least
    };
    least(true).or_else(|| if pieces.len() > pieces_max { least(false) } else { None })
}

#[cfg(test)]
mod tests {
    use solid3d::glam::DVec3;

    use super::*;
    use crate::piece::Corner;

    /// Three bricks side by side, the middle one raised: the hull of two adds 0.3, and that of all as much again.
    #[test]
    fn what_was_added_before_counts() {
        let bricks = || {
            let corners = |x: f64, y: f64| {
                (0..8).map(move |i| {
                    DVec3::new(x + f64::from(i & 1), y + f64::from(i >> 1 & 1), f64::from(i >> 2))
                })
            };
            let brick = |(x, y)| corners(x, y).map(|at| Corner { at, is_cut: false }).collect();
            [(0.0, 0.0), (1.0, 0.3), (2.0, 0.0)].map(|place| Piece::of(brick(place)).expect("it has corners"))
        };
        let count = |allowance| join(bricks().to_vec(), 32, allowance).len();
        assert_eq!([0.2, 0.5, 0.7].map(count), [3, 2, 1]);
    }
}
