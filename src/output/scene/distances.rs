//! Smallest distances of the fleet over time, of the flight as the judge sees it.

use scenarios::Scenario;

use super::{Curve, PlotView, Scene, Series, colours, requirements};
use crate::metrics::over_time::{DistanceSample, separation_over_time};
use crate::output::run::JudgedRun;
use crate::verdict::{FlownMotions, Motion, is_flyable};

/// Time between two points, s.
const STEP_S: f64 = 0.02;
/// Largest number of points of a curve.
const MAX_POINTS: usize = 4000;

/// Adds separation and clearance of the fleet with their limits, and the robustness of requirements. Returns the distances.
///
/// - `clearance_over_time`: smallest clearance of any of the motions, at steps of the given length, s
pub(super) fn add(
    scene: &mut Scene<'_>,
    run: &JudgedRun<'_>,
    clearance_over_time: fn(&Scenario, &[Motion], f64) -> Vec<DistanceSample>,
) -> Distances {
    let Some(flown) = judged_motions(run) else { return Distances::default() };
    let distances = Distances::new(run, &flown.motions, clearance_over_time);
    if let Some(flight) = run.flight {
        requirements::add(scene, run, &flown.motions, flight);
    }
    let end_s = scene.end_s;
    let fleet = |group, title: &str, curve: &Curve| Series {
        title: title.to_owned(),
        width: 1.8,
        ..Series::new(group, "fleet", colours::FLEET, curve.clone().decimated(MAX_POINTS))
    };
    if let (Some(curve), Some(rule)) = (&distances.separation, run.scenario.separation()) {
        scene.series.push(fleet("separation_m", "smallest separation", curve));
        scene.series.push(Series::limit("separation_m", "limit", rule.limit_m, "m", end_s));
    }
    if let Some(curve) = &distances.clearance {
        scene.series.push(fleet("clearance_m", "smallest clearance", curve));
        scene.series.push(Series::limit("clearance_m", "surface", 0.0, "m", end_s));
    }
    distances
}

/// The flight while it is judged, if it can be.
fn judged_motions<'a>(run: &JudgedRun<'a>) -> Option<FlownMotions<'a>> {
    let flight = run.flight.filter(|_| is_flyable(run.scenario, run.plan).is_ok())?;
    FlownMotions::new(run.scenario, run.plan, flight).ok()
}

/// Smallest separation and clearance of the fleet over time, m. `None`: not limited, or not defined for this flight.
#[derive(Clone, Debug, Default)]
pub(super) struct Distances {
    /// Distance between the two vehicles that are closest, as the separation measures it.
    pub separation: Option<Curve>,
    /// Distance from an obstacle's surface to the vehicle that is closest; negative inside.
    pub clearance: Option<Curve>,
}

impl Distances {
    fn new(
        run: &JudgedRun<'_>,
        motions: &[Motion],
        clearance_over_time: fn(&Scenario, &[Motion], f64) -> Vec<DistanceSample>,
    ) -> Self {
        let rule = run.scenario.separation();
        let separation = rule.map_or_else(Vec::new, |rule| separation_over_time(motions, rule.measure, STEP_S));
        let clearance = clearance_over_time(run.scenario, motions, STEP_S);
        Self {
            separation: with_worst(run, "flight.separation", &separation),
            clearance: with_worst(run, "flight.clearance", &clearance),
        }
    }
}

/// The plot of the fleet's separation, if it has a rule.
pub(super) fn separation_plot(scenario: &Scenario, distances: &Distances) -> Option<PlotView> {
    let (curve, rule) = (distances.separation.as_ref()?, scenario.separation()?);
    let title = format!("Smallest separation of the fleet, {} [m]", rule.measure.describe());
    Some(PlotView::new("separation_m", &title, 1.0).zoomed(curve, 4.0 * rule.limit_m))
}

/// The curve through `series` and through the worst instant of the check, which lies between two points of the series: the
/// plot must not look better than the verdict.
fn with_worst(run: &JudgedRun<'_>, check: &str, series: &[DistanceSample]) -> Option<Curve> {
    let check = run.verdict.checks.iter().find(|candidate| candidate.name == check);
    let worst = check.and_then(|check| Some((check.at_s?, check.value?)));
    let mut points: Vec<(f64, f64)> = series.iter().map(|nearest| (nearest.t_s, nearest.distance_m)).collect();
    if points.is_empty() {
        return None;
    }
    points.extend(worst);
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(points.into_iter().collect())
}
