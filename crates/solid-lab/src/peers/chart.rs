//! A chart of the ratios, to be understood at a glance: how many times as fast as its peers the library is.

use std::path::Path;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Kind, Peer, Report, Row, TARGETS, targets};

/// Height of a work's two bars, of the head and of the foot, in pixels.
const WORK_HEIGHT: u32 = 24;
const HEAD_HEIGHT: u32 = 74;
const FOOT_HEIGHT: u32 = 40;
const WIDTH: u32 = 960;
const NAMES_WIDTH: u32 = 330;

/// Colours that those who see no difference of red and green can tell apart.
const PEERS: [(Peer, RGBColor, &str); 2] = [
    (Peer::ParryDouble, RGBColor(0, 114, 178), "parry3d-f64"),
    (Peer::Thesis, RGBColor(230, 159, 0), "the thesis's design"),
];

/// What is known of a work and a peer: the ratio, the geometric mean where there are several, and the one asked for.
struct Bar {
    ratio: Option<f64>,
    target: Option<f64>,
}

/// The bars of a work, one for each of [`PEERS`].
struct Work {
    name: &'static str,
    bars: [Bar; 2],
}

fn works(report: &Report) -> Vec<Work> {
    let mut names: Vec<&str> = TARGETS.iter().map(|target| target.work).collect();
    names.dedup();
    let bar = |name: &str, peer: Peer| {
        let of_work =
            |row: &&Row| row.kind == Kind::Time && row.peer == peer && targets::name(&row.work) == Some(name);
        let logs: Vec<f64> =
            report.rows.iter().filter(of_work).filter_map(|row| row.ratio).map(f64::ln).collect();
        let ratio = (!logs.is_empty()).then(|| (logs.iter().sum::<f64>() / logs.len() as f64).exp());
        Bar { ratio, target: targets::ratio(name, peer) }
    };
    let works = names.into_iter().map(|name| Work { name, bars: PEERS.map(|(peer, ..)| bar(name, peer)) });
    works.filter(|work| work.bars.iter().any(|bar| bar.ratio.is_some())).collect()
}

/// Writes the chart as SVG: a bar from 1 to the ratio for each work and peer, and a line at the target.
pub fn draw(report: &Report, path: &Path) -> anyhow::Result<()> {
    let works = works(report);
    anyhow::ensure!(!works.is_empty(), "there is nothing to draw");
    let bars = || works.iter().flat_map(|work| &work.bars);
    let greatest = bars().flat_map(|bar| [bar.ratio, bar.target]).flatten().fold(10.0, f64::max);
    let least = bars().filter_map(|bar| bar.ratio).fold(0.5, f64::min);

    let height = HEAD_HEIGHT + FOOT_HEIGHT + WORK_HEIGHT * works.len() as u32;
    let root = SVGBackend::new(path, (WIDTH, height)).into_drawing_area();
    root.fill(&WHITE)?;
    head(report, &root)?;
    let mut chart = ChartBuilder::on(&root)
        .margin_top(HEAD_HEIGHT)
        .margin_right(30)
        .set_label_area_size(LabelAreaPosition::Left, NAMES_WIDTH)
        .set_label_area_size(LabelAreaPosition::Bottom, FOOT_HEIGHT)
        .build_cartesian_2d((least * 0.9..greatest * 1.6).log_scale(), 0.0..works.len() as f64)?;
    chart
        .configure_mesh()
        .disable_y_mesh()
        .disable_y_axis()
        .light_line_style(WHITE)
        .x_label_formatter(&|x| format!("{x}×"))
        .x_desc("times as fast (logarithmic); a black line is the target")
        .draw()?;
    let names = ("sans-serif", 13).into_font().color(&BLACK).pos(Pos::new(HPos::Right, VPos::Center));
    for (place, work) in (0..works.len()).rev().zip(&works) {
        let bottom = place as f64;
        let (_, y) = chart.backend_coord(&(1.0, bottom + 0.5));
        root.draw(&Text::new(work.name, (NAMES_WIDTH as i32 - 8, y), names.clone()))?;
        for (lane, bar) in work.bars.iter().enumerate() {
            let above = bottom + 0.9 - 0.4 * lane as f64;
            let below = above - 0.36;
            let ratio = bar.ratio.unwrap_or(1.0);
            chart.draw_series([Rectangle::new([(1.0, above), (ratio, below)], PEERS[lane].1.filled())])?;
            if let Some(target) = bar.target {
                let line = vec![(target, above + 0.04), (target, below - 0.04)];
                chart.draw_series([PathElement::new(line, BLACK.stroke_width(2))])?;
            }
        }
    }
    let one = vec![(1.0, 0.0), (1.0, works.len() as f64)];
    chart.draw_series([PathElement::new(one, BLACK.stroke_width(1))])?;
    root.present()?;
    Ok(())
}

/// What it is, where it was measured, and whose the colours are.
fn head(report: &Report, root: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>) -> anyhow::Result<()> {
    let title = ("sans-serif", 20).into_font().color(&BLACK);
    root.draw(&Text::new("How many times as fast solid3d is", (16, 12), title))?;
    let small = ("sans-serif", 13).into_font().color(&RGBColor(80, 80, 80));
    root.draw(&Text::new(format!("{}, {}", report.machine, report.date), (16, 38), small.clone()))?;
    for (i, (_, color, name)) in PEERS.iter().enumerate() {
        let x = NAMES_WIDTH as i32 + 170 * i as i32;
        root.draw(&Rectangle::new([(x, 56), (x + 12, 66)], color.filled()))?;
        root.draw(&Text::new(format!("as {name}"), (x + 18, 55), small.clone()))?;
    }
    Ok(())
}
