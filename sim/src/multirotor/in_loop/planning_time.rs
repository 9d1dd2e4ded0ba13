use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use scenarios::{Planning, PlanningClock};

/// Simulated time that a call of the planner takes.
#[derive(Clone, Debug)]
pub(super) struct PlanningTime {
    settings: Planning,
    rng: ChaCha8Rng,
    /// Calls so far.
    count: usize,
}

impl PlanningTime {
    pub fn new(settings: &Planning, rng: ChaCha8Rng) -> Self {
        Self { settings: settings.clone(), rng, count: 0 }
    }

    /// Time of the next call, s, which took `wall_s` on this machine.
    pub fn next_s(&mut self, wall_s: f64) -> f64 {
        let Planning { median_s, spread, recorded_s, .. } = &self.settings;
        let time_s = match self.settings.time {
            PlanningClock::Measured => wall_s,
            PlanningClock::Recorded => recorded_s[self.count % recorded_s.len()],
            PlanningClock::Modelled if *spread == 0.0 => *median_s,
            PlanningClock::Modelled => {
                let unit: f64 = StandardNormal.sample(&mut self.rng);
                median_s * (spread * unit).exp()
            }
        };
        self.count += 1;
        time_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(settings: &Planning) -> Vec<f64> {
        let mut time = PlanningTime::new(settings, scenarios::stream(1, "planning/test"));
        (0..2001).map(|_| time.next_s(0.5)).collect()
    }

    #[test]
    fn modelled_times_have_their_median_and_do_not_depend_on_the_clock() {
        let settings = Planning { median_s: 0.02, spread: 0.5, ..Planning::default() };
        let mut drawn = times(&settings);
        assert_eq!(drawn, times(&settings));
        drawn.sort_by(f64::total_cmp);
        // The median of n values of a log-normal distribution varies by spread sqrt(π / 2n) = 0.014 of itself.
        assert!((drawn[1000] / 0.02 - 1.0).abs() < 0.05, "{}", drawn[1000]);
        let beyond = drawn.iter().filter(|time| **time > 0.02 * 0.5_f64.exp()).count() as f64 / 2001.0;
        assert!((beyond - 0.159).abs() < 0.03, "{beyond}");
    }

    #[test]
    fn recorded_times_repeat_in_order_and_measured_ones_are_those_of_the_machine() {
        let recorded =
            Planning { time: PlanningClock::Recorded, recorded_s: vec![0.1, 0.2, 0.3], ..Planning::default() };
        assert_eq!(times(&recorded)[..4], [0.1, 0.2, 0.3, 0.1]);
        assert_eq!(times(&Planning { time: PlanningClock::Measured, ..Planning::default() })[0], 0.5);
    }
}
