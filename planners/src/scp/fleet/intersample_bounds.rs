//! State bounds between the nodes.
//!
//! The bounds of a subproblem hold at the nodes. Between two nodes a state may overshoot (a speed that rises and falls
//! within an interval). The bounds of both nodes are tightened by the overshoot of the last trajectory. Start and goal
//! cannot move: there the controls are bounded instead, so that a state at its limit does not move beyond it.

use scenarios::Range;
use scenarios::fixed_wing::GRAVITY_MPS2;

use super::super::dynamics::State;
use super::super::iterate::Iterate;
use super::super::shooting::SUBSTEPS;
use super::motion::VehicleMotion;
use crate::convex::STAGE_LEN;

/// Margin on the last overshoot, as a fraction of it: the next overshoot will differ.
const OVERSHOOT_MARGIN: f64 = 0.3;

/// Fraction of a tightening that remains after an iteration without an overshoot.
const MEMORY: f64 = 0.7;

/// Number of states.
const STATE_LEN: usize = 6;

/// Distance that the nodes keep from every limit, as a fraction of its range: more than the solver's rounding.
const LIMIT_MARGIN: f64 = 2e-5;

/// Indices of the states that have bounds: all but the heading.
pub const BOUNDED_STATES: [usize; 5] = [0, 1, 2, 3, 5];

/// Indices of speed and flight-path angle, and of the load factors that change them.
const SPEED: usize = 3;
const CLIMB: usize = 5;
const N_X: usize = 6;
const N_Z: usize = 8;

/// Distances by which the bounds of every node are tightened, lower and upper, per state.
#[derive(Clone, Debug)]
pub struct Tightening {
    nodes: Vec<[[f64; 2]; STATE_LEN]>,
}

impl Tightening {
    /// None, for a trajectory of `nodes` nodes.
    pub fn new(nodes: usize) -> Self {
        Self { nodes: vec![[[0.0; 2]; STATE_LEN]; nodes] }
    }

    /// Follows the overshoot of the last trajectory: at once where it has grown, gradually where it has fallen, since an
    /// overshoot that is gone returns when its bound is released.
    pub fn observe(&mut self, motion: &VehicleMotion) {
        self.nodes.as_flattened_mut().as_flattened_mut().iter_mut().for_each(|distance| *distance *= MEMORY);
        for k in 0..motion.intervals.len() {
            for i in BOUNDED_STATES {
                let overshoot = overshoot(motion, k, i);
                for node in &mut self.nodes[k..=k + 1] {
                    for (distance, overshoot) in node[i].iter_mut().zip(overshoot) {
                        *distance = distance.max((1.0 + OVERSHOOT_MARGIN) * overshoot);
                    }
                }
            }
        }
    }

    /// The bounds of every node of a subproblem about `trajectory`.
    ///
    /// - `goes_on`: whether the vehicle flies on after its arrival
    pub fn applied_to(
        &self,
        bounds: &[Range; STAGE_LEN],
        trajectory: &Iterate,
        goes_on: bool,
    ) -> Vec<[Range; STAGE_LEN]> {
        let inner = bounds.map(|range| inside(range, LIMIT_MARGIN * range.width()));
        let mut tightened = vec![inner; self.nodes.len()];
        for (node, distances) in tightened.iter_mut().zip(&self.nodes) {
            for i in BOUNDED_STATES {
                let [below, above] = distances[i];
                node[i] = Range::new(inner[i].min + below, inner[i].max - above);
            }
        }
        let last = tightened.len() - 1;
        for (node, side) in [(0, 1.0), (last, -1.0)] {
            release_states(&mut tightened[node]);
            let ramp_s = trajectory.dt_s * if node == 0 { trajectory.ramp } else { 1.0 };
            bound_controls(&mut tightened[node], &inner, &trajectory.states[node], side * ramp_s);
        }
        if goes_on {
            bound_controls(&mut tightened[last], &inner, &trajectory.states[last], trajectory.dt_s * trajectory.ramp);
        }
        tightened
    }
}

/// The range without a margin at both ends; unbounded ranges and those without an inside stay as they are.
fn inside(range: Range, margin: f64) -> Range {
    if margin.is_finite() { Range::new(range.min + margin, range.max - margin) } else { range }
}

/// Removes the bounds of the states: those of start and goal are given.
fn release_states(node: &mut [Range; STAGE_LEN]) {
    for i in BOUNDED_STATES {
        node[i] = Range::new(f64::MIN, f64::MAX);
    }
}

