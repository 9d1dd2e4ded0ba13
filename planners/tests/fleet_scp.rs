//! `fleet-scp` finds plans for fleets that the papers do not fly: aircraft that may arrive at different times, slow and
//! fast ones, and goals that need a full circle.

use scenarios::fixed_wing::State;
use scenarios::{Cylinder, Plan, PlanStatus, Range, Scenario};

fn shipped(name: &str) -> Scenario {
    let path = format!("{}/../scenarios/fixed-wing/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    scenarios::load(path.as_ref()).expect("a shipped scenario")
}

fn plan(scenario: &Scenario) -> Plan {
    planners::find("fleet-scp").expect("the planner").plan(scenario, 0, &mut |_| {})
}

fn solved(scenario: &Scenario) -> Plan {
    let plan = plan(scenario);
    assert_eq!((plan.status, &plan.reason), (PlanStatus::Solved, &None), "{}", scenario.name);
    plan
}

/// One aircraft without obstacles, 4 km from its goal, at a speed in the middle of its range.
fn alone(speed_mps: f64) -> Scenario {
    let mut scenario = shipped("rendezvous-1");
    scenario.world.cylinders.clear();
    scenario.planner.intervals = None;
    scenario.simulation.max_duration_s = 3000.0;
    let model = scenario.models.fixed_wing.values_mut().next().expect("a model");
    model.planning_limits.speed_mps = Range::new(0.85 * speed_mps, 1.15 * speed_mps);
    model.limits.speed_mps = Range::new(0.6 * speed_mps, 1.4 * speed_mps);
    let vehicle = &mut scenario.vehicles[0];
    for (waypoint, x_m) in [(&mut vehicle.start, 2000.0), (&mut vehicle.goal, 6000.0)] {
        (waypoint.x_m, waypoint.y_m, waypoint.heading_deg, waypoint.speed_mps) = (x_m, 0.0, 0.0, speed_mps);
    }
    scenario
}

/// When the plan of a vehicle is at its goal for the first time, s.
fn arrival_s(scenario: &Scenario, plan: &Plan, vehicle: usize) -> f64 {
    let (goal, trajectory) = (&scenario.vehicles[vehicle].goal, plan.trajectories[vehicle].fixed_wing());
    let is_there = |state: &State| (state.x_m - goal.x_m).hypot(state.y_m - goal.y_m) < 0.01;
    trajectory.times_s[trajectory.states.iter().position(is_there).expect("it arrives")]
}

/// Straight on, the first to arrive would be in the threat before the last one arrives.
#[test]
fn an_aircraft_that_has_arrived_holds_clear_of_a_threat_until_the_last_one_has_arrived() {
    let mut scenario = alone(35.0);
    scenario.fleet.simultaneous_arrival = false;
    let mut second = scenario.vehicles[0].clone();
    second.name = "uav-2".to_owned();
    (second.start.y_m, second.goal.y_m, second.goal.x_m) = (-1500.0, -1500.0, 4000.0);
    let threat = Cylinder { name: "ahead".to_owned(), center_m: [4900.0, -1500.0], radius_m: 200.0 };
    scenario.world.cylinders.push(threat.clone());
    scenario.vehicles.push(second);
    let plan = solved(&scenario);
    let last_s = plan.flight_time_s().expect("a plan");
    assert!(arrival_s(&scenario, &plan, 1) < last_s - 40.0);
    let held = plan.trajectories[1].fixed_wing();
    assert_eq!(held.times_s.last(), Some(&last_s));
    let distances_m = held.states.iter().map(|at| (at.x_m - threat.center_m[0]).hypot(at.y_m - threat.center_m[1]));
    assert!(distances_m.fold(f64::INFINITY, f64::min) > threat.radius_m + 1.5);
}

/// Threats all around the goal leave no way on from it: the aircraft waits before its goal.
#[test]
fn an_aircraft_that_cannot_go_on_from_its_goal_arrives_with_the_last_one() {
    let mut scenario = alone(35.0);
    scenario.fleet.simultaneous_arrival = false;
    let mut second = scenario.vehicles[0].clone();
    second.name = "uav-2".to_owned();
    (second.start.y_m, second.goal.y_m, second.goal.x_m) = (-1500.0, -1500.0, 4000.0);
    for (y_m, name) in [(-2150.0, "right"), (-1500.0, "ahead"), (-850.0, "left")] {
        scenario.world.cylinders.push(Cylinder { name: name.to_owned(), center_m: [4700.0, y_m], radius_m: 400.0 });
    }
    scenario.vehicles.push(second);
    let plan = solved(&scenario);
    let [first_s, second_s] = [0, 1].map(|vehicle| arrival_s(&scenario, &plan, vehicle));
    assert!((first_s - second_s).abs() < 1e-6, "{first_s} s and {second_s} s");
}

#[test]
fn fleets_may_arrive_at_different_times() {
    for name in ["rendezvous-1", "rendezvous-7", "reconfiguration-4", "exchange-10"] {
        let mut scenario = shipped(name);
        let together_s = solved(&scenario).flight_time_s().expect("a plan");
        scenario.fleet.simultaneous_arrival = false;
        let plan = solved(&scenario);
        let last_s = plan.flight_time_s().expect("a plan");
        assert!(last_s < 1.02 * together_s, "{name}: {last_s} s, together {together_s} s");
        let first_s =
            (0..scenario.vehicles.len()).map(|i| arrival_s(&scenario, &plan, i)).fold(f64::INFINITY, f64::min);
        assert!(
            plan.trajectories.iter().all(|one| one.end_s() == Some(last_s)),
            "{name}: all fly until the last arrival"
        );
        assert!(name != "rendezvous-7" || first_s < 0.95 * last_s, "{name}: {first_s} s");
    }
}

#[test]
fn slow_and_fast_aircraft_fly_straight_ahead() {
    for speed_mps in [8.0, 12.0, 20.0, 60.0] {
        for together in [true, false] {
            let mut scenario = alone(speed_mps);
            scenario.fleet.simultaneous_arrival = together;
            let flight_time_s = solved(&scenario).flight_time_s().expect("a plan");
            let fastest_s = 4000.0 / (1.15 * speed_mps);
            assert!((fastest_s..1.05 * fastest_s).contains(&flight_time_s), "{speed_mps} m/s: {flight_time_s} s");
        }
    }
}

#[test]
fn a_goal_behind_the_start_and_one_far_above_it_are_reached() {
    let mut behind = alone(35.0);
    behind.vehicles[0].goal.x_m = 1900.0;
    assert!(solved(&behind).flight_time_s().expect("a plan") > 60.0, "it needs a full circle");
    let mut above = alone(35.0);
    (above.vehicles[0].start.z_m, above.vehicles[0].goal.z_m, above.vehicles[0].goal.x_m) = (320.0, 480.0, 3000.0);
    let climb_s = 160.0 / (40.25 * 5_f64.to_radians().sin());
    assert!(solved(&above).flight_time_s().expect("a plan") > climb_s, "1 km is too short for a climb of 160 m");
}

#[test]
fn intervals_that_are_too_long_are_named() {
    let mut scenario = alone(8.0);
    scenario.planner.intervals = Some(8);
    scenario.planner.max_iterations = Some(15);
    let plan = plan(&scenario);
    if plan.status == PlanStatus::NoPlan {
        let reason = plan.reason.expect("a reason");
        assert!(reason.contains("planner.intervals"), "{reason}");
    }
}
