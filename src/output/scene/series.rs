//! Quantities over time that are not sampled at the steps of a log, their limits, and the plots that show them.

use serde::Serialize;

use super::curve::Curve;
use crate::number_format::given_quantity;
use crate::output::scene::colours;

/// A quantity over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// The plot that it belongs to: `separation`.
    pub group: &'static str,
    /// Its name, unique in its plot.
    pub name: String,
    /// What is shown beside its line.
    pub title: String,
    /// Is it a quantity or a limit?
    pub kind: SeriesKind,
    /// Colour.
    pub colour: [u8; 3],
    /// Width of its line, points on the screen.
    pub width: f32,
    /// Is a value held until the next one? Else the line runs straight from one to the next.
    pub is_stepped: bool,
    /// Its values.
    pub curve: Curve,
}

/// Kinds of series.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum SeriesKind {
    /// A quantity.
    Quantity,
    /// A limit: constant.
    Limit,
}

/// A discrete state over time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StateSeries {
    /// What it is the state of.
    pub group: &'static str,
    /// Its name, unique in its group.
    pub name: &'static str,
    /// The state from each time on, s.
    pub changes: Vec<(f64, &'static str)>,
}

/// A group of plots.
#[derive(Clone, Debug, PartialEq)]
pub struct Tab {
    /// Title.
    pub name: &'static str,
    /// The plots from top to bottom.
    pub plots: Vec<PlotView>,
}

/// A plot: every series and limit of one group.
#[derive(Clone, Debug, PartialEq)]
pub struct PlotView {
    /// The group.
    pub group: &'static str,
    /// Title, with unit.
    pub title: String,
    /// Its height, relative to its neighbours'.
    pub height: f32,
    /// Is there a legend?
    pub has_legend: bool,
    /// Range of its vertical axis, in its unit; `None`: that of its values.
    pub range: Option<[f64; 2]>,
}

impl Series {
    /// A quantity with its largest number of points, its name shown beside its line.
    pub fn new(group: &'static str, name: &str, colour: [u8; 3], curve: Curve) -> Self {
        Self {
            group,
            name: name.to_owned(),
            title: name.to_owned(),
            kind: SeriesKind::Quantity,
            colour,
            width: 1.3,
            is_stepped: false,
            curve,
        }
    }

    /// A limit from 0 s to `end_s`, shown with its value.
    pub fn limit(group: &'static str, name: &str, value: f64, unit: &str, end_s: f64) -> Self {
        Self {
            title: format!("{name} {}", given_quantity(value, unit)),
            kind: SeriesKind::Limit,
            width: 1.5,
            ..Self::new(group, name, colours::LIMIT, [(0.0, value), (end_s, value)].into_iter().collect())
        }
    }
}

impl PlotView {
    /// A plot with a legend whose axis follows its values.
    pub fn new(group: &'static str, title: &str, height: f32) -> Self {
        Self { group, title: title.to_owned(), height, has_legend: true, range: None }
    }

    /// Shows the part of a distance that matters, not all of it across the map: from 0 (or its lowest value, if negative) to
    /// `window`, or beyond if the lowest value is.
    pub fn zoomed(self, curve: &Curve, window: f64) -> Self {
        let (Some(lowest), Some(highest)) = (curve.min(), curve.max()) else { return self };
        self.with_range(lowest.min(0.0), highest.min(window.max(1.5 * lowest)))
    }

    /// With the range of all finite `values`.
    pub fn spanning(self, values: impl IntoIterator<Item = f64>) -> Self {
        let values: Curve = values.into_iter().map(|value| (0.0, value)).collect();
        match (values.min(), values.max()) {
            (Some(lowest), Some(highest)) => self.with_range(lowest, highest),
            _ => self,
        }
    }

    /// With the range from `lowest` to `highest` and a margin; unchanged if that is not a finite, positive length.
    pub fn with_range(self, lowest: f64, highest: f64) -> Self {
        let margin = 0.08 * (highest - lowest);
        // False for NaN too.
        let is_usable = margin > 0.0 && margin.is_finite();
        Self { range: is_usable.then_some([lowest - margin, highest + margin]), ..self }
    }
}
