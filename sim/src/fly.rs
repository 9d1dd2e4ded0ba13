use std::time::Instant;

use scenarios::{Plan, Scenario};

use crate::families;
use crate::flight::{FleetLog, Flight, InLoopLog};
use crate::request::{FlightOptions, FlightRequest, ReferenceSource};

/// Simulates the flight of a scenario's vehicles, in the wind and with the sensors and the mass of the scenario.
///
/// `source` is one of
///
/// - a plan, complete and checked: one trajectory per vehicle, in the order of the scenario, with at least two nodes.
///   Every vehicle starts in the first state of its trajectory and tracks it, until `coast_s` after the end of the plan
///   or until `max_duration_s`.
/// - in-loop planners, one per vehicle, in the order of the scenario. They replan during the flight, until all vehicles
///   rest at their goals, with references that lead nowhere else, and have stayed there for `coast_s`; or until `max_duration_s`.
/// - an earlier flight that was planned in the loop: its references are followed again, for as long as it lasted.
///
/// `seed` determines gusts, sensor noise, start offsets and planning times: the same seed gives the same flight.
/// `progress` is called about once per simulated second with the simulated time, s.
///
/// # Panics
///
/// If the plan does not have the form above, which [`scenarios`] checks when it loads one; if vehicles other than
/// multirotors are to be planned for in the loop; or if the number of planners is not that of the vehicles.
///
/// # Examples
///
/// ```
/// use scenarios::in_loop::Node;
/// use scenarios::multirotor::Trajectory;
/// use scenarios::Plan;
///
/// let scenario = scenarios::parse("hop.toml", r#"
/// name = "hop"
/// description = "A point mass flies 4 m east."
///
/// [world]
/// map = { x_m = [-10, 10], y_m = [-10, 10], z_m = [0, 10] }
///
/// [models.multirotor.quad]
/// mass_kg = 1.5
/// body_radius_m = 0.35
/// sensor_range_m = 8
/// limits = { speed_mps = 9, acceleration_mps2 = 6 }
/// planning_limits = { speed_mps = 3, acceleration_mps2 = 3 }
///
/// [[vehicles]]
/// name = "uav-1"
/// model = "quad"
/// start = { x_m = 0, y_m = 0, z_m = 5 }
/// goal = { x_m = 4, y_m = 0, z_m = 5 }
///
/// [planner]
/// name = "by-hand"
/// "#).expect("the scenario is valid");
///
/// let nodes = [Node::at_rest(0.0, [0.0, 0.0, 5.0]), Node::at_rest(4.0, [4.0, 0.0, 5.0])];
/// let trajectory = Trajectory::through("uav-1", &nodes);
/// let plan = Plan::new("hop", "by-hand", 0, vec![trajectory.into()]);
///
/// let flight = sim::fly(&scenario, &plan, 7, &mut |_| {});
/// let last = flight.vehicles[0].samples.last().expect("a flight has samples");
/// assert!((last.position_m[0] - 4.0).abs() < 0.01);
/// ```
pub fn fly<'a>(
    scenario: &Scenario,
    source: impl Into<ReferenceSource<'a>>,
    seed: u64,
    progress: &mut dyn FnMut(f64),
) -> Flight {
    fly_with(scenario, source, seed, &FlightOptions::default(), progress)
}

/// [`fly`] with another control mode, another start or a finer step.
///
/// # Panics
///
/// As [`fly`].
pub fn fly_with<'a>(
    scenario: &Scenario,
    source: impl Into<ReferenceSource<'a>>,
    seed: u64,
    options: &FlightOptions,
    progress: &mut dyn FnMut(f64),
) -> Flight {
    let began = Instant::now();
    let source = source.into();
    assert_flyable(scenario, &source);
    let planned_end_s = planned_end_s(&source);
    let request = FlightRequest { scenario, seed, options, steps: max_steps(scenario, &source) };
    let FleetLog { vehicles, mut events, in_loop } = families::simulate(&request, source, progress);
    events.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    let (plan_end_s, planning) = match in_loop {
        Some(InLoopLog { end_s, planning }) => (end_s, Some(planning)),
        None => (planned_end_s.unwrap_or(0.0), None),
    };
    let wall_s = began.elapsed().as_secs_f64();
    Flight { step_s: request.step_s(), plan_end_s, vehicles, events, planning, wall_s }
}

/// End of a plan that was made before the flight, s.
fn planned_end_s(source: &ReferenceSource<'_>) -> Option<f64> {
    match source {
        ReferenceSource::Plan(plan) => Some(plan.flight_time_s().expect("a flyable plan has trajectories")),
        ReferenceSource::InLoop(_) => None,
        ReferenceSource::Recorded(flight) => Some(flight.plan_end_s),
    }
}

/// Number of steps to the end of the coast, or to the maximum duration, or of an earlier flight.
fn max_steps(scenario: &Scenario, source: &ReferenceSource<'_>) -> usize {
    if let ReferenceSource::Recorded(flight) = source {
        return flight.vehicles.iter().map(|log| log.samples.len().saturating_sub(1)).max().unwrap_or(0);
    }
    let (simulation, planned_end_s) = (&scenario.simulation, planned_end_s(source));
    let end_s = planned_end_s
        .map_or(simulation.max_duration_s, |end_s| (end_s + simulation.coast_s).min(simulation.max_duration_s));
    // A thousandth of a step is rounding, not time.
    (end_s / simulation.step_s - 1e-3).ceil().max(0.0) as usize
}

/// Panics with the reason if the source does not fit the scenario.
fn assert_flyable(scenario: &Scenario, source: &ReferenceSource<'_>) {
    assert!(scenario.simulation.step_s > 0.0, "the step must be positive, not {}", scenario.simulation.step_s);
    match source {
        ReferenceSource::Plan(plan) => assert_plan_is_flyable(scenario, plan),
        ReferenceSource::InLoop(planners) => {
            assert!(scenario.family().senses_obstacles(), "only multirotors are planned for in the loop");
            assert_eq!(scenario.vehicles.len(), planners.len(), "every vehicle has a planner");
        }
        ReferenceSource::Recorded(flight) => {
            assert!(flight.planning.is_some(), "the earlier flight was planned in the loop");
            assert_eq!(scenario.vehicles.len(), flight.vehicles.len(), "every vehicle has a log");
        }
    }
}

fn assert_plan_is_flyable(scenario: &Scenario, plan: &Plan) {
    assert_eq!(plan.trajectories.len(), scenario.vehicles.len(), "a plan has one trajectory per vehicle");
    for (vehicle, trajectory) in scenario.vehicles.iter().zip(&plan.trajectories) {
        let (name, times_s) = (&vehicle.name, trajectory.times_s());
        assert_eq!(name, trajectory.vehicle(), "trajectories are in the order of the vehicles");
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
