//! Trust region and common time bound of each iteration.
//!
//! There are two phases. In the search phase the trust region stays wide, and the common time bound lies below the
//! longest flight time, so that the slowest vehicle can become faster. Once the flight time has settled, the settling
//! phase shrinks the trust region and raises the bound to the longest flight time, until the plan's own flow keeps
//! every limit.

use super::super::dynamics::State;
use super::super::subproblem::FREE_CONTROL_CHANGE;

/// Smallest half-width of the trust region in the search phase, m.
const MIN_SEARCH_M: f64 = 40.0;

/// Relative change of the objective below which the flight time has settled.
const SETTLED_CHANGE: f64 = 3e-3;

/// Maximum number of iterations of the search phase and of the settling phase.
const MAX_PHASE_ITERATIONS: [usize; 2] = [10, 14];

/// Half-width, as a fraction of [`MIN_SEARCH_M`], below which the time bound is no longer released.
const MIN_RELEASE_WIDTH: f64 = 0.15;

/// Factor on the trust region in the settling phase while rows are violated, so that it does not close too fast.
const VIOLATED_SHRINK: f64 = 0.75;

/// Largest violation of a satisfied row, in scaled units.
pub const MAX_VIOLATION: f64 = 1e-5;

/// Smallest half-widths of the states at a position half-width of [`MIN_SEARCH_M`], in their units. They scale with the
/// square root of the position half-width, because the linearisation error grows with the square of the change of
/// heading.
const STATE_HALF_WIDTHS: [f64; 6] = [0.0, 0.0, 5.0, 1.0, 0.05, 0.01];

/// Lower bound of the time bound, as a fraction of the flight time of the initial guess.
const MIN_TIME_FRACTION: f64 = 0.995;

/// Largest relative change of a step length in one iteration: at the full trust region, and its lower bound.
const MAX_TIME_CHANGE: [f64; 2] = [0.05, 0.01];

/// Trust region and time bound of the next iteration.
#[derive(Clone, Debug)]
pub struct TrustRegionSchedule {
    /// Half-widths at the start.
    initial: State,
    /// Current half-widths; those of the states other than position are bounded below.
    half_widths: State,
    shrink: f64,
    release: f64,
    is_searching: bool,
    /// Has the settling phase ended without convergence?
    has_failed: bool,
    /// Iterations in the current phase.
    count: usize,
    last_objective_s: f64,
    simultaneous: bool,
    bound_s: f64,
    floor_s: f64,
}

impl TrustRegionSchedule {
    /// - `initial`, `shrink`: trust region at the start, and the factor on it
    /// - `release`: fraction by which the bound lies below the longest flight time in the search phase
    /// - `dt_s`: step length of the initial guess, s, if all vehicles must arrive together
    pub fn new(initial: State, shrink: f64, release: f64, dt_s: Option<f64>) -> Self {
        let first_s = dt_s.unwrap_or(0.0);
        Self {
            initial,
            half_widths: initial,
            shrink,
            release,
            is_searching: true,
            has_failed: false,
            count: 0,
            last_objective_s: f64::INFINITY,
            simultaneous: dt_s.is_some(),
            bound_s: (1.0 - release) * first_s,
            floor_s: MIN_TIME_FRACTION * first_s,
        }
    }

    /// Half-widths of the trust region, in the units of the state.
    pub fn trust_region(&self) -> State {
        let fraction = (self.half_widths[0] / MIN_SEARCH_M).sqrt();
        self.half_widths.sup(&(State::from(STATE_HALF_WIDTHS) * fraction))
    }

    /// Lower bound of all step lengths, s.
    pub fn bound_s(&self) -> f64 {
        self.bound_s
    }

    /// Largest relative change of a step length. Where every vehicle has a step length of its own, a change moves it
    /// relative to the others, as a change of its position does.
    pub fn time_change(&self) -> f64 {
        let [full, min] = MAX_TIME_CHANGE;
        let change = full * self.half_widths[0] / self.initial[0];
        match (self.simultaneous, self.is_searching) {
            (true, _) => change.max(min),
            (false, true) => full,
            (false, false) => change,
        }
    }

