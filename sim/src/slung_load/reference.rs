use nalgebra::{UnitQuaternion, Vector3, Vector4};
use scenarios::Interpolation;
use scenarios::slung_load::{Cable, Trajectory};

use super::dynamics::Plant;
use super::propagate::{Knot, propagate};
use super::state::SlungLoadState;

/// Maximum distance between the points of the reference, s, for an interpolation error below 1e-6 m.
const PIECE_S: f64 = 0.005;

/// A plan as a continuous motion, for a tracker to follow.
///
/// On each interval it is the solution of the nonlinear equations of motion from the interval's first node under the
/// planned thrusts, plus a smooth correction by the interval's defect, so that it interpolates every node. At an impact
/// it is discontinuous, as the plan is. After the last node it hovers there.
#[derive(Clone, Debug)]
pub struct Reference {
    plant: Plant,
    points: Vec<ReferencePoint>,
}

/// The reference at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferencePoint {
    /// Time, s.
    pub t_s: f64,
    /// State.
    pub state: SlungLoadState,
    /// Planned thrusts, N.
    pub thrust_n: Vector4<f64>,
    /// State of the cable from here on.
    pub cable: Cable,
}

impl Reference {
    /// The reference of a trajectory with at least two nodes, for the nominal plant.
    pub fn new(trajectory: &Trajectory, plant: &Plant) -> Self {
        let last = trajectory.times_s.len() - 1;
        let points = (0..last).flat_map(|interval| interval_points(trajectory, plant, interval)).collect();
        Self { plant: *plant, points }
    }

    /// Time of the last node, s.
    pub fn end_s(&self) -> f64 {
        self.points[self.points.len() - 1].t_s
    }

    /// Its points in the order of time. At a node two of them have the same time; the second one is the limit from the
    /// right.
    pub fn points(&self) -> &[ReferencePoint] {
        &self.points
    }

    /// The reference at `t_s`, s, which must not be before the first node. At a discontinuity, the limit from the
    /// right.
    pub fn at(&self, t_s: f64) -> ReferencePoint {
        let after = self.points.partition_point(|point| point.t_s <= t_s);
        match self.points.get(after) {
            None => self.hover(t_s),
            Some(next) => between(&self.points[after.max(1) - 1], next, t_s),
        }
    }

    /// Hover at the end of the plan.
    fn hover(&self, t_s: f64) -> ReferencePoint {
        let end = &self.points[self.points.len() - 1];
        let yaw = end.state.attitude.euler_angles().2;
        let carried_kg = if end.cable == Cable::Taut { self.plant.load_mass_kg } else { 0.0 };
        let thrust_n = (self.plant.mass_kg + carried_kg) * scenarios::slung_load::GRAVITY_MPS2 / 4.0;
        let load_position_m = match end.cable {
            Cable::Taut => end.state.position_m - Vector3::z() * self.plant.cable_length_m,
            Cable::Slack => end.state.load_position_m,
        };
        let state = SlungLoadState {
            velocity_mps: Vector3::zeros(),
            attitude: UnitQuaternion::from_euler_angles(0.0, 0.0, yaw),
            body_rate_radps: Vector3::zeros(),
            load_position_m,
            load_velocity_mps: Vector3::zeros(),
            ..end.state
        };
        ReferencePoint { t_s, state, thrust_n: Vector4::repeat(thrust_n), cable: end.cable }
    }
}

/// The corrected solution of an interval, which ends at the next node; empty for an interval of zero length.
fn interval_points(trajectory: &Trajectory, plant: &Plant, interval: usize) -> Vec<ReferencePoint> {
    let Interpolation::FirstOrderHold = trajectory.interpolation;
    let times_s = [trajectory.times_s[interval], trajectory.times_s[interval + 1]];
    if times_s[0] >= times_s[1] {
        return Vec::new();
    }
    let controls = [&trajectory.controls[interval], &trajectory.controls[interval + 1]];
    let cable = trajectory.cable[interval];
    let start = SlungLoadState::from(&trajectory.states[interval]);
    let knots = propagate(plant, &start, controls, cable, times_s, PIECE_S);
    let defect =
        Defect::between(&knots[knots.len() - 1].state, &SlungLoadState::from(&trajectory.states[interval + 1]));
    let point = |knot: &Knot| {
        let fraction = (knot.t_s - times_s[0]) / (times_s[1] - times_s[0]);
        let state = defect.corrected(&knot.state, fraction);
        ReferencePoint { t_s: knot.t_s, state, thrust_n: knot.thrust_n, cable }
    };
    knots.iter().map(point).collect()
}

