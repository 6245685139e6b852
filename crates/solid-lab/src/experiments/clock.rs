use std::time::Duration;

use cpu_time::ThreadTime;

/// The seconds that this thread works on `work`, with its result; what other programs take is not counted.
pub fn seconds<T>(work: impl FnOnce() -> T) -> (f64, T) {
    let start = ThreadTime::now();
    let result = work();
    (Duration::as_secs_f64(&start.elapsed()), result)
}

/// The least of several times: disturbances only ever make it longer.
pub fn least_seconds(repeats: usize, mut work: impl FnMut()) -> f64 {
    (0..repeats).map(|_| seconds(&mut work).0).fold(f64::INFINITY, f64::min)
}
