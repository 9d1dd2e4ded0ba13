//! Charts and maps as SVG, by plotters.

use plotters::coord::ranged1d::{AsRangedCoord, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

type DrawingResult = Result<(), Box<dyn std::error::Error>>;

/// Size of a chart, px.
const SIZE: [u32; 2] = [760, 420];
/// Width of a map and bounds of its height, px; space for labels at the left and below.
const MAP_WIDTH: u32 = 860;
const MAP_HEIGHT: [u32; 2] = [300, 820];
const LABELS: [u32; 2] = [58, 42];
/// Colours of limits and obstacles.
const LIMIT: RGBColor = RGBColor(205, 60, 50);
/// Space for the legend at the right, as a fraction of the horizontal axis.
const LEGEND_SPACE: f64 = 0.3;
/// More curves than this have no legend.
const MAX_LEGEND: usize = 10;

/// A line through points, or the points alone.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its name in the legend; empty: none.
    pub label: String,
    /// Red, green, blue.
    pub colour: [u8; 3],
    /// In px.
    pub width: u32,
    /// Only the points.
    pub is_dots: bool,
    /// The points, x ascending in a chart.
    pub points: Vec<(f64, f64)>,
}

/// A chart or a map.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// Labels of the axes, with units.
    pub labels: [String; 2],
    /// The curves.
    pub curves: Vec<Curve>,
    /// Horizontal lines with their names.
    pub limits: Vec<(String, f64)>,
    /// Filled outlines.
    pub areas: Vec<Vec<(f64, f64)>>,
    /// Both axes have the same scale.
    pub is_map: bool,
    /// The vertical axis is logarithmic.
    pub is_log: bool,
}

impl Curve {
    /// A line.
    pub fn line(label: impl Into<String>, colour: [u8; 3], points: Vec<(f64, f64)>) -> Self {
        Self { label: label.into(), colour, width: 2, is_dots: false, points }
    }

    /// Dots.
    pub fn dots(label: impl Into<String>, colour: [u8; 3], points: Vec<(f64, f64)>) -> Self {
        Self { is_dots: true, ..Self::line(label, colour, points) }
    }
}

impl Chart {
    /// The SVG document; `None` if there is nothing to draw.
    pub fn svg(&self) -> Option<String> {
        let [x, y] = self.ranges()?;
        let mut svg = String::new();
        let size = self.size([x, y]);
        let backend = SVGBackend::with_string(&mut svg, (size[0], size[1]));
        let drawn = match self.is_log {
            true => self.draw(backend, x, (y[0]..y[1]).log_scale()),
            false => self.draw(backend, x, y[0]..y[1]),
        };
        drawn.ok()?;
        Some(svg)
    }

    /// Ranges of both axes, with a margin.
    fn ranges(&self) -> Option<[[f64; 2]; 2]> {
        let points = || self.curves.iter().flat_map(|curve| &curve.points).chain(self.areas.iter().flatten());
        let mut x = span(points().map(|point| point.0))?;
        if self.has_legend() && !self.is_map {
            x[1] += LEGEND_SPACE * (x[1] - x[0]);
        }
        let y = span(points().map(|point| point.1).chain(self.limits.iter().map(|(_, value)| *value)))?;
        let y = match (self.is_log, self.is_map) {
            (true, _) => [y[0] / 1.5, y[1] * 1.5],
            (false, is_map) => widened(y, if is_map { 0.03 } else { 0.06 }),
        };
        Some([if self.is_map { widened(x, 0.03) } else { x }, y])
    }

    fn has_legend(&self) -> bool {
        (1..=MAX_LEGEND).contains(&self.curves.iter().filter(|curve| !curve.label.is_empty()).count())
    }

    fn size(&self, [x, y]: [[f64; 2]; 2]) -> [u32; 2] {
        if !self.is_map {
            return SIZE;
        }
        let per_metre = f64::from(MAP_WIDTH - LABELS[0] - 24) / (x[1] - x[0]);
        let height = ((y[1] - y[0]) * per_metre) as u32 + LABELS[1] + 24;
        [MAP_WIDTH, height.clamp(MAP_HEIGHT[0], MAP_HEIGHT[1])]
    }

