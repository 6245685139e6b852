use std::time::Instant;

/// The seconds that `work` takes, with its result.
pub fn seconds<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let result = work();
    (start.elapsed().as_secs_f64(), result)
}

/// The least of several times: other programs only ever make it longer.
pub fn least_seconds(repeats: usize, mut work: impl FnMut()) -> f64 {
    (0..repeats).map(|_| seconds(&mut work).0).fold(f64::INFINITY, f64::min)
}
