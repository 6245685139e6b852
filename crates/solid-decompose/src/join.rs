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

    /// A cube of size 1 with its least corner at (x, y, 0).
    fn brick((x, y): (f64, f64)) -> Piece {
        let corner = |i: u32| DVec3::new(x + f64::from(i & 1), y + f64::from(i >> 1 & 1), f64::from(i >> 2));
        let corners = (0..8).map(|i| Corner { at: corner(i), is_cut: false });
        Piece::of(corners.collect()).expect("it has corners")
    }

    /// Three bricks side by side, the middle one raised: the hull of two adds 0.3, and that of all as much again.
    #[test]
    fn what_was_added_before_counts() {
        let bricks = || [(0.0, 0.0), (1.0, 0.3), (2.0, 0.0)].map(brick).to_vec();
        assert_eq!([0.2, 0.5, 0.7].map(|allowance| join(bricks(), 32, allowance).len()), [3, 2, 1]);
    }

    /// Whatever is between them, where there may be no more.
    #[test]
    fn what_is_apart_is_joined_only_where_there_are_too_many() {
        let bricks = || [(0.0, 0.0), (5.0, 0.0)].map(brick).to_vec();
        assert_eq!([1, 2].map(|pieces_max| join(bricks(), pieces_max, 9.0).len()), [1, 2]);
    }
}