/// Difference between the end of an interval's solution and the next node.
struct Defect {
    position_m: Vector3<f64>,
    velocity_mps: Vector3<f64>,
    /// Rotation vector in body axes, rad.
    rotation: Vector3<f64>,
    body_rate_radps: Vector3<f64>,
    load_position_m: Vector3<f64>,
    load_velocity_mps: Vector3<f64>,
}

impl Defect {
    fn between(solution: &SlungLoadState, planned: &SlungLoadState) -> Self {
        Self {
            position_m: planned.position_m - solution.position_m,
            velocity_mps: planned.velocity_mps - solution.velocity_mps,
            rotation: (solution.attitude.inverse() * planned.attitude).scaled_axis(),
            body_rate_radps: planned.body_rate_radps - solution.body_rate_radps,
            load_position_m: planned.load_position_m - solution.load_position_m,
            load_velocity_mps: planned.load_velocity_mps - solution.load_velocity_mps,
        }
    }

    /// A state corrected by s²(3 - 2s) of the defect, s the fraction of the interval, in [0, 1].
    fn corrected(&self, state: &SlungLoadState, fraction: f64) -> SlungLoadState {
        let weight = fraction * fraction * (3.0 - 2.0 * fraction);
        SlungLoadState {
            position_m: state.position_m + self.position_m * weight,
            velocity_mps: state.velocity_mps + self.velocity_mps * weight,
            attitude: state.attitude * UnitQuaternion::from_scaled_axis(self.rotation * weight),
            body_rate_radps: state.body_rate_radps + self.body_rate_radps * weight,
            load_position_m: state.load_position_m + self.load_position_m * weight,
            load_velocity_mps: state.load_velocity_mps + self.load_velocity_mps * weight,
        }
    }
}

/// Interpolates positions by the cubic with the velocities at the ends, everything else linearly.
fn between(from: &ReferencePoint, to: &ReferencePoint, t_s: f64) -> ReferencePoint {
    let duration_s = to.t_s - from.t_s;
    if duration_s <= 0.0 {
        return *to;
    }
    let s = (t_s - from.t_s) / duration_s;
    let linear = |a: &Vector3<f64>, b: &Vector3<f64>| a + (b - a) * s;
    let cubic = |p0: &Vector3<f64>, v0: &Vector3<f64>, p1: &Vector3<f64>, v1: &Vector3<f64>| {
        let (s2, s3) = (s * s, s * s * s);
        p0 * (2.0 * s3 - 3.0 * s2 + 1.0)
            + v0 * ((s3 - 2.0 * s2 + s) * duration_s)
            + p1 * (3.0 * s2 - 2.0 * s3)
            + v1 * ((s3 - s2) * duration_s)
    };
    let (a, b) = (&from.state, &to.state);
    let state = SlungLoadState {
        position_m: cubic(&a.position_m, &a.velocity_mps, &b.position_m, &b.velocity_mps),
        velocity_mps: linear(&a.velocity_mps, &b.velocity_mps),
        attitude: a.attitude.nlerp(&b.attitude, s),
        body_rate_radps: linear(&a.body_rate_radps, &b.body_rate_radps),
        load_position_m: cubic(&a.load_position_m, &a.load_velocity_mps, &b.load_position_m, &b.load_velocity_mps),
        load_velocity_mps: linear(&a.load_velocity_mps, &b.load_velocity_mps),
    };
    let thrust_n = from.thrust_n + (to.thrust_n - from.thrust_n) * s;
    ReferencePoint { t_s, state, thrust_n, cable: from.cable }
}
