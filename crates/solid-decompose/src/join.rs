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
