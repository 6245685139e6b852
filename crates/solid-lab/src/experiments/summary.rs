use std::fmt::Write;

use super::{Claim, Kind, Report};

impl Report {
    /// The comparison with the thesis, a line for each figure.
    pub fn text(&self) -> String {
        let line = |claim: &Claim| {
            let [what, thesis, ours, ratio, verdict] = claim.cells();
            format!("  {what:70} {thesis:>12} {ours:>12} {ratio:>9}  {verdict}\n")
        };
        let header = format!("  {:70} {:>12} {:>12} {:>9}\n", "", "thesis", "here", "ratio");
        header + &self.claims.iter().map(line).collect::<String>()
    }

    /// The same as a table, and the charts.
    pub fn markdown(&self) -> String {
        let mut text = String::from("| | thesis | here | here / thesis | |\n|---|---|---|---|---|\n");
        for claim in &self.claims {
            let _ = writeln!(text, "| {} |", claim.cells().join(" | "));
        }
        for (file, what) in &self.charts {
            let _ = write!(text, "\n![{what}](experiments/{file})\n");
        }
        text.trim_end().to_owned()
    }
}

impl Claim {
    /// What, the thesis's figure, ours, their ratio, and what to make of it.
    fn cells(&self) -> [String; 5] {
        let number = |x: f64| format!("{} {}", short(x), self.unit).trim().to_owned();
        let verdict = match (self.agrees(), self.kind) {
            (Some(true), _) => "agrees",
            (Some(false), _) => "**differs**",
            (None, Kind::Time) => "time",
            (None, _) => "model",
        };
        [self.what.clone(), number(self.thesis), number(self.ours), short(self.ratio()), verdict.to_owned()]
    }
}

/// Three digits that count.
fn short(x: f64) -> String {
    if x.is_nan() {
        return "-".to_owned();
    }
    if x == 0.0 || x.is_infinite() {
        return x.to_string();
    }
    let digits = 2 - x.abs().log10().floor() as i32;
    match digits {
        ..=0 => format!("{x:.0}"),
        1..=6 => format!("{x:.*}", digits as usize),
        _ => format!("{x:.2e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_claim_is_a_line_and_a_chart_is_shown() {
        let claim = Claim {
            what: "hits".into(),
            thesis: 40.0,
            ours: 41.0,
            unit: "%",
            kind: Kind::Count { error: 2.0 },
        };
        let report = Report { claims: vec![claim], charts: vec![("a.svg".into(), "A chart".into())] };
        let text = report.markdown();
        assert!(text.contains("| hits | 40.0 % | 41.0 % | 1.02 | agrees |"), "{text}");
        assert!(text.contains("![A chart](experiments/a.svg)"), "{text}");
    }
}
