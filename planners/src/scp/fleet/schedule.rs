//! How far an iteration may move, and when the fleet is to arrive.
//!
//! Two phases. While it searches, the trust region stays wide, and the common time bound lies below the longest flight
//! time, so that whoever holds up the fleet can get faster. As soon as the time has settled, the trust region shrinks, the
//! bound closes up with the longest flight time, and this goes on until the plan's own flow keeps every limit.

use super::super::dynamics::State;

/// The trust region is not narrower than this while searching, m.
const SEARCH_M: f64 = 40.0;

/// Relative change of the objective below which the time has settled.
const SETTLED: f64 = 3e-3;

/// Most iterations of a phase.
const PATIENCE: usize = 10;

/// Share of that width below which the time bound no longer gives way.
const HELD: f64 = 0.15;

/// Factor on the trust region where rows are still violated while settling: there it must not close too fast.
const HESITANT: f64 = 0.75;

/// Violation, in scaled units, from which on rows count as violated.
const VIOLATED: f64 = 1e-5;

/// States other than the position are held this tight where the position may move by [`SEARCH_M`], and by the square
/// root of the trust region below: what a turn of χ spoils grows with its square.
const OTHERS: [f64; 6] = [0.0, 0.0, 5.0, 1.0, 0.05, 0.01];

/// The bound stays above this share of the first guess's flight time, which hardly anybody can beat.
const FLOOR: f64 = 0.995;

/// Largest relative change of a step length in one iteration: at the full trust region, and at least.
const TIME_CHANGE: [f64; 2] = [0.05, 0.01];

/// What the two phases ask of the next iteration.
#[derive(Clone, Debug)]
pub struct Schedule {
    /// Half-widths at the start.
    widest: State,
    /// Half-widths now; of these only the positions may shrink to nothing.
    half_widths: State,
    shrink: f64,
    release: f64,
    is_searching: bool,
    /// Iterations in this phase.
    count: usize,
    last_objective_s: f64,
    simultaneous: bool,
    bound_s: f64,
    floor_s: f64,
}

impl Schedule {
    /// - `widest`, `shrink`: trust region at the start, and the factor on it
    /// - `release`: share by which the bound lies below the longest flight time while searching
    /// - `dt_s`: step length of the first guess, if all have to arrive together
    pub fn new(widest: State, shrink: f64, release: f64, dt_s: Option<f64>) -> Self {
        let first_s = dt_s.unwrap_or(0.0);
        Self {
            widest,
            half_widths: widest,
            shrink,
            release,
            is_searching: true,
            count: 0,
            last_objective_s: f64::INFINITY,
            simultaneous: dt_s.is_some(),
            bound_s: (1.0 - release) * first_s,
            floor_s: FLOOR * first_s,
        }
    }

    /// Half-widths of the trust region, in the units of the state.
    pub fn trust_region(&self) -> State {
        let share = (self.half_widths[0] / SEARCH_M).sqrt();
        self.half_widths.sup(&(State::from(OTHERS) * share))
    }

    /// Lower bound of everybody's step length, s.
    pub fn bound_s(&self) -> f64 {
        self.bound_s
    }

    /// Largest relative change of a step length.
    pub fn time_change(&self) -> f64 {
        let [full, least] = TIME_CHANGE;
        (full * self.half_widths[0] / self.widest[0]).max(least)
    }

    /// Are ways and times still being looked for? Then the subproblems need not be solved to the last digit.
    pub fn is_searching(&self) -> bool {
        self.is_searching
    }

    /// Takes note of an iteration: its objective and its longest step length, s, and the largest violation of a row, in
    /// scaled units.
    pub fn observe(&mut self, objective_s: f64, longest_dt_s: f64, violation: f64) {
        self.count += 1;
        let narrowest = self.half_widths[0] * self.shrink < SEARCH_M;
        let settled = (objective_s - self.last_objective_s).abs() < SETTLED * objective_s;
        self.last_objective_s = objective_s;
        if self.is_searching && (settled && narrowest || self.count >= PATIENCE) {
            (self.is_searching, self.count) = (false, 0);
        }
        if !self.is_searching && self.count > PATIENCE {
            // it did not come to rest: once more from where it is
            (self.is_searching, self.count) = (true, 0);
            self.half_widths = self.widest * (SEARCH_M / self.widest[0]).min(1.0);
        } else if !self.is_searching {
            self.half_widths *= if violation > VIOLATED { HESITANT } else { self.shrink };
        } else if !narrowest {
            self.half_widths *= self.shrink;
        }
        if self.simultaneous {
            let width = self.half_widths[0] / SEARCH_M;
            let release = if width > HELD { self.release * (width * width).min(1.0) } else { 0.0 };
            self.bound_s =
                if release > 0.0 { ((1.0 - release) * longest_dt_s).max(self.floor_s) } else { longest_dt_s };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn schedule() -> Schedule {
        Schedule::new(State::new(200.0, 200.0, 50.0, 10.0, 0.6, 0.1), 0.5, 0.03, Some(5.0))
    }

    #[test]
    fn searches_until_the_time_has_settled_then_closes() {
        let mut schedule = schedule();
        assert!((schedule.bound_s() - 0.97 * 5.0).abs() < 1e-12);
        for objective_s in [230.0, 220.0, 215.0] {
            schedule.observe(objective_s, objective_s / 40.0, 0.01);
            assert!(schedule.is_searching());
            assert!(schedule.trust_region()[0] >= SEARCH_M);
        }
        assert!((schedule.bound_s() - 0.97 * 215.0 / 40.0).abs() < 1e-12);
        schedule.observe(215.01, 215.01 / 40.0, 0.0);
        assert!(!schedule.is_searching());
        assert_eq!(schedule.trust_region()[0], 25.0);
        assert!(schedule.bound_s() > 0.985 * 215.01 / 40.0 && schedule.bound_s() < 215.01 / 40.0);
        schedule.observe(215.01, 215.01 / 40.0, 0.01);
        assert_eq!(schedule.trust_region()[0], 25.0 * HESITANT);
        for _ in 0..3 {
            schedule.observe(215.01, 215.01 / 40.0, 0.0);
        }
        assert_eq!(schedule.bound_s(), 215.01 / 40.0);
    }

    #[test]
    fn a_fleet_that_does_not_come_to_rest_searches_again() {
        let mut schedule = schedule();
        let mut searches = Vec::new();
        for _ in 0..40 {
            schedule.observe(200.0, 5.0, 0.1);
            searches.push(schedule.is_searching());
        }
        let begins_again = searches.windows(2).any(|pair| pair == [false, true]);
        assert!(begins_again, "{searches:?}");
    }

    #[test]
    fn who_need_not_arrive_together_has_no_bound() {
        let mut schedule = Schedule::new(State::repeat(100.0), 0.5, 0.03, None);
        schedule.observe(100.0, 5.0, 0.0);
        assert_eq!(schedule.bound_s(), 0.0);
    }
}
