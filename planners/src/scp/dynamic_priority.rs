//! Planner `dpd-scp`: decoupled sequential convex programming in which everybody avoids only those above him in a
//! ranking that follows the flight times (Xu, Wang, Cao, Sun, Long 2022).

use std::time::Instant;

use scenarios::{Iteration, Plan, Scenario};

use super::decoupled::{Avoidance, Fleet, trajectories};
use super::iterate::Iterate;
use super::plan;
use super::priority::Priority;
use super::time_bound::{CalmTimeBound, FLIGHT_TIME_SPREAD_S, flight_time_spread_s};
use crate::planner::{Planner, PlanningMode, Progress};

/// Difference of two flight times beyond which two vehicles change places, s: ours, the paper's is lost.
const SWAP_S: f64 = 0.5;

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Decoupled sequential convex programming with dynamic priorities (Xu et al. 2022)",
    handles: "fixed-wing fleets among cylinders",
    unsupported_reason: super::unsupported_reason,
    mode: PlanningMode::BeforeFlight(plan),
};

const NAME: &str = "dpd-scp";

/// Plans for the whole fleet. `progress` sees every iteration as it ends. The iteration limit applies to each of the two
/// phases.
pub fn plan(scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
    let begin = Instant::now();
    let fleet = Fleet::new(scenario, seed);
    let mut sequence = Sequence::new(&fleet, seed);
    let mut history = Vec::new();
    sequence.run(false, &mut history, progress);
    let converged = sequence.run(true, &mut history, progress);
    let status = plan::status(scenario, &history, converged, history.len());
    plan::assemble(scenario, NAME, seed, &sequence.last, history, status, begin.elapsed())
}

/// The fleet between two iterations.
struct Sequence<'a> {
    fleet: &'a Fleet<'a>,
    last: Vec<Iterate>,
    priority: Priority,
    time_bound: CalmTimeBound,
}

impl<'a> Sequence<'a> {
    fn new(fleet: &'a Fleet<'a>, seed: u64) -> Self {
        let last = fleet.straight_lines();
        let alone: Vec<f64> = last.iter().map(straight_flight_time_s).collect();
        Self { fleet, priority: Priority::new(&alone, seed), time_bound: CalmTimeBound::new(&last), last }
    }

    /// One phase, from the full trust region until everybody is at rest, without or with obstacles and other vehicles.
    /// Returns whether it came to rest.
    fn run(&mut self, avoiding: bool, history: &mut Vec<Iteration>, progress: &mut dyn FnMut(&Iteration)) -> bool {
        let mut trust_region = self.fleet.options.trust_region;
        let simultaneous = self.fleet.scenario.fleet.simultaneous_arrival;
        for _ in 0..self.fleet.options.max_iterations {
            let started = Instant::now();
            let avoids = |i: usize, j: usize| avoiding && self.priority.avoids(i, j);
            let avoidance = Avoidance { avoids: &avoids, obstacles: avoiding };
            let bound_s = if simultaneous { self.time_bound.bound_s() } else { 0.0 };
            let answers = self.fleet.answers(&self.last, avoidance, trust_region, bound_s, &|_, _| {});
            let iteration = self.fleet.summarise(&self.last, &answers, trust_region, started);
            let at_rest = self.fleet.is_at_rest(&self.last, answers.iter().map(|answer| &answer.trajectory));
            self.last = trajectories(answers);
            let flight_times_s: Vec<f64> = self.last.iter().map(Iterate::flight_time_s).collect();
            self.priority.update(&flight_times_s, SWAP_S);
            self.time_bound.update(&self.last);
            trust_region *= self.fleet.options.shrink;
            progress(&iteration);
            history.push(iteration);
            let together = !simultaneous || flight_time_spread_s(&self.last) <= FLIGHT_TIME_SPREAD_S;
            if at_rest && together {
                return true;
            }
        }
        false
    }
}

/// Flight time along the straight line at the mean of the speeds at its ends.
fn straight_flight_time_s(line: &Iterate) -> f64 {
    let (first, last) = (&line.states[0], &line.states[line.intervals()]);
    2.0 * (last - first).fixed_rows::<3>(0).norm() / (first[3] + last[3])
}