    /// Half-width of the trust region of the controls, as a fraction of their ranges: wide in the search phase. In the
    /// settling phase the motion between the nodes, which the controls determine, must settle too.
    pub fn control_change(&self) -> f64 {
        let settled = self.half_widths[0] / (0.5 * MIN_SEARCH_M);
        if self.is_searching { FREE_CONTROL_CHANGE } else { (settled * settled).min(FREE_CONTROL_CHANGE) }
    }

    /// Is it the search phase? The subproblems then need less accuracy.
    pub fn is_searching(&self) -> bool {
        self.is_searching
    }

    /// Has the settling phase ended without convergence?
    pub fn has_failed(&self) -> bool {
        self.has_failed
    }

    /// Updates the schedule after an iteration.
    ///
    /// - `objective_s`, `max_dt_s`: objective and longest step length, s
    /// - `violation`: largest violation of a row, in scaled units
    pub fn observe(&mut self, objective_s: f64, max_dt_s: f64, violation: f64) {
        self.count += 1;
        let is_narrowest = self.half_widths[0] * self.shrink < MIN_SEARCH_M;
        let is_settled = (objective_s - self.last_objective_s).abs() < SETTLED_CHANGE * objective_s;
        self.last_objective_s = objective_s;
        if self.is_searching && (is_settled && is_narrowest || self.count >= MAX_PHASE_ITERATIONS[0]) {
            (self.is_searching, self.count) = (false, 0);
        }
        if !self.is_searching {
            self.has_failed = self.count > MAX_PHASE_ITERATIONS[1];
            self.half_widths *= if violation > MAX_VIOLATION { VIOLATED_SHRINK } else { self.shrink };
        } else if !is_narrowest {
            self.half_widths *= self.shrink;
        }
        if self.simultaneous {
            let width = self.half_widths[0] / MIN_SEARCH_M;
            let release = if width > MIN_RELEASE_WIDTH { self.release * (width * width).min(1.0) } else { 0.0 };
            self.bound_s = if release > 0.0 { ((1.0 - release) * max_dt_s).max(self.floor_s) } else { max_dt_s };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn schedule() -> TrustRegionSchedule {
        TrustRegionSchedule::new(State::new(200.0, 200.0, 50.0, 10.0, 0.6, 0.1), 0.5, 0.03, Some(5.0))
    }

    #[test]
    fn searches_until_the_flight_time_has_settled() {
        let mut schedule = schedule();
        assert!((schedule.bound_s() - 0.97 * 5.0).abs() < 1e-12);
        for objective_s in [230.0, 220.0, 215.0] {
            schedule.observe(objective_s, objective_s / 40.0, 0.01);
            assert!(schedule.is_searching());
            assert!(schedule.trust_region()[0] >= MIN_SEARCH_M);
        }
        assert!((schedule.bound_s() - 0.97 * 215.0 / 40.0).abs() < 1e-12);
        schedule.observe(215.01, 215.01 / 40.0, 0.0);
        assert!(!schedule.is_searching());
        assert_eq!(schedule.trust_region()[0], 25.0);
        assert!(schedule.bound_s() > 0.985 * 215.01 / 40.0 && schedule.bound_s() < 215.01 / 40.0);
        schedule.observe(215.01, 215.01 / 40.0, 0.01);
        assert_eq!(schedule.trust_region()[0], 25.0 * VIOLATED_SHRINK);
        for _ in 0..3 {
            schedule.observe(215.01, 215.01 / 40.0, 0.0);
        }
        assert_eq!(schedule.bound_s(), 215.01 / 40.0);
    }

    #[test]
    fn a_fleet_that_does_not_converge_fails() {
        let mut schedule = schedule();
        let observed = (1..40).find(|_| {
            schedule.observe(200.0, 5.0, 0.1);
            schedule.has_failed()
        });
        assert!(!schedule.is_searching());
        assert!(
            observed.is_some_and(|count| count <= MAX_PHASE_ITERATIONS[0] + MAX_PHASE_ITERATIONS[1] + 1),
            "{observed:?}"
        );
    }

    #[test]
    fn without_simultaneous_arrival_there_is_no_bound() {
        let mut schedule = TrustRegionSchedule::new(State::repeat(100.0), 0.5, 0.03, None);
        schedule.observe(100.0, 5.0, 0.0);
        assert_eq!(schedule.bound_s(), 0.0);
    }
}
