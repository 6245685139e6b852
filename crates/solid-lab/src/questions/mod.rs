//! Every question of every pair of kinds beside parry3d-f64, where [`peers`](crate::peers) has a target for some: so that none is slow without anybody
//! knowing.
//!
//! | file | holds |
//! |---|---|
//! | `kinds` | the kinds, in the types of both |
//! | `poses` | where they are |
//! | `asked` | the questions |
//! | `crowd` | worlds of a kind |
//! | `field` | worlds at rest |
//! | `ground` | what stands on a mesh |
//! | `table` | what comes out |

mod asked;
mod crowd;
mod field;
mod ground;
mod kinds;
mod poses;
mod table;

use std::time::{Duration, Instant};

use cpu_time::ThreadTime;

use crate::inputs::seeded;
use crate::peers::{Effort, Spread, date, machine, with_commas};
use asked::{ALONE, Asker, OF_PAIRS};
use crowd::{Crowd, OF_CROWDS};
use field::{Field, OF_FIELDS};
use ground::{GROUNDS, Standing, ground};
use kinds::Kind;
pub use table::{table, table_of_grounds};

/// A turn takes at least so long.
const TURN_MIN: Duration = Duration::from_millis(1);

/// No question takes more rounds than this.
const ROUNDS_MAX: usize = 9;

/// What one question took.
#[derive(Clone, Copy, Debug)]
pub struct Cell {
    /// Microseconds that ours takes.
    pub micros: f64,
    /// How many times as long parry takes; `None` where it has no answer.
    pub ratio: Option<f64>,
}

/// Questions of some kinds: a row each.
#[derive(Clone, Debug)]
pub struct Asked {
    /// The questions.
    pub questions: Vec<&'static str>,
    /// The kinds, and a cell for each question.
    pub rows: Vec<(String, Vec<Cell>)>,
}

/// What was measured, on what.
#[derive(Clone, Debug)]
pub struct Report {
    /// Of all random numbers.
    pub seed: u64,
    /// The processor.
    pub machine: String,
    /// Year-month-day.
    pub date: String,
    /// Of two shapes.
    pub pairs: Asked,
    /// Of one.
    pub alone: Asked,
    /// Of a frame of many.
    pub crowds: Asked,
    /// Of many at rest.
    pub fields: Asked,
    /// The contacts of what stands on a mesh.
    pub grounds: Asked,
}

impl Report {
    fn asked(&self) -> [&Asked; 4] {
        [&self.pairs, &self.alone, &self.crowds, &self.fields]
    }
}

