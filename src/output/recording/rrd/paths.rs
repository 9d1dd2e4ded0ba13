//! Lines through space: what was planned, what was flown, and the last seconds of it.

use rerun::{LineStrips3D, RecordingStream};
use scenarios::Trajectory;
use sim::{Flight, Sample};

use super::series::end_s;
use super::world::pixels;
use super::{Logged, Run, entity, is_drawable, palette, sim_times, to_f32};
use crate::verdict::Knot;

/// Points of a planned path between two nodes.
const POINTS_PER_INTERVAL: usize = 8;
/// Time between the points of a flown path and of a trail, s.
const POINT_INTERVAL_S: f64 = 0.5;
/// The same for the path of a flight that is shorter than this, s.
const SHORT_INTERVAL_S: f64 = 0.02;
const SHORT_S: f64 = 30.0;
/// Length of a trail, s.
pub const TRAIL_S: f64 = 20.0;
/// Time between two updates of a trail, s.
const TRAIL_INTERVAL_S: f64 = 1.0;

/// PlannedMotions paths, thin and dim: a cubic through the positions and velocities of the nodes.
pub fn log_planned(stream: &RecordingStream, run: &Run<'_>) -> Logged {
    let count = run.scenario.vehicles.len();
    for (index, trajectory) in run.plan.trajectories.iter().enumerate() {
        let line = LineStrips3D::new([planned_points(trajectory)])
            .with_colors([palette::opaque(palette::dimmed(palette::vehicle(index, count)))])
            .with_radii([pixels(0.5)]);
        stream.log_static(entity("world/planned", trajectory.vehicle()), &line)?;
    }
    Ok(())
}

/// Ways that the planner tried and did not take, thinner still, with what it says of them.
pub fn log_alternatives(stream: &RecordingStream, run: &Run<'_>) -> Logged {
    for (index, way) in run.plan.diagnostics.alternatives.iter().enumerate() {
        let objective = way.objective.map(|objective| format!(", objective {objective:.2}")).unwrap_or_default();
        let points = way.path_m.iter().filter(|point| point.iter().all(|x| x.is_finite())).map(|point| to_f32(*point));
        let line = LineStrips3D::new([points.collect::<Vec<_>>()])
            .with_colors([palette::opaque(palette::MAP)])
            .with_radii([pixels(0.8)])
            .with_labels([format!("{}{objective}: not taken", way.name)])
            .with_show_labels(true);
        stream.log_static(entity("world/alternatives", &format!("{index}")), &line)?;
    }
    Ok(())
}

/// FlownMotions paths, bright, over their whole length, and the trail behind each aircraft, thick.
pub fn log_flown(stream: &RecordingStream, flight: &Flight) -> Logged {
    for (index, log) in flight.vehicles.iter().enumerate() {
        let colour = palette::opaque(palette::vehicle(index, flight.vehicles.len()));
        let interval_s = if end_s(flight) < SHORT_S { SHORT_INTERVAL_S } else { POINT_INTERVAL_S };
        let samples = spaced(&log.samples, interval_s);
        let line = LineStrips3D::new([samples.iter().map(|sample| to_f32(sample.position_m)).collect::<Vec<_>>()]);
        let line = line.with_colors([colour]).with_radii([pixels(1.2)]);
        stream.log_static(entity("world/flown", &log.vehicle), &line)?;

        if interval_s < POINT_INTERVAL_S {
            continue; // all of it is in view: a trail would only hide it
        }
        let trail = entity("world/trail", &log.vehicle);
        let style = LineStrips3D::update_fields().with_colors([colour]).with_radii([pixels(2.6)]);
        stream.log_static(trail.clone(), &style)?;
        let (times_s, strips) = trails(&samples);
        stream.send_columns(
            trail,
            [sim_times(times_s)],
            LineStrips3D::update_fields().with_strips(strips).columns_of_unit_batches()?,
        )?;
    }
    Ok(())
}

/// For every [`TRAIL_INTERVAL_S`] its time and the positions of the last [`TRAIL_S`].
fn trails(samples: &[Sample]) -> (Vec<f64>, Vec<Vec<[f32; 3]>>) {
    let step = (TRAIL_INTERVAL_S / POINT_INTERVAL_S) as usize;
    let length = (TRAIL_S / POINT_INTERVAL_S) as usize;
    let heads = (1..samples.len()).filter(|head| head.is_multiple_of(step) || head + 1 == samples.len());
    let trail =
        |head: usize| samples[head.saturating_sub(length)..=head].iter().map(|s| to_f32(s.position_m)).collect();
    heads.map(|head| (samples[head].t_s, trail(head))).unzip()
}

/// Samples at least `interval_s` apart, the first and the last among them; none that cannot be drawn.
pub fn spaced(samples: &[Sample], interval_s: f64) -> Vec<Sample> {
    let mut kept: Vec<Sample> = Vec::new();
    for sample in samples.iter().filter(|sample| is_drawable(sample)) {
        // A hundredth of slack: rounding in the times must not skip a sample.
        if kept.last().is_none_or(|last| sample.t_s - last.t_s >= 0.99 * interval_s) {
            kept.push(*sample);
        }
    }
    let last = samples.iter().rfind(|sample| is_drawable(sample));
    if let Some(last) = last.filter(|last| kept.last() != Some(last)) {
        kept.push(*last);
    }
    kept
}

fn planned_points(trajectory: &Trajectory) -> Vec<[f32; 3]> {
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
    curve.chain(end).filter(|point| point.iter().all(|x| x.is_finite())).map(to_f32).collect()
}

/// Position at share `s` in [0, 1] of an interval of `dt_s`, by the cubic with the nodes' positions and velocities:
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

    /// A turn at constant speed V and rate ω: the cubic stays within V ω³ dt⁴ / 384 of the circle.
    #[test]
    fn planned_path_follows_a_turn_between_its_nodes() {
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
