//! Tests of the laws.

mod agreement;
mod cases;
mod holes;
mod timing;
mod uneven;
mod volumes;

fn assert_rate(what: &str, hits: usize, cases: usize) {
    let rate = hits as f64 / cases as f64;
    println!("{what}: {hits} of {cases} hit");
    assert!((0.3..=0.7).contains(&rate), "{what}: a hit rate of {rate} tests little");
}
