use std::fmt::Write;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use super::{Claim, Experiment, Kind, Report};

/// Puts what was found into a document, between the marks `<!-- results of NAME -->` and `<!-- end of NAME -->`. The prose around
/// them stays.
pub fn write_summary(document: &Path, found: &[(&Experiment, Report)]) -> Result<()> {
    let mut text =
        fs::read_to_string(document).with_context(|| format!("cannot read {}", document.display()))?;
    for (experiment, report) in found {
        let [begin, end] = marks(experiment.name);
        let missing = || format!("{} has no marks for {}", document.display(), experiment.name);
        let start = text.find(&begin).with_context(missing)? + begin.len();
        let stop = start + text[start..].find(&end).with_context(missing)?;
        text.replace_range(start..stop, &format!("\n\n{}\n", report.markdown()));
    }
    fs::write(document, text).with_context(|| format!("cannot write {}", document.display()))
}

fn marks(name: &str) -> [String; 2] {
    [format!("<!-- results of {name} -->"), format!("<!-- end of {name} -->")]
}

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
    fn markdown(&self) -> String {
        let mut text = String::from("| | thesis | here | here / thesis | |\n|---|---|---|---|---|\n");
        for claim in &self.claims {
            let _ = writeln!(text, "| {} |", claim.cells().join(" | "));
        }
        for (file, what) in &self.charts {
            let _ = write!(text, "\n![{what}](experiments/{file})\n");
        }
        text
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
    use super::super::all;
    use super::*;

    #[test]
    fn results_go_between_the_marks_and_prose_stays() {
        let folder = std::env::temp_dir().join(format!("solid-lab-summary-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let document = folder.join("experiments.md");
        let experiment = &all()[0];
        let [begin, end] = marks(experiment.name);
        fs::write(&document, format!("before\n{begin}\nold\n{end}\nafter\n")).unwrap();
        let claim = Claim {
            what: "hits".into(),
            thesis: 40.0,
            ours: 41.0,
            unit: "%",
            kind: Kind::Count { error: 2.0 },
        };
        let report = Report { claims: vec![claim], charts: vec![("a.svg".into(), "A chart".into())] };
        write_summary(&document, &[(experiment, report)]).unwrap();
        let text = fs::read_to_string(&document).unwrap();
        assert!(text.starts_with("before\n") && text.ends_with("after\n") && !text.contains("old"), "{text}");
        assert!(text.contains("| hits | 40.0 % | 41.0 % | 1.02 | agrees |"), "{text}");
        assert!(text.contains("![A chart](experiments/a.svg)"), "{text}");
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn the_document_has_marks_for_every_experiment() {
        let document = include_str!("../../../../docs/experiments.md");
        for experiment in all() {
            let [begin, end] = marks(experiment.name);
            assert!(document.contains(&begin) && document.contains(&end), "{}", experiment.name);
        }
    }
}
