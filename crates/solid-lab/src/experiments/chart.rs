use anyhow::{Result, anyhow};
use plotters::prelude::*;

use super::Settings;

/// Width and height in pixels.
const SIZE: (u32, u32) = (760, 420);

/// Colours that the colour-blind can tell apart (Okabe and Ito).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// What is written around a chart.
pub struct Labels<'a> {
    /// Above it.
    pub title: &'a str,
    /// Below it.
    pub x: &'a str,
    /// To the left.
    pub y: &'a str,
}

/// A name and its points.
pub type Series = (String, Vec<(f64, f64)>);

/// Lines over numbers.
pub fn lines(settings: &Settings, file: &str, labels: &Labels, series: &[Series]) -> Result<()> {
    let points = || series.iter().flat_map(|(_, points)| points);
    let (x_max, y_max) = points().fold((0.0, 0.0), |(x, y): (f64, f64), p| (x.max(p.0), y.max(p.1)));
    draw(settings, file, labels, [x_max, y_max], None, |area| {
        for (k, (name, points)) in series.iter().enumerate() {
            let colour = COLOURS[k % COLOURS.len()];
            area.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?
                .label(name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
            area.draw_series(points.iter().map(|p| Circle::new(*p, 3, colour.filled())))?;
        }
        Ok(())
    })
}

/// Groups of bars, one bar of each series in each group.
pub fn bars(
    settings: &Settings,
    file: &str,
    labels: &Labels,
    groups: &[String],
    series: &[(String, Vec<f64>)],
) -> Result<()> {
    let y_max = series.iter().flat_map(|(_, values)| values).fold(0.0, |max: f64, y| max.max(*y));
    draw(settings, file, labels, [groups.len() as f64, y_max], Some(groups), |area| {
        let width = 0.8 / series.len() as f64;
        for (k, (name, values)) in series.iter().enumerate() {
            let colour = COLOURS[k % COLOURS.len()];
            let bar = |(i, y): (usize, &f64)| {
                let left = i as f64 + 0.1 + k as f64 * width;
                Rectangle::new([(left, 0.0), (left + width * 0.95, *y)], colour.filled())
            };
            area.draw_series(values.iter().enumerate().map(bar))?
                .label(name)
                .legend(move |(x, y)| Rectangle::new([(x, y - 5), (x + 12, y + 5)], colour.filled()));
        }
        Ok(())
    })
}

type Area<'a, 'b> = ChartContext<
    'a,
    SVGBackend<'b>,
    Cartesian2d<plotters::coord::types::RangedCoordf64, plotters::coord::types::RangedCoordf64>,
>;

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw(
    settings: &Settings,
    file: &str,
    labels: &Labels,
    [x_max, y_max]: [f64; 2],
    groups: Option<&[String]>,
    series: impl FnOnce(&mut Area) -> Drawn,
) -> Result<()> {
    let path = settings.out_dir.join(file);
    let picture = || -> Drawn {
        let root = SVGBackend::new(&path, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let mut area = ChartBuilder::on(&root)
            .caption(labels.title, ("sans-serif", 18))
            .margin(10)
            .x_label_area_size(40)
            .y_label_area_size(70)
            .build_cartesian_2d(0.0..x_max, 0.0..y_max * 1.08)?;
        let group = |x: &f64| match groups {
            // The name of a group stands at its middle.
            Some(groups) if x.fract() == 0.5 => groups.get(*x as usize).cloned().unwrap_or_default(),
            Some(_) => String::new(),
            None => format!("{x:.0}"),
        };
        area.configure_mesh()
            .x_desc(labels.x)
            .y_desc(labels.y)
            .x_labels(groups.map_or(10, |groups| 2 * groups.len() + 1))
            .x_label_formatter(&group)
            .disable_x_mesh()
            .light_line_style(WHITE)
            .draw()?;
        series(&mut area)?;
        area.configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.85))
            .border_style(BLACK.mix(0.3))
            .draw()?;
        root.present()?;
        Ok(())
    };
    picture().map_err(|error| anyhow!("cannot draw {}: {error}", path.display()))
}
