//! Where everybody is when: the planned motion of the fleet on common slabs of time.

use super::super::dynamics::State;
use super::super::iterate::Iterate;
use super::super::shooting::{self, Knots, SUBSTEPS};

/// Horizontal position and velocity at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// Position, m.
    pub position_m: [f64; 2],
    /// Velocity, m/s.
    pub velocity_mps: [f64; 2],
}

/// The motion during one slab at [`SUBSTEPS`] + 1 instants, equally far apart, cubic between them.
pub type Slab = [Instant; SUBSTEPS + 1];

/// The flow of one vehicle's trajectory, restarted at every node.
#[derive(Clone, Debug)]
pub struct Track {
    /// States within every interval.
    pub intervals: Vec<Knots>,
    /// Length of an interval, s.
    pub dt_s: f64,
}

impl Track {
    /// The flow of `trajectory`.
    pub fn new(trajectory: &Iterate) -> Self {
        let flow = |k: usize| shooting::flow(&trajectory.interval(k));
        Self { intervals: (0..trajectory.intervals()).map(flow).collect(), dt_s: trajectory.dt_s }
    }

    /// The motion on slabs of `width_s`, one for every interval when the widths agree. The last slab of a vehicle that
    /// arrives in the midst of it goes on straight.
    pub fn slabs(&self, width_s: f64) -> Vec<Slab> {
        let own: Vec<Slab> = self.intervals.iter().map(|knots| knots.map(|state| instant(&state))).collect();
        if width_s == self.dt_s {
            return own;
        }
        let end_s = self.dt_s * own.len() as f64;
        let count = (end_s / width_s).ceil() as usize;
        let step_s = width_s / SUBSTEPS as f64;
        let slab =
            |slab: usize| std::array::from_fn(|m| at(&own, self.dt_s, slab as f64 * width_s + m as f64 * step_s));
        (0..count).map(slab).collect()
    }
}

/// Interval and share of it at a time.
pub fn place(t_s: f64, dt_s: f64, intervals: usize) -> (usize, f64) {
    let k = ((t_s / dt_s) as usize).min(intervals - 1);
    (k, (t_s / dt_s - k as f64).clamp(0.0, 1.0))
}

fn instant(state: &State) -> Instant {
    let [x, y, _, v, χ, γ] = (*state).into();
    let (sin, cos) = χ.sin_cos();
    let horizontal = v * γ.cos();
    Instant { position_m: [x, y], velocity_mps: [horizontal * cos, horizontal * sin] }
}

/// Position and velocity at any time; straight on beyond the end.
fn at(slabs: &[Slab], dt_s: f64, t_s: f64) -> Instant {
    let end_s = dt_s * slabs.len() as f64;
    if t_s >= end_s {
        let last = slabs[slabs.len() - 1][SUBSTEPS];
        let position_m = [0, 1].map(|axis| last.position_m[axis] + (t_s - end_s) * last.velocity_mps[axis]);
        return Instant { position_m, ..last };
    }
    let (k, share) = place(t_s, dt_s, slabs.len());
    let step = ((share * SUBSTEPS as f64) as usize).min(SUBSTEPS - 1);
    between(&slabs[k][step], &slabs[k][step + 1], share * SUBSTEPS as f64 - step as f64, dt_s / SUBSTEPS as f64)
}

/// The cubic Hermite from `a` to `b`, which are `step_s` apart, after a `share` of it.
pub fn between(a: &Instant, b: &Instant, share: f64, step_s: f64) -> Instant {
    let (u, w) = (share, 1.0 - share);
    let axis = |i: usize| {
        let (p_0, p_1) = (a.position_m[i], b.position_m[i]);
        let (v_0, v_1) = (a.velocity_mps[i] * step_s, b.velocity_mps[i] * step_s);
        let position = w * w * ((1.0 + 2.0 * u) * p_0 + u * v_0) + u * u * ((1.0 + 2.0 * w) * p_1 - w * v_1);
        let velocity = 6.0 * u * w * (p_1 - p_0) + w * (1.0 - 3.0 * u) * v_0 - u * (2.0 - 3.0 * u) * v_1;
        (position, velocity / step_s)
    };
    let ((x, vx), (y, vy)) = (axis(0), axis(1));
    Instant { position_m: [x, y], velocity_mps: [vx, vy] }
}
