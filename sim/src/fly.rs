use std::time::Instant;

use scenarios::in_loop::InLoopPlanner;
use scenarios::{Family, Plan, Scenario};

use crate::{Flight, fixed_wing, multirotor, slung_load};

/// Who decides on the controls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ControlMode {
    /// The tracker follows the plan from the measured state.
    #[default]
    Tracker,
    /// Nobody: the planned controls act as a function of time, whatever happens, inside the vehicle's limits.
    OpenLoop,
}

/// How a flight differs from an ordinary one, to look at plant and tracker apart: the tests hold open-loop flights
/// against an independent integrator, and let the tracker catch up from a wrong start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlightOptions {
    /// Who decides on the controls.
    pub control_mode: ControlMode,
    /// Where every vehicle starts, relative to its plan's first state, world frame, m.
    pub start_offset_m: [f64; 3],
    /// Velocity over ground with which every vehicle starts, relative to its plan's first state, world frame, m/s.
    pub start_velocity_offset_mps: [f64; 3],
    /// How often the plant's step is halved. Commands are still held, and the log written, once per step of the scenario.
    pub halvings: u32,
}

impl FlightOptions {
    /// An ordinary flight with a plant whose step is halved so often.
    pub fn finer(halvings: u32) -> Self {
        Self { halvings, ..Self::default() }
    }

    /// Steps of the plant where there is one in an ordinary flight.
    pub(crate) fn substeps(&self) -> usize {
        1 << self.halvings
    }
}

/// Flies a plan: every vehicle starts in its plan's first state and follows its trajectory by the tracker, in the wind
/// and with the sensors and the mass of the scenario, until `coast_s` after the plan's end or `max_duration_s`.
///
/// - `plan`: complete and checked: one trajectory per vehicle, in the scenario's order, with at least two nodes
/// - `seed`: of gusts and sensors; the same seed gives the same flight
/// - `progress`: is called about once per simulated second with the simulated time, s
///
/// Panics if the plan is not what it should be: whoever loaded it should have seen.
pub fn fly(scenario: &Scenario, plan: &Plan, seed: u64, progress: &mut dyn FnMut(f64)) -> Flight {
    fly_with(scenario, plan, seed, &FlightOptions::default(), progress)
}

/// [`fly`] with another control_mode or another start.
pub fn fly_with(
    scenario: &Scenario,
    plan: &Plan,
    seed: u64,
    setup: &FlightOptions,
    progress: &mut dyn FnMut(f64),
) -> Flight {
    let began = Instant::now();
    assert_flyable(scenario, plan);
    let steps = number_of_steps(scenario, plan);
    let (vehicles, mut events) = match scenario.family() {
        Family::FixedWing => fixed_wing::fly(scenario, plan, seed, setup, steps, progress),
        Family::SlungLoad => slung_load::fly(scenario, plan, seed, setup, steps, progress),
        Family::Multirotor => multirotor::fly(scenario, plan, seed, setup, steps, progress),
    };
    events.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    Flight {
        step_s: scenario.simulation.step_s,
        plan_end_s: plan.flight_time_s().unwrap_or(0.0),
        vehicles,
        events,
        planning: None,
        wall_s: began.elapsed().as_secs_f64(),
    }
}

/// Flies multirotors whose planners are asked again and again during the flight, until all have come to rest at their
/// goals and `coast_s` more, or until `max_duration_s`.
///
/// - `planners`: one per vehicle, in the scenario's order
/// - `seed`: of gusts, sensors and planning times
/// - `progress`: is called about once per simulated second with the simulated time, s
///
/// Panics if the vehicles are no multirotors, or the planners not as many.
pub fn fly_in_loop(
    scenario: &Scenario,
    planners: Vec<Box<dyn InLoopPlanner>>,
    seed: u64,
    progress: &mut dyn FnMut(f64),
) -> Flight {
    let began = Instant::now();
    assert_eq!(scenario.family(), Family::Multirotor, "multirotors alone are planned for in the loop");
    assert_eq!(scenario.vehicles.len(), planners.len(), "every vehicle has a planner");
    let mut flight = multirotor::fly_in_loop(scenario, planners, seed, progress);
    flight.events.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    flight.wall_s = began.elapsed().as_secs_f64();
    flight
}

/// Number of steps to the end of the coast, but not beyond the longest duration.
fn number_of_steps(scenario: &Scenario, plan: &Plan) -> usize {
    let simulation = &scenario.simulation;
    let plan_end_s = plan.flight_time_s().expect("a plan that is flown has trajectories");
    let end_s = (plan_end_s + simulation.coast_s).min(simulation.max_duration_s);
    // A thousandth of a step is rounding, not time.
    (end_s / simulation.step_s - 1e-3).ceil().max(0.0) as usize
}

/// Panics with the reason if a plan cannot be flown for reasons of form.
fn assert_flyable(scenario: &Scenario, plan: &Plan) {
    assert!(scenario.simulation.step_s > 0.0, "the step must be positive, not {}", scenario.simulation.step_s);
    assert_eq!(plan.trajectories.len(), scenario.vehicles.len(), "a plan has one trajectory per vehicle");
    for (vehicle, trajectory) in scenario.vehicles.iter().zip(&plan.trajectories) {
        let (name, times_s) = (&vehicle.name, trajectory.times_s());
        assert_eq!(name, trajectory.vehicle(), "trajectories stand in the order of the vehicles");
        assert_eq!(trajectory.family(), scenario.family(), "the trajectory of {name} is of its family");
        assert!(times_s.len() >= 2, "the trajectory of {name} has fewer than two nodes");
        for (what, count) in trajectory.nodes().counts() {
            assert_eq!(times_s.len(), count, "the trajectory of {name} has as many {what} as nodes");
        }
        assert_eq!(times_s[0], 0.0, "the trajectory of {name} begins at time 0");
        let is_in_order = |pair: &[f64]| pair[0] < pair[1] || (trajectory.allows_discontinuity() && pair[0] == pair[1]);
        assert!(times_s.windows(2).all(is_in_order), "the times of {name} increase");
        assert!(trajectory.nodes().numbers().into_iter().all(f64::is_finite), "{name}: finite numbers only");
    }
}
