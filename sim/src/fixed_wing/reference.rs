use nalgebra::Vector3;
use scenarios::Interpolation;
use scenarios::fixed_wing::{Control, Trajectory};

use super::air_path::{AirPath, acceleration_mps2, gravity_mps2};
use super::propagate::{Knot, first_order_hold, propagate};
use super::quintic::{Jet, Quintic};

/// Maximum length of the spline's pieces, s, for an interpolation error below 1e-8 m.
const PIECE_S: f64 = 0.25;

/// A plan as a continuous motion, for a tracker to follow.
///
/// On each interval it is the solution of the nonlinear equations of motion from the interval's first node under the
/// planned controls, plus a smooth correction by the interval's defect: a quintic that begins at zero and ends, with
/// zero second derivative, at the difference (position and velocity) between the next node and the end of the solution.
/// Position and velocity are therefore continuous and interpolate every node; a consistent plan is not changed. After
/// the last node the reference continues straight with the last velocity.
#[derive(Clone, Debug)]
pub struct Reference {
    pieces: Vec<Piece>,
    /// Beginning of each piece, s: stored separately, so that a search stays in the cache.
    starts_s: Vec<f64>,
    end: Knot,
}

/// The reference at one instant, in the world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferencePoint {
    /// Position, m.
    pub position_m: Vector3<f64>,
    /// Velocity, m/s.
    pub velocity_mps: Vector3<f64>,
    /// Second derivative of the position, m/s²: includes the correction, unlike the acceleration of `control`.
    pub acceleration_mps2: Vector3<f64>,
    /// Planned load factors; after the end of the plan those of straight flight.
    pub control: Control,
}

#[derive(Clone, Debug)]
struct Piece {
    start_s: f64,
    duration_s: f64,
    motion: Quintic,
    controls: [Control; 2],
}

impl Reference {
    /// The reference of a trajectory.
    ///
    /// # Panics
    ///
    /// If the trajectory has fewer than two nodes.
    pub fn new(trajectory: &Trajectory) -> Self {
        let Interpolation::FirstOrderHold = trajectory.interpolation;
        let last = trajectory.times_s.len() - 1;
        let pieces: Vec<Piece> = (0..last).flat_map(|interval| interval_pieces(trajectory, interval)).collect();
        let starts_s = pieces.iter().map(|piece| piece.start_s).collect();
        Self { pieces, starts_s, end: Knot::new(&trajectory.states[last], trajectory.times_s[last]) }
    }

    /// Time of the last node, s.
    pub fn end_s(&self) -> f64 {
        self.end.t_s
    }

    /// The reference at `t_s`, s, which must not be before the first node.
    pub fn at(&self, t_s: f64) -> ReferencePoint {
        if t_s >= self.end.t_s {
            return self.coast(t_s);
        }
        let piece = &self.pieces[self.starts_s.partition_point(|start_s| *start_s <= t_s).max(1) - 1];
        let Jet { position_m, velocity_mps, acceleration_mps2 } = piece.motion.at(t_s - piece.start_s);
        let control = first_order_hold(piece.controls, (t_s - piece.start_s) / piece.duration_s);
        ReferencePoint { position_m, velocity_mps, acceleration_mps2, control }
    }

    fn coast(&self, t_s: f64) -> ReferencePoint {
        let velocity_mps = self.end.velocity_mps;
        ReferencePoint {
            position_m: self.end.position_m + velocity_mps * (t_s - self.end.t_s),
            velocity_mps,
            acceleration_mps2: Vector3::zeros(),
            control: AirPath::new(&velocity_mps).load_factors(&-gravity_mps2()),
        }
    }
}

/// The spline of the interval from node `interval` to the next.
fn interval_pieces(trajectory: &Trajectory, interval: usize) -> Vec<Piece> {
    let (start_s, end_s) = (trajectory.times_s[interval], trajectory.times_s[interval + 1]);
    let controls = [trajectory.controls[interval], trajectory.controls[interval + 1]];
    let duration_s = end_s - start_s;
    let knots = propagate(&trajectory.states[interval], controls, start_s, duration_s, PIECE_S);
    let next = Knot::new(&trajectory.states[interval + 1], end_s);
    let correction = defect_correction(&knots[knots.len() - 1], &next, duration_s);
    let control_at = |t_s: f64| first_order_hold(controls, (t_s - start_s) / duration_s);
    let jet = |knot: &Knot| {
        let acceleration_mps2 = acceleration_mps2(&knot.velocity_mps, control_at(knot.t_s));
        let solution = Jet { position_m: knot.position_m, velocity_mps: knot.velocity_mps, acceleration_mps2 };
        solution + correction.at(knot.t_s - start_s)
    };
    let piece = |ends: &[Knot]| Piece {
        start_s: ends[0].t_s,
        duration_s: ends[1].t_s - ends[0].t_s,
        motion: Quintic::between(&jet(&ends[0]), &jet(&ends[1]), ends[1].t_s - ends[0].t_s),
        controls: [control_at(ends[0].t_s), control_at(ends[1].t_s)],
    };
    knots.windows(2).map(piece).collect()
}

/// From zero at the beginning of an interval to its defect at the end.
fn defect_correction(propagated: &Knot, planned: &Knot, duration_s: f64) -> Quintic {
    let defect = Jet {
        position_m: planned.position_m - propagated.position_m,
        velocity_mps: planned.velocity_mps - propagated.velocity_mps,
        acceleration_mps2: Vector3::zeros(),
    };
    Quintic::between(&Jet::ZERO, &defect, duration_s)
}