/// Bounds the load factors at the start, or at the goal, where time runs backwards (`ramp_s` < 0), so that speed and
/// flight-path angle stay within their limits while the load factor falls to zero effect over `ramp_s`:
///
/// ```text
/// V + g (n_x - sin γ) ramp/2 <= V_max        γ + g (n_z - cos γ)/V ramp/2 <= γ_max
/// ```
fn bound_controls(node: &mut [Range; STAGE_LEN], limits: &[Range; STAGE_LEN], state: &State, ramp_s: f64) {
    let (v, γ) = (state[SPEED], state[CLIMB]);
    let half_s = 0.5 * ramp_s;
    let rows = [
        (N_X, γ.sin(), limits[SPEED], v, GRAVITY_MPS2 * half_s),
        (N_Z, γ.cos(), limits[CLIMB], γ, GRAVITY_MPS2 / v * half_s),
    ];
    for (control, neutral, limit, value, gain) in rows {
        let ends = [limit.min, limit.max].map(|end| neutral + (end - value) / gain);
        let own = node[control];
        let min = ends[0].min(ends[1]).max(own.min);
        let max = ends[0].max(ends[1]).min(own.max);
        if min < max {
            node[control] = Range::new(min, max);
        }
    }
}

/// Distances by which a component falls below and rises above its values at the ends of interval `k`.
fn overshoot(motion: &VehicleMotion, k: usize, component: usize) -> [f64; 2] {
    let knots = &motion.intervals[k];
    let (begin, end) = (knots[0][component], knots[SUBSTEPS][component]);
    let extremes = motion.extremes(k, component);
    [begin.min(end) - extremes.min, extremes.max - begin.max(end)]
}

#[cfg(test)]
mod tests {
    use super::super::super::dynamics::Control;
    use super::*;

    /// Four intervals of 5 s with a constant speed, but for a rise by 0.5 m/s in the middle of the second one.
    fn motion(rise_mps: f64) -> VehicleMotion {
        let state = |speed: f64| State::new(0.0, 0.0, 400.0, speed, 0.0, 0.0);
        let u = |m: usize| m as f64 / SUBSTEPS as f64;
        let rising = std::array::from_fn(|m| state(38.0 + 4.0 * rise_mps * u(m) * (1.0 - u(m))));
        let rates = std::array::from_fn(|m| {
            State::from_fn(|i, _| if i == 3 { 4.0 * rise_mps / 5.0 * (1.0 - 2.0 * u(m)) } else { 0.0 })
        });
        let (constant, none) = ([state(38.0); SUBSTEPS + 1], [State::zeros(); SUBSTEPS + 1]);
        VehicleMotion {
            intervals: vec![constant, rising, constant, constant],
            rates: vec![none, rates, none, none],
            dt_s: 5.0,
        }
    }

    #[test]
    fn bounds_are_tightened_by_the_overshoot() {
        let bounds = [Range::new(-1000.0, 1000.0); STAGE_LEN];
        let trajectory = Iterate {
            states: vec![State::new(0.0, 0.0, 400.0, 38.0, 0.0, 0.0); 5],
            controls: vec![Control::new(0.0, 0.0, 1.0); 5],
            dt_s: 5.0,
            ramp: 0.25,
        };
        let mut tightening = Tightening::new(5);
        tightening.observe(&motion(0.5));
        let tightened = tightening.applied_to(&bounds, &trajectory, false);
        let margin = LIMIT_MARGIN * 2000.0;
        let moved = |node: usize| 1000.0 - margin - tightened[node][3].max;
        assert_eq!(moved(3), 0.0);
        assert!((moved(1) - 1.3 * 0.5).abs() < 1e-9 && moved(1) == moved(2), "{}", moved(1));
        assert!(tightened[1..4].iter().all(|node| node[3].min == margin - 1000.0));
        assert!([0, 4].iter().all(|end| tightened[*end][3].max == f64::MAX), "start and goal are given");
        tightening.observe(&motion(0.0));
        assert!((tightening.nodes[1][SPEED][1] - MEMORY * moved(1)).abs() < 1e-9, "released gradually");
    }

    #[test]
    fn a_speed_at_its_limit_does_not_rise_after_the_start() {
        let mut limits = [Range::new(-0.2, 0.2); STAGE_LEN];
        (limits[SPEED], limits[CLIMB], limits[N_Z]) =
            (Range::new(30.0, 40.0), Range::new(-0.1, 0.1), Range::new(0.8, 1.2));
        let at_start = |speed: f64, ramp_s: f64| {
            let mut node = limits;
            bound_controls(&mut node, &limits, &State::new(0.0, 0.0, 400.0, speed, 0.0, 0.0), ramp_s);
            node[N_X]
        };
        assert_eq!(at_start(35.0, 1.25), limits[N_X]);
        assert_eq!(at_start(40.0, 1.25), Range::new(-0.2, 0.0));
        assert_eq!(at_start(30.0, 1.25), Range::new(0.0, 0.2));
        // at the goal time runs backwards
        assert_eq!(at_start(40.0, -1.25), Range::new(0.0, 0.2));
    }
}
