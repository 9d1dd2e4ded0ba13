//! The trajectory of one vehicle between two iterations.

use scenarios::Transcription;

use super::dynamics::{Control, State};
use super::interval::Interval;
use super::transcription;

/// States and controls at K + 1 nodes, dt seconds apart.
#[derive(Clone, Debug)]
pub struct Iterate {
    /// States at the nodes.
    pub states: Vec<State>,
    /// Controls at the nodes.
    pub controls: Vec<Control>,
    /// Step length dt, s.
    pub dt_s: f64,
    /// Interpolation of the controls between the nodes, see [`Interval::ramp`].
    pub ramp: f64,
}

impl Iterate {
    /// Number K of intervals.
    pub fn intervals(&self) -> usize {
        self.states.len() - 1
    }

    /// Flight time κ = K dt, s.
    pub fn flight_time_s(&self) -> f64 {
        self.intervals() as f64 * self.dt_s
    }

    /// The interval from node k to node k + 1.
    pub fn interval(&self, k: usize) -> Interval {
        Interval {
            states: [self.states[k], self.states[k + 1]],
            controls: [self.controls[k], self.controls[k + 1]],
            dt_s: self.dt_s,
            ramp: self.ramp,
        }
    }

    /// Horizontal position at node k, m.
    pub fn position_m(&self, k: usize) -> [f64; 2] {
        [self.states[k][0], self.states[k][1]]
    }

    /// Largest position defect of any interval by the planner's own transcription, m.
    pub fn defect_m(&self, transcription: Transcription) -> f64 {
        (0..self.intervals())
            .map(|k| transcription::defect(transcription, &self.interval(k)).fixed_rows::<3>(0).norm())
            .fold(0.0, f64::max)
    }

    /// Largest change of each state component since `last`.
    pub fn change(&self, last: &Iterate) -> State {
        let pairs = self.states.iter().zip(&last.states);
        pairs.fold(State::zeros(), |largest, (now, before)| largest.sup(&(now - before).abs()))
    }
}

/// Largest step length of a fleet, s; 0 for an empty fleet.
pub fn max_dt_s(trajectories: &[Iterate]) -> f64 {
    trajectories.iter().map(|trajectory| trajectory.dt_s).fold(0.0, f64::max)
}

/// Flight time of the slowest vehicle, s; 0 for an empty fleet.
pub fn max_flight_time_s(trajectories: &[Iterate]) -> f64 {
    trajectories.iter().map(Iterate::flight_time_s).fold(0.0, f64::max)
}
