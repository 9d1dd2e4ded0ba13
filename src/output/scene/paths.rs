//! Paths in space: planned, discarded alternatives, flown, and the trail behind each vehicle.

use scenarios::Trajectory;
use sim::{Flight, Sample};

use super::body::spaced;
use super::{Animation, Lines, Paint, Scene, colours, is_finite, item_path};
use crate::output::run::JudgedRun;
use crate::verdict::Knot;

/// Points of a planned path between two nodes.
const POINTS_PER_INTERVAL: usize = 8;
/// Time between the points of a trail, and largest time between those of a flown path, s.
const POINT_INTERVAL_S: f64 = 0.5;
/// Smallest time between the points of a flown path, s.
const SHORT_INTERVAL_S: f64 = 0.02;
/// Points of a flown path between these two intervals.
const POINTS_OF_PATH: f64 = 1000.0;
/// Flights shorter than this have no trail, s.
const SHORT_FLIGHT_S: f64 = 30.0;
/// Length of a trail, s.
pub const TRAIL_S: f64 = 20.0;
/// Time between two updates of a trail, s.
const TRAIL_INTERVAL_S: f64 = 1.0;

/// Adds the planned paths (the cubic through positions and velocities of the nodes) and the alternatives that the planner
/// discarded.
pub(super) fn add_planned(scene: &mut Scene<'_>, run: &JudgedRun<'_>) {
    let count = run.scenario.vehicles.len();
    for (index, trajectory) in run.plan.trajectories.iter().enumerate() {
        let paint = Paint::opaque(colours::dimmed(colours::vehicle(index, count)));
        let line = Lines::new(vec![planned_points_m(trajectory)], paint, 0.5);
        scene.add_item(&["planned", trajectory.vehicle()], line);
    }
    for (index, alternative) in run.plan.diagnostics.alternatives.iter().enumerate() {
        let objective =
            alternative.objective.map(|objective| format!(", objective {objective:.2}")).unwrap_or_default();
        let points = alternative.path_m.iter().filter(|point| is_finite(point)).copied().collect();
        let line = Lines::new(vec![points], Paint::opaque(colours::MAP), 0.8)
            .labelled(format!("{}{objective}: not taken", alternative.name), true);
        scene.add_item(&["alternatives", &index.to_string()], line);
    }
}

/// Adds the whole flown paths and the moving trails.
pub(super) fn add_flown(scene: &mut Scene<'_>, flight: &Flight) {
    let is_short = scene.end_s < SHORT_FLIGHT_S;
    for (index, log) in flight.vehicles.iter().enumerate() {
        let paint = Paint::opaque(colours::vehicle(index, flight.vehicles.len()));
        let interval_s = (scene.end_s / POINTS_OF_PATH).clamp(SHORT_INTERVAL_S, POINT_INTERVAL_S);
        let points = spaced(&log.samples, interval_s).iter().map(|sample| sample.position_m).collect();
        scene.add_item(&["flown", &log.vehicle], Lines::new(vec![points], paint, 1.2));
        if !is_short {
            let (times_s, strips) = trails(&spaced(&log.samples, POINT_INTERVAL_S));
            let path = item_path(&["trail", &log.vehicle]);
            scene.animations.push(Animation { path, times_s, strips, paints: vec![paint], radius: 2.6 });
        }
    }
}

/// Every [`TRAIL_INTERVAL_S`], the time and the positions of the last [`TRAIL_S`].
fn trails(samples: &[Sample]) -> (Vec<f64>, Vec<Vec<[f64; 3]>>) {
    let step = (TRAIL_INTERVAL_S / POINT_INTERVAL_S) as usize;
    let length = (TRAIL_S / POINT_INTERVAL_S) as usize;
    let heads = (1..samples.len()).filter(|head| head.is_multiple_of(step) || head + 1 == samples.len());
    let trail = |head: usize| samples[head.saturating_sub(length)..=head].iter().map(|s| s.position_m).collect();
    heads.map(|head| (samples[head].t_s, trail(head))).unzip()
}

fn planned_points_m(trajectory: &Trajectory) -> Vec<[f64; 3]> {
    let node = |node: usize| Knot {
        t_s: trajectory.times_s()[node],
        position_m: trajectory.nodes().position_m(node),
        velocity_mps: trajectory.nodes().velocity_mps(node),
    };
    let nodes: Vec<Knot> = (0..trajectory.node_count()).map(node).collect();
    let curve = nodes.windows(2).flat_map(|pair| {
        let (from, to) = (pair[0], pair[1]);
        (0..POINTS_PER_INTERVAL).map(move |i| hermite(&from, &to, i as f64 / POINTS_PER_INTERVAL as f64))
    });
    let end = nodes.last().map(|node| node.position_m);
    curve.chain(end).filter(is_finite).collect()
}

/// Position at the fraction `s` in [0, 1] of an interval of `dt_s`, on the cubic with the nodes' positions and velocities:
///
/// ```text
/// p(s) = (2s³ - 3s² + 1) p0 + (s³ - 2s² + s) dt v0 + (3s² - 2s³) p1 + (s³ - s²) dt v1
/// ```
fn hermite(from: &Knot, to: &Knot, s: f64) -> [f64; 3] {
    let dt_s = to.t_s - from.t_s;
    let (s2, s3) = (s * s, s * s * s);
    let (p0, v0, p1, v1) = (from.position_m, from.velocity_mps, to.position_m, to.velocity_mps);
    std::array::from_fn(|i| {
        (2.0 * s3 - 3.0 * s2 + 1.0) * p0[i]
            + (s3 - 2.0 * s2 + s) * dt_s * v0[i]
            + (3.0 * s2 - 2.0 * s3) * p1[i]
            + (s3 - s2) * dt_s * v1[i]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In a turn at constant speed V and rate ω the cubic deviates from the circle by V ω³ dt⁴ / 384 at most.
    #[test]
    fn the_planned_path_follows_a_turn_between_its_nodes() {
        let (speed_mps, rate_radps, dt_s) = (35.0, 0.05, 5.0);
        let radius_m = speed_mps / rate_radps;
        let at = |t_s: f64| {
            let (sin, cos) = (rate_radps * t_s).sin_cos();
            let position_m = [radius_m * sin, -radius_m * cos, 400.0];
            Knot { t_s, position_m, velocity_mps: [speed_mps * cos, speed_mps * sin, 0.0] }
        };
        for i in 0..=10 {
            let s = f64::from(i) / 10.0;
            let (cubic, truth) = (hermite(&at(0.0), &at(dt_s), s), at(s * dt_s).position_m);
            let error_m = (cubic[0] - truth[0]).hypot(cubic[1] - truth[1]);
            assert!(error_m < speed_mps * rate_radps.powi(3) * dt_s.powi(4) / 384.0 * 1.1, "{error_m} m at {s}");
        }
    }
}
