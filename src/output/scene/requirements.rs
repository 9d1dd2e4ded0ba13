//! The robustness of requirements over time.

use sim::Flight;

use super::{PlotView, Scene, Series, Tab, colours};
use crate::output::run::JudgedRun;
use crate::verdict::{Motion, robustness_over_time};

/// The plot of all requirements.
const GROUP: &str = "requirements";

/// Adds a curve for each requirement, and the limit 0.
///
/// - `motions`: of the vehicles, in the order of the scenario, and of the load after them
pub(super) fn add(scene: &mut Scene<'_>, run: &JudgedRun<'_>, motions: &[Motion], flight: &Flight) {
    let curves = robustness_over_time(run.scenario, motions, flight);
    if curves.is_empty() {
        return;
    }
    let count = curves.len();
    for (index, curve) in curves.into_iter().enumerate() {
        let title = format!("{} [{}]", curve.name, curve.unit);
        let points = curve.points.into_iter().collect();
        let colour = colours::vehicle(index, count);
        let own = Series { title, is_stepped: true, ..Series::new(GROUP, &curve.name, colour, points) };
        scene.series.push(own);
    }
    scene.series.push(Series::limit(GROUP, "kept above", 0.0, "", scene.end_s));
    let plot = PlotView::new(GROUP, "Robustness of the requirements: negative where one is broken", 1.0);
    scene.tabs.push(Tab { name: "Requirements", plots: vec![plot] });
}
