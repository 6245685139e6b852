use anyhow::{Result, anyhow};
use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
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

/// Lines over numbers, from zero.
pub fn lines(settings: &Settings, file: &str, labels: &Labels, series: &[Series]) -> Result<()> {
    let [(_, x), (_, y)] = ranges(series);
    draw(settings, file, labels, 0.0..x, 0.0..y * 1.08, None, |area| line_series(area, series))
}

/// Lines over positive numbers, on scales where equal steps are equal ratios.
pub fn lines_of_ratios(settings: &Settings, file: &str, labels: &Labels, series: &[Series]) -> Result<()> {
    let [x, y] = ranges(series).map(|(least, greatest)| (least / 1.5..greatest * 1.5).log_scale());
    draw(settings, file, labels, x, y, None, |area| line_series(area, series))
}

/// The least and the greatest of both coordinates.
fn ranges(series: &[Series]) -> [(f64, f64); 2] {
    let points = || series.iter().flat_map(|(_, points)| points);
    let range = |of: fn(&(f64, f64)) -> f64| {
        points()
            .map(of)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(value), high.max(value)))
    };
    [range(|point| point.0), range(|point| point.1)]
}

fn line_series<X, Y>(area: &mut Area<X, Y>, series: &[Series]) -> Drawn
where
    X: Ranged<ValueType = f64>,
    Y: Ranged<ValueType = f64>,
{
    for (k, (name, points)) in series.iter().enumerate() {
        let colour = COLOURS[k % COLOURS.len()];
        area.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?
            .label(name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], colour.stroke_width(2)));
        area.draw_series(points.iter().map(|p| Circle::new(*p, 3, colour.filled())))?;
    }
    Ok(())
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
    draw(settings, file, labels, 0.0..groups.len() as f64, 0.0..y_max * 1.08, Some(groups), |area| {
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

type Area<'a, 'b, X, Y> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<X, Y>>;

type Drawn = Result<(), Box<dyn std::error::Error>>;

fn draw<X, Y>(
    settings: &Settings,
    file: &str,
    labels: &Labels,
    x: X,
    y: Y,
    groups: Option<&[String]>,
    series: impl FnOnce(&mut Area<X::CoordDescType, Y::CoordDescType>) -> Drawn,
) -> Result<()>
where
    X: AsRangedCoord<Value = f64>,
    Y: AsRangedCoord<Value = f64>,
    X::CoordDescType: ValueFormatter<f64>,
    Y::CoordDescType: ValueFormatter<f64>,
{
    let path = settings.out_dir.join(file);
    let picture = || -> Drawn {
        let root = SVGBackend::new(&path, SIZE).into_drawing_area();
        root.fill(&WHITE)?;
        let mut area = ChartBuilder::on(&root)
            .caption(labels.title, ("sans-serif", 18))
            .margin(10)
            .x_label_area_size(40)
            .y_label_area_size(70)
            .build_cartesian_2d(x, y)?;
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