    fn draw<Y>(&self, backend: SVGBackend<'_>, x: [f64; 2], y: Y) -> DrawingResult
    where
        Y: AsRangedCoord<Value = f64>,
        Y::CoordDescType: ValueFormatter<f64>,
    {
        let root = backend.into_drawing_area();
        root.fill(&WHITE)?;
        let mut builder = ChartBuilder::on(&root);
        builder.margin(12).x_label_area_size(LABELS[1]).y_label_area_size(LABELS[0]);
        let mut chart = builder.build_cartesian_2d(x[0]..x[1], y)?;
        let mesh_style = ("sans-serif", 13);
        let mut mesh = chart.configure_mesh();
        mesh.x_desc(&self.labels[0]).y_desc(&self.labels[1]).label_style(mesh_style).axis_desc_style(mesh_style);
        mesh.light_line_style(TRANSPARENT).bold_line_style(RGBColor(228, 231, 236)).draw()?;
        for area in &self.areas {
            chart.draw_series(std::iter::once(Polygon::new(area.clone(), LIMIT.mix(0.14))))?;
            let outline = area.iter().chain(area.first()).copied().collect::<Vec<_>>();
            chart.draw_series(std::iter::once(PathElement::new(outline, LIMIT.stroke_width(1))))?;
        }
        for (name, value) in &self.limits {
            let line = vec![(x[0], *value), (x[1], *value)];
            chart.draw_series(std::iter::once(PathElement::new(line, LIMIT.stroke_width(1))))?;
            let style = ("sans-serif", 12).into_font().color(&LIMIT).pos(Pos::new(HPos::Right, VPos::Bottom));
            chart.draw_series(std::iter::once(Text::new(name.clone(), (x[1], *value), style)))?;
        }
        for curve in &self.curves {
            let [r, g, b] = curve.colour;
            let style = RGBColor(r, g, b).stroke_width(curve.width);
            let drawn = if curve.is_dots {
                let dot = |point: &(f64, f64)| Circle::new(*point, 4, style.filled());
                chart.draw_series(curve.points.iter().map(dot))?
            } else {
                chart.draw_series(LineSeries::new(curve.points.iter().copied(), style))?
            };
            if !curve.label.is_empty() {
                let annotated = drawn.label(&curve.label);
                match curve.is_dots {
                    true => annotated.legend(move |(x, y)| Circle::new((x + 9, y), 4, style.filled())),
                    false => annotated.legend(move |(x, y)| PathElement::new(vec![(x, y), (x + 18, y)], style)),
                };
            }
        }
        if self.has_legend() {
            let mut labels = chart.configure_series_labels();
            labels.background_style(WHITE.mix(0.85)).border_style(RGBColor(190, 195, 205)).label_font(mesh_style);
            labels.position(SeriesLabelPosition::UpperRight).draw()?;
        }
        root.present()?;
        Ok(())
    }
}

/// Smallest and largest finite value; `None` without any.
fn span(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let ranges = values.filter(|value| value.is_finite()).map(|value| [value, value]);
    ranges.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}

fn widened([low, high]: [f64; 2], fraction: f64) -> [f64; 2] {
    let margin = if high > low { fraction * (high - low) } else { 0.5 };
    [low - margin, high + margin]
}

#[cfg(test)]
mod tests {
    use super::{Chart, Curve};

    #[test]
    fn a_chart_holds_its_curves_and_its_labels_and_an_empty_one_is_none() {
        let labels = ["time [s]".to_owned(), "altitude [m]".to_owned()];
        let curve = Curve::line("uav-1", [10, 20, 200], vec![(0.0, 400.0), (10.0, 410.0), (20.0, 400.0)]);
        let chart =
            Chart { labels, curves: vec![curve], limits: vec![("limit 500 m".into(), 500.0)], ..Chart::default() };
        let svg = chart.svg().unwrap();
        for part in ["<svg", "<polyline", "altitude [m]", "uav-1", "limit 500 m", "</svg>"] {
            assert!(svg.contains(part), "`{part}` is missing in {svg}");
        }
        assert_eq!(Chart::default().svg(), None);
    }
}
