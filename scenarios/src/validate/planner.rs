//! The options of a planner, as far as they can be judged without knowing it.

use super::quantity::{above_up_to, not_negative, positive, positive_if_given};
use crate::{Convergence, PlannerSettings, Problem, TrustRegion};

/// Fewest and most intervals between the nodes.
const INTERVALS: std::ops::RangeInclusive<usize> = 2..=1000;

pub(super) fn problems(settings: &PlannerSettings) -> Vec<Problem> {
    let mut problems = Vec::new();
    if let Some(intervals) = settings.intervals.filter(|intervals| !INTERVALS.contains(intervals)) {
        let expected = format!("a whole number from {} to {}", INTERVALS.start(), INTERVALS.end());
        problems.push(Problem::new("planner.intervals", intervals.to_string(), expected));
    }
    if settings.max_iterations == Some(0) {
        problems.push(Problem::new("planner.max_iterations", "0", "1 or more"));
    }
    problems.extend(settings.margin_m.and_then(|margin_m| not_negative("planner.margin_m", margin_m)));
    problems.extend(positive_if_given("planner.penalty", settings.penalty));
    problems.extend(settings.time_bound_release.and_then(time_bound_release));
    problems.extend(settings.trust_region.iter().flat_map(trust_region));
    problems.extend(settings.convergence.iter().flat_map(convergence));
    problems
}

fn time_bound_release(share: f64) -> Option<Problem> {
    let expected = "a share from 0 to below 1";
    (!(0.0..1.0).contains(&share) && share.is_finite())
        .then(|| Problem::new("planner.time_bound_release", share.to_string(), expected))
}

fn trust_region(region: &TrustRegion) -> Vec<Problem> {
    let half_widths = [
        positive("planner.trust_region.position_m", region.position_m),
        positive("planner.trust_region.altitude_m", region.altitude_m),
        positive("planner.trust_region.speed_mps", region.speed_mps),
        positive("planner.trust_region.heading_deg", region.heading_deg),
        positive("planner.trust_region.flight_path_deg", region.flight_path_deg),
    ];
    let shrink = above_up_to("planner.trust_region.shrink", region.shrink, 0.0, 1.0);
    half_widths.into_iter().flatten().chain(shrink).collect()
}

fn convergence(tolerances: &Convergence) -> Vec<Problem> {
    let problems = [
        positive("planner.convergence.position_m", tolerances.position_m),
        positive("planner.convergence.altitude_m", tolerances.altitude_m),
        positive("planner.convergence.speed_mps", tolerances.speed_mps),
        positive("planner.convergence.heading_deg", tolerances.heading_deg),
        positive("planner.convergence.flight_path_deg", tolerances.flight_path_deg),
    ];
    problems.into_iter().flatten().collect()
}
