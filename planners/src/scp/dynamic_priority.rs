//! Planner `dpd-scp`: decoupled sequential convex programming in which a vehicle avoids only vehicles of higher
//! priority, in a ranking by flight time (Xu, Wang, Cao, Sun, Long 2022).

use std::time::Instant;

use scenarios::{Iteration, Plan, Scenario};

use super::decoupled::{Avoidance, FleetProblem, trajectories};
use super::iterate::Iterate;
use super::plan;
use super::priority::Priority;
use super::time_bound::DampedTimeBound;
use crate::planner::{Planner, PlanningMode, Progress};

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Decoupled sequential convex programming with dynamic priorities (Xu et al. 2022)",
    handles: "fixed-wing fleets among cylinders",
    unsupported_reason: super::unsupported_reason,
    mode: PlanningMode::BeforeFlight(plan),
};

const NAME: &str = "dpd-scp";

/// Plans for the whole fleet. `progress` receives every iteration. The iteration limit applies to each of the two
/// phases.
pub fn plan(scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
    let begin = Instant::now();
    let fleet = FleetProblem::new(scenario, seed);
    let mut solver = PriorityScp::new(&fleet, seed);
    let mut history = Vec::new();
    solver.run(false, &mut history, progress);
    let converged = solver.run(true, &mut history, progress);
    let status = plan::status(scenario, &history, converged, history.len(), fleet.excess_spread_s(&solver.last));
    plan::assemble(scenario, NAME, seed, &solver.last, history, status, begin.elapsed())
}

/// The fleet between two iterations.
struct PriorityScp<'a> {
    fleet: &'a FleetProblem<'a>,
    last: Vec<Iterate>,
    priority: Priority,
    time_bound: DampedTimeBound,
}

impl<'a> PriorityScp<'a> {
    fn new(fleet: &'a FleetProblem<'a>, seed: u64) -> Self {
        let last = fleet.straight_lines();
        let flight_times_s: Vec<f64> = last.iter().map(straight_flight_time_s).collect();
        let time_bound = DampedTimeBound::new(fleet.options.coordination.damped_change_s, &last);
        Self { fleet, priority: Priority::new(&flight_times_s, seed), time_bound, last }
    }

    /// Runs one phase from the full trust region to convergence, without or with avoidance. Returns whether it
    /// converged.
    fn run(&mut self, avoiding: bool, history: &mut Vec<Iteration>, progress: &mut dyn FnMut(&Iteration)) -> bool {
        let mut trust_region = self.fleet.options.trust_region;
        let simultaneous = self.fleet.scenario.fleet.simultaneous_arrival;
        for _ in 0..self.fleet.options.max_iterations {
            let started = Instant::now();
            let avoids = |i: usize, j: usize| avoiding && self.priority.avoids(i, j);
            let avoidance = Avoidance { avoids: &avoids, obstacles: avoiding };
            let bound_s = if simultaneous { self.time_bound.bound_s() } else { 0.0 };
            let results = self.fleet.solve_all(&self.last, avoidance, trust_region, bound_s, &|_, _| {});
            let iteration = self.fleet.summarise(&self.last, &results, trust_region, started);
            let converged = self.fleet.has_converged(&self.last, results.iter().map(|result| &result.trajectory));
            self.last = trajectories(results);
            let flight_times_s: Vec<f64> = self.last.iter().map(Iterate::flight_time_s).collect();
            self.priority.update(&flight_times_s, self.fleet.options.coordination.swap_threshold_s);
            self.time_bound.update(&self.last);
            trust_region *= self.fleet.options.shrink;
            progress(&iteration);
            history.push(iteration);
            if converged && self.fleet.arrives_together(&self.last) {
                return true;
            }
        }
        false
    }
}

/// Flight time along the straight line at the mean of the initial and final speed, s.
fn straight_flight_time_s(line: &Iterate) -> f64 {
    let (first, last) = (&line.states[0], &line.states[line.intervals()]);
    2.0 * (last - first).fixed_rows::<3>(0).norm() / (first[3] + last[3])
}
