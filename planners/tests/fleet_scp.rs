//! `fleet-scp` finds plans for fleets that the papers do not fly: aircraft that may arrive at different times, slow and
//! fast ones, and goals that need a full circle.

use scenarios::{Plan, PlanStatus, Range, Scenario};

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

#[test]
fn fleets_may_arrive_at_different_times() {
    for name in ["rendezvous-1", "rendezvous-7", "reconfiguration-4", "exchange-10"] {
        let mut scenario = shipped(name);
        let together_s = solved(&scenario).flight_time_s().expect("a plan");
        scenario.fleet.simultaneous_arrival = false;
        let plan = solved(&scenario);
        let last_s = plan.flight_time_s().expect("a plan");
        assert!(last_s < 1.02 * together_s, "{name}: {last_s} s, together {together_s} s");
        let first_s = plan.trajectories.iter().filter_map(|one| one.end_s()).fold(f64::INFINITY, f64::min);
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
