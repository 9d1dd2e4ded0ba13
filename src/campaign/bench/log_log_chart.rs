//! Charts with two logarithmic axes, as SVG.

use std::fmt::Write;

/// Size of a panel, and its margins left, top, right and below, px.
const SIZE: [f64; 2] = [480.0, 380.0];
const MARGINS: [f64; 4] = [64.0, 34.0, 16.0, 48.0];

/// A line through points, both coordinates > 0.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its name in the legend; empty: none.
    pub label: String,
    /// Colour, as in CSS.
    pub colour: &'static str,
    /// Dash pattern, as in SVG; empty: solid.
    pub dash: &'static str,
    /// Are the points marked?
    pub marked: bool,
    /// The points, x ascending.
    pub points: Vec<[f64; 2]>,
}

/// One pair of axes with its curves.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Title.
    pub title: String,
    /// Labels of the axes.
    pub labels: [&'static str; 2],
    /// The curves.
    pub curves: Vec<Curve>,
}

/// Ranges of both axes: whole decades.
#[derive(Clone, Copy)]
struct Decades([[i32; 2]; 2]);

/// The panels side by side, as an SVG document.
pub fn svg(panels: &[Panel]) -> String {
    let [width, height] = [SIZE[0] * panels.len() as f64, SIZE[1]];
    let mut page = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" \
         font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    for (i, panel) in panels.iter().enumerate() {
        page.push_str(&format!("<g transform=\"translate({} 0)\">\n{}</g>\n", SIZE[0] * i as f64, group(panel)));
    }
    page + "</svg>\n"
}

fn group(panel: &Panel) -> String {
    let axes = Decades::of(panel);
    let mut group = axes.grid(panel);
    for (i, curve) in panel.curves.iter().enumerate() {
        group.push_str(&axes.line(curve));
        if !curve.label.is_empty() {
            group.push_str(&legend(curve, i));
        }
    }
    group
}

fn legend(curve: &Curve, row: usize) -> String {
    let (x, y) = (MARGINS[0] + 10.0, MARGINS[1] + 14.0 + 16.0 * row as f64);
    format!(
        "<line x1=\"{x}\" y1=\"{y}\" x2=\"{}\" y2=\"{y}\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\"/>\
         <text x=\"{}\" y=\"{}\">{}</text>\n",
        x + 24.0,
        curve.colour,
        curve.dash,
        x + 30.0,
        y + 4.0,
        curve.label
    )
}

impl Decades {
    fn of(panel: &Panel) -> Self {
        let decades = |axis: usize| {
            let logs = panel.curves.iter().flat_map(|curve| &curve.points).map(|point| point[axis].log10());
            let (min, max) = logs.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), log| (a.min(log), b.max(log)));
            if min.is_finite() { [min.floor() as i32, (max.ceil() as i32).max(min.floor() as i32 + 1)] } else { [0, 1] }
        };
        Self([decades(0), decades(1)])
    }

    /// Pixels of a point.
    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let fraction = |axis: usize, value: f64| {
            let [from, to] = self.0[axis].map(f64::from);
            (value.log10() - from) / (to - from)
        };
        let [left, top, right, below] = MARGINS;
        [left + fraction(0, x) * (SIZE[0] - left - right), SIZE[1] - below - fraction(1, y) * (SIZE[1] - top - below)]
    }

    /// Title, labels, and a line with its number for every decade.
    fn grid(&self, panel: &Panel) -> String {
        let ([left, top, right, below], [width, height]) = (MARGINS, SIZE);
        let mut grid = format!(
            "<text x=\"{}\" y=\"20\" text-anchor=\"middle\" font-weight=\"bold\">{}</text>\
             <text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\
             <text transform=\"translate(16 {}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
            width / 2.0,
            panel.title,
            width / 2.0,
            height - 10.0,
            panel.labels[0],
            height / 2.0,
            panel.labels[1]
        );
        let mut line = |[x1, y1, x2, y2]: [f64; 4], [x, y]: [f64; 2], anchor: &str, exponent: i32| {
            let _ = writeln!(
                grid,
                "<line x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" stroke=\"#ddd\"/><text x=\"{x:.1}\" \
                 y=\"{y:.1}\" text-anchor=\"{anchor}\">10<tspan dy=\"-5\" font-size=\"9\">{exponent}</tspan></text>"
            );
        };
        let [[x_from, x_to], [y_from, y_to]] = self.0;
        for exponent in x_from..=x_to {
            let [x, _] = self.place([10_f64.powi(exponent), 1.0]);
            line([x, top, x, height - below], [x, height - below + 18.0], "middle", exponent);
        }
        for exponent in y_from..=y_to {
            let [_, y] = self.place([1.0, 10_f64.powi(exponent)]);
            line([left, y, width - right, y], [left - 6.0, y + 4.0], "end", exponent);
        }
        grid
    }

    fn line(&self, curve: &Curve) -> String {
        let places: Vec<[f64; 2]> = curve.points.iter().map(|point| self.place(*point)).collect();
        let points: Vec<String> = places.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
        let mut line = format!(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" stroke-dasharray=\"{}\"/>\n",
            points.join(" "),
            curve.colour,
            curve.dash
        );
        for [x, y] in places.iter().filter(|_| curve.marked) {
            let _ = writeln!(line, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{}\"/>", curve.colour);
        }
        line
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(points: Vec<[f64; 2]>) -> Panel {
        let curve = Curve { label: "cubes".into(), colour: "black", dash: "", marked: true, points };
        Panel { title: "growth".into(), labels: ["n", "n³"], curves: vec![curve] }
    }

    #[test]
    fn points_lie_between_the_axes_in_proportion_to_their_logarithms() {
        let points = vec![[10.0, 1e3], [100.0, 1e6], [1000.0, 1e9]];
        let axes = Decades::of(&panel(points.clone()));
        let places: Vec<[f64; 2]> = points.into_iter().map(|point| axes.place(point)).collect();
        assert_eq!(places[0], [MARGINS[0], SIZE[1] - MARGINS[3]]);
        assert_eq!(places[2], [SIZE[0] - MARGINS[2], MARGINS[1]]);
        let middle = [0, 1].map(|axis| 0.5 * (places[0][axis] + places[2][axis]));
        assert!((0..2).all(|axis| (places[1][axis] - middle[axis]).abs() < 1e-9));
    }

    #[test]
    fn a_chart_has_every_curve_and_every_decade() {
        let page = svg(&[panel(vec![[10.0, 1e3], [100.0, 1e6]]), panel(Vec::new())]);
        assert_eq!(page.matches("<polyline").count(), 2);
        assert_eq!(page.matches("<circle").count(), 2);
        assert_eq!(page.matches("cubes").count(), 2);
        assert!([1, 2, 3, 4, 5, 6].iter().all(|exponent| page.contains(&format!("font-size=\"9\">{exponent}<"))));
        assert!(!page.contains("NaN") && !page.contains("inf"));
    }
}
