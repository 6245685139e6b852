/// The middle of some figures and how far they spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Half are below.
    pub median: f64,
    /// A quarter is below the first, a quarter above the second.
    pub quartiles: [f64; 2],
}

impl Spread {
    /// Of at least one figure.
    ///
    /// # Panics
    /// When there is none.
    pub fn of(mut figures: Vec<f64>) -> Self {
        assert!(!figures.is_empty(), "a spread is one of figures");
        figures.sort_unstable_by(f64::total_cmp);
        let at = |share: f64| {
            let place = share * (figures.len() - 1) as f64;
            let (below, above) = (figures[place.floor() as usize], figures[place.ceil() as usize]);
            below + (above - below) * place.fract()
        };
        Spread { median: at(0.5), quartiles: [at(0.25), at(0.75)] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_lie_between_the_figures() {
        let spread = Spread::of(vec![4.0, 1.0, 3.0, 2.0, 5.0]);
        assert_eq!(spread, Spread { median: 3.0, quartiles: [2.0, 4.0] });
        assert_eq!(Spread::of(vec![1.0, 2.0]).median, 1.5);
    }
}