/// Measures everything. `progress` is told the kinds before their turn.
pub fn run(effort: Effort, seed: u64, mut progress: impl FnMut(&str)) -> Report {
    let mut rng = seeded(seed);
    let kinds = kinds::all(effort, &mut rng);
    let mut pairs = Asked { questions: OF_PAIRS.map(|(name, _)| name).to_vec(), rows: Vec::new() };
    let mut alone = Asked { questions: ALONE.map(|(name, _)| name).to_vec(), rows: Vec::new() };
    for (i, a) in kinds.iter().enumerate() {
        for b in &kinds[i..] {
            let name = format!("{}, {}", a.name, b.name);
            progress(&name);
            let poses = poses::of_pair(effort, &mut rng, a, b);
            let cells = OF_PAIRS.iter().map(|(_, ask)| race(effort, poses.len(), ask(a, b, &poses)));
            pairs.rows.push((name, cells.collect()));
        }
        let sights = poses::of_one(effort, &mut rng);
        let cells = ALONE.iter().map(|(_, ask)| race(effort, sights.len(), ask(a, &sights)));
        alone.rows.push((a.name.to_string(), cells.collect()));
    }
    let mut crowds = Asked { questions: OF_CROWDS.map(|(name, _)| name).to_vec(), rows: Vec::new() };
    let convex: Vec<&Kind> = kinds.iter().filter(|kind| kind.theirs.as_trimesh().is_none()).collect();
    let of_one_kind = convex.iter().map(|&kind| (kind.name, vec![kind]));
    for (name, kinds) in of_one_kind.chain([("all of these", convex.clone())]) {
        progress(&format!("a world of {name}"));
        let crowd = Crowd::new(effort, &mut rng, kinds);
        let cells = OF_CROWDS.iter().map(|(_, ask)| race(effort, crowd.len(), ask(&crowd)));
        crowds.rows.push((name.to_string(), cells.collect()));
    }
    let mut fields = Asked { questions: OF_FIELDS.map(|(name, _)| name).to_vec(), rows: Vec::new() };
    for objects in field::OBJECTS {
        let name = with_commas(objects);
        progress(&format!("a world of {name} at rest"));
        let field = Field::new(effort, &mut rng, convex.clone(), objects);
        let cells = OF_FIELDS.iter().map(|(_, ask)| race(effort, field.len(), ask(&field)));
        fields.rows.push((name, cells.collect()));
    }
    let mut grounds = Asked { questions: GROUNDS.map(|(name, _)| name).to_vec(), rows: Vec::new() };
    let meshes = GROUNDS.map(|of| ground(effort, &mut rng, of));
    for kind in convex {
        progress(&format!("{} on a ground", kind.name));
        let standing = meshes.each_ref().map(|mesh| Standing::new(effort, &mut rng, mesh, kind));
        let cells = standing.iter().map(|standing| race(effort, standing.len(), standing.contacts()));
        grounds.rows.push((kind.name.to_string(), cells.collect()));
    }
    Report { seed, machine: machine(), date: date(), pairs, alone, crowds, fields, grounds }
}

/// Lets both take turns at a question.
fn race(effort: Effort, count: usize, (ours, theirs): (Asker, Option<Asker>)) -> Cell {
    let askers: Vec<Asker> = std::iter::once(ours).chain(theirs).collect();
    // The first turn warms up.
    let passes: Vec<usize> = askers.iter().map(|ask| passes(effort, turn(ask, count, 1))).collect();
    let mut micros = vec![Vec::new(); askers.len()];
    let start = Instant::now();
    while micros[0].len() < effort.rounds_min()
        || (start.elapsed() < effort.budget() / 4 && micros[0].len() < ROUNDS_MAX)
    {
        for ((ask, &passes), micros) in askers.iter().zip(&passes).zip(&mut micros) {
            let time = turn(ask, count, passes);
            micros.push(1e6 * time.as_secs_f64() / (passes * count) as f64);
        }
    }
    let mut medians = micros.into_iter().map(|micros| Spread::of(micros).median);
    let ours = medians.next().unwrap_or_default();
    Cell { micros: ours, ratio: medians.next().map(|theirs| theirs / ours.max(1e-9)) }
}

/// How often a question is asked in a turn, by how long it takes to ask all once.
fn passes(effort: Effort, once: Duration) -> usize {
    match effort {
        Effort::Smoke => 1,
        _ => (TURN_MIN.as_secs_f64() / once.as_secs_f64().max(1e-9)).ceil() as usize,
    }
}

fn turn(ask: &Asker, count: usize, passes: usize) -> Duration {
    let start = ThreadTime::now();
    for _ in 0..passes {
        std::hint::black_box((0..count).map(ask).sum::<f64>());
    }
    start.elapsed()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_question_is_asked_of_every_kind() {
        let report = run(Effort::Smoke, 1999, |_| {});
        let asked = || report.asked().into_iter().chain([&report.grounds]);
        assert!(asked().map(|asked| asked.rows.len()).eq([28, 7, 7, 3, 6]));
        let cells = asked().flat_map(|asked| &asked.rows).flat_map(|(_, cells)| cells);
        assert!(cells.clone().all(|cell| cell.micros > 0.0));
        // Of two meshes parry has no depth, no contacts and no time of impact.
        assert_eq!(cells.filter(|cell| cell.ratio.is_none()).count(), 3);
        assert!(table(&report).contains("ball, mesh of 5,000"));
        assert!(table_of_grounds(&report).contains("| hull of 20 |"));
    }
}
