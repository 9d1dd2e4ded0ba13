//! The common lower bound of all step lengths, which makes a fleet arrive together (Wang, Xu, Long 2020, eq. 10).

use super::iterate::{Iterate, max_dt_s, max_flight_time_s};

/// Relative distance within which a step length is at the bound.
const AT_BOUND_TOLERANCE: f64 = 1e-6;

/// dt_lb of the next iteration.
///
/// As printed, the bound dt_i >= max_j dtbar_j can never fall, so one bad early iterate slows down the fleet for good.
/// With a release fraction r > 0, which is not in the paper, the bound falls by r whenever all step lengths are at the
/// bound. If a step length then stays above the lowered bound, that vehicle cannot fly faster, and r is halved.
#[derive(Clone, Debug)]
pub struct TimeBound {
    release: f64,
    bound_s: f64,
    released: bool,
}

impl TimeBound {
    /// The bound before the first iteration, 0. `release` is r, in [0, 1).
    pub fn new(release: f64) -> Self {
        Self { release, bound_s: 0.0, released: false }
    }

    /// The bound, s.
    pub fn bound_s(&self) -> f64 {
        self.bound_s
    }

    /// Ends the releases: the rule as printed applies from now on, so that the sequence can converge.
    pub fn freeze(&mut self) {
        self.release = 0.0;
    }

    /// Updates the bound with the step lengths of an iteration.
    pub fn update(&mut self, trajectories: &[Iterate]) {
        let max_s = max_dt_s(trajectories);
        let at_bound = max_s <= self.bound_s * (1.0 + AT_BOUND_TOLERANCE);
        if self.released && !at_bound {
            self.release *= 0.5;
        }
        self.released = at_bound && self.release > 0.0;
        self.bound_s = if self.released { self.bound_s * (1.0 - self.release) } else { max_s };
    }
}

/// Difference between the longest and the shortest flight time (Xu et al. 2022, eq. 19), s.
pub fn flight_time_spread_s(trajectories: &[Iterate]) -> f64 {
    let times_s = trajectories.iter().map(Iterate::flight_time_s);
    max_flight_time_s(trajectories) - times_s.fold(f64::INFINITY, f64::min)
}

/// dt_lb by the rule of Xu et al. 2022, eq. 18: the longest of the damped step lengths, those that have hardly changed
/// since the last iteration, so that no bad early iterate slows down the fleet. Without a damped step length the bound
/// is unchanged.
#[derive(Clone, Debug)]
pub struct DampedTimeBound {
    max_change_s: f64,
    last_s: Vec<f64>,
    bound_s: f64,
}

impl DampedTimeBound {
    /// The bound before the first iteration, 0. A step length is damped if it has changed by at most `max_change_s`;
    /// `trajectories` are the initial ones.
    pub fn new(max_change_s: f64, trajectories: &[Iterate]) -> Self {
        let last_s = trajectories.iter().map(|trajectory| trajectory.dt_s).collect();
        Self { max_change_s, last_s, bound_s: 0.0 }
    }

    /// The bound, s.
    pub fn bound_s(&self) -> f64 {
        self.bound_s
    }

    /// Updates the bound with the step lengths of an iteration.
    pub fn update(&mut self, trajectories: &[Iterate]) {
        let now_s: Vec<f64> = trajectories.iter().map(|trajectory| trajectory.dt_s).collect();
        let damped = now_s.iter().zip(&self.last_s).filter(|(now, last)| (*now - *last).abs() <= self.max_change_s);
        if let Some(max_s) = damped.map(|(now, _)| *now).reduce(f64::max) {
            self.bound_s = max_s;
        }
        self.last_s = now_s;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fleet(dt_s: &[f64]) -> Vec<Iterate> {
        dt_s.iter().map(|&dt_s| Iterate { states: Vec::new(), controls: Vec::new(), dt_s, ramp: 1.0 }).collect()
    }

    #[test]
    fn bound_as_printed_never_falls() {
        let mut bound = TimeBound::new(0.0);
        for (dt_s, expected) in [([5.0, 6.0], 6.0), ([6.0, 6.0], 6.0), ([6.0, 6.5], 6.5), ([6.5, 6.5], 6.5)] {
            bound.update(&fleet(&dt_s));
            assert_eq!(bound.bound_s(), expected);
        }
    }

    #[test]
    fn released_bound_falls_until_a_step_length_stays_above_it() {
        let mut bound = TimeBound::new(0.1);
        bound.update(&fleet(&[5.0, 6.0]));
        assert_eq!(bound.bound_s(), 6.0);
        bound.update(&fleet(&[6.0, 6.0]));
        assert!((bound.bound_s() - 5.4).abs() < 1e-12);
        bound.update(&fleet(&[5.4, 5.7]));
        assert_eq!(bound.bound_s(), 5.7);
        bound.update(&fleet(&[5.7, 5.7]));
        assert!((bound.bound_s() - 5.7 * 0.95).abs() < 1e-12);
    }

    #[test]
    fn undamped_step_lengths_are_ignored() {
        let mut bound = DampedTimeBound::new(0.05, &fleet(&[5.0, 5.0]));
        bound.update(&fleet(&[5.01, 8.0]));
        assert_eq!(bound.bound_s(), 5.01);
        bound.update(&fleet(&[5.5, 6.0]));
        assert_eq!(bound.bound_s(), 5.01);
        bound.update(&fleet(&[5.5, 5.6]));
        assert_eq!(bound.bound_s(), 5.5);
    }
}
