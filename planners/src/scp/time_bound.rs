//! The common lower bound of all step lengths, by which a fleet arrives together (Wang, Xu, Long 2020, eq. 10).

use super::iterate::Iterate;

/// Relative distance at which a step length counts as sitting on the bound.
const TOUCHING: f64 = 1e-6;

/// dt_lb of the next iteration.
///
/// As printed, dt_i >= max_j dtbar_j can never fall again, so one wild early iterate holds up the fleet for good. With
/// a release share r > 0 (ours) the bound falls by r whenever the whole fleet sits on it. If somebody then stays above
/// the fallen bound, that vehicle cannot fly faster, and r is halved.
#[derive(Clone, Debug)]
pub struct TimeBound {
    release: f64,
    bound_s: f64,
    released: bool,
}

impl TimeBound {
    /// No bound before the first iteration. `release` is r, in [0, 1).
    pub fn new(release: f64) -> Self {
        Self { release, bound_s: 0.0, released: false }
    }

    /// The bound, s.
    pub fn bound_s(&self) -> f64 {
        self.bound_s
    }

    /// No more releases: from now on the rule as printed, so that the sequence can come to rest.
    pub fn freeze(&mut self) {
        self.release = 0.0;
    }

    /// Takes note of an iteration's step lengths.
    pub fn update(&mut self, trajectories: &[Iterate]) {
        let longest_s = trajectories.iter().map(|trajectory| trajectory.dt_s).fold(0.0, f64::max);
        let touching = longest_s <= self.bound_s * (1.0 + TOUCHING);
        if self.released && !touching {
            self.release *= 0.5;
        }
        self.released = touching && self.release > 0.0;
        self.bound_s = if self.released { self.bound_s * (1.0 - self.release) } else { longest_s };
    }
}

/// Change of a step length between two iterations below which it counts as calm, s: ours, the paper's is lost.
const CALM_S: f64 = 0.05;

/// Spread of the flight times below which a fleet arrives together (Xu et al. 2022, eq. 19), s: ours, the paper's is
/// lost.
pub const FLIGHT_TIME_SPREAD_S: f64 = 0.1;

/// Difference between the longest and the shortest flight time, s.
pub fn flight_time_spread_s(trajectories: &[Iterate]) -> f64 {
    let times_s = || trajectories.iter().map(Iterate::flight_time_s);
    times_s().fold(0.0, f64::max) - times_s().fold(f64::INFINITY, f64::min)
}

/// dt_lb by the rule of Xu et al. 2022, eq. 18: the longest step length among those that have hardly changed since the
/// last iteration, so that no wild early iterate holds up the fleet. Where all have changed, the last bound stays.
#[derive(Clone, Debug)]
pub struct CalmTimeBound {
    last_s: Vec<f64>,
    bound_s: f64,
}

impl CalmTimeBound {
    /// No bound yet. `trajectories`: those that the first iteration starts from.
    pub fn new(trajectories: &[Iterate]) -> Self {
        Self { last_s: trajectories.iter().map(|trajectory| trajectory.dt_s).collect(), bound_s: 0.0 }
    }

    /// The bound, s.
    pub fn bound_s(&self) -> f64 {
        self.bound_s
    }

    /// Takes note of an iteration's step lengths.
    pub fn update(&mut self, trajectories: &[Iterate]) {
        let now_s: Vec<f64> = trajectories.iter().map(|trajectory| trajectory.dt_s).collect();
        let calm = now_s.iter().zip(&self.last_s).filter(|(now, last)| (*now - *last).abs() <= CALM_S);
        if let Some(longest_s) = calm.map(|(now, _)| *now).reduce(f64::max) {
            self.bound_s = longest_s;
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
    fn as_printed_the_bound_never_falls() {
        let mut bound = TimeBound::new(0.0);
        for (dt_s, expected) in [([5.0, 6.0], 6.0), ([6.0, 6.0], 6.0), ([6.0, 6.5], 6.5), ([6.5, 6.5], 6.5)] {
            bound.update(&fleet(&dt_s));
            assert_eq!(bound.bound_s(), expected);
        }
    }

    #[test]
    fn released_bound_falls_until_somebody_stays_above_it() {
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
    fn wild_step_lengths_do_not_count() {
        let mut bound = CalmTimeBound::new(&fleet(&[5.0, 5.0]));
        bound.update(&fleet(&[5.01, 8.0]));
        assert_eq!(bound.bound_s(), 5.01);
        bound.update(&fleet(&[5.5, 6.0]));
        assert_eq!(bound.bound_s(), 5.01);
        bound.update(&fleet(&[5.5, 5.6]));
        assert_eq!(bound.bound_s(), 5.5);
    }
}
