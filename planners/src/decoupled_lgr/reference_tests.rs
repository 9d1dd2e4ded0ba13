//! Plans of `decoupled-lgr` against a reference from another solver, against `fleet-scp`, and against what they have to keep.

use scenarios::{Plan, PlanStatus, Scenario};

/// The first aircraft of the shipped rendezvous.
fn rendezvous(vehicles: usize) -> Scenario {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/fixed-wing/rendezvous-7.toml");
    let mut scenario = scenarios::load(file.as_ref()).expect("a shipped scenario");
    scenario.vehicles.truncate(vehicles);
    scenario
}

fn planned(planner: &str, scenario: &Scenario) -> Plan {
    crate::find(planner).expect("registered").plan(&scenario.planner_view(), 0, &mut |_| {})
}

fn solved(planner: &str, scenario: &Scenario) -> Plan {
    let plan = planned(planner, scenario);
    assert_eq!(plan.status, PlanStatus::Solved, "{planner}: {:?}", plan.reason);
    plan
}

fn flight_time_s(plan: &Plan) -> f64 {
    plan.flight_time_s().expect("a trajectory")
}

/// IPOPT 3.14 (CasADi, MUMPS) on the polar equations by the trapezoidal rule, flight time and 0.01 of the squared load factors,
/// obstacles with 0.5 m margin: 164.180 s with 160 intervals, 164.160 s with 240, 164.152 s with 320. Load factors jump where the
/// time is shortest, so that they alone lead elsewhere than the states: the planner says so.
#[test]
fn the_shortest_flight_of_one_aircraft_agrees_with_ipopt() {
    let plan = planned("decoupled-lgr", &rendezvous(1));
    let time_s = flight_time_s(&plan);
    assert!((time_s - 164.15).abs() < 0.1, "{time_s} s");
    assert_eq!(plan.status, PlanStatus::NotConverged);
    assert!(plan.reason.as_ref().is_some_and(|reason| reason.contains("load factors of uav-1 alone lead")), "{plan:?}");
}

/// Horizontal distances at the instants of all rows, linear between them.
#[test]
fn a_fleet_arrives_together_apart_and_hardly_later_than_by_fleet_scp() {
    let scenario = rendezvous(3);
    let plan = solved("decoupled-lgr", &scenario);
    let fleet_s = flight_time_s(&solved("fleet-scp", &scenario));
    let paths: Vec<Vec<(f64, [f64; 3])>> = plan.trajectories.iter().map(rows).collect();
    for path in &paths {
        let (end_s, _) = path[path.len() - 1];
        assert!((end_s / fleet_s - 1.0).abs() < 0.01, "{end_s} s, {fleet_s} s by fleet-scp");
        assert!((end_s - flight_time_s(&plan)).abs() < 1e-6, "{end_s} s");
        for (at_s, [x_m, y_m, _]) in path {
            for threat in &scenario.world.cylinders {
                let distance_m = (x_m - threat.center_m[0]).hypot(y_m - threat.center_m[1]) - threat.radius_m;
                assert!(distance_m > 1.5, "{distance_m} m from {} at {at_s} s", threat.name);
            }
        }
    }
    for (i, path) in paths.iter().enumerate() {
        for (other, (at_s, [x_m, y_m, _])) in
            paths[..i].iter().flat_map(|other| path.iter().map(move |row| (other, row)))
        {
            let [other_x_m, other_y_m] = between(other, *at_s);
            let distance_m = (x_m - other_x_m).hypot(y_m - other_y_m);
            assert!(distance_m > 100.0, "{distance_m} m at {at_s} s");
        }
    }
}

fn rows(trajectory: &scenarios::Trajectory) -> Vec<(f64, [f64; 3])> {
    let trajectory = trajectory.fixed_wing();
    trajectory.times_s.iter().copied().zip(trajectory.states.iter().map(|state| state.position_m())).collect()
}

/// Position in the plane between two rows.
fn between(path: &[(f64, [f64; 3])], at_s: f64) -> [f64; 2] {
    let next = path.partition_point(|(time_s, _)| *time_s < at_s).clamp(1, path.len() - 1);
    let ((from_s, from_m), (to_s, to_m)) = (path[next - 1], path[next]);
    let fraction = (at_s - from_s) / (to_s - from_s);
    [0, 1].map(|axis| from_m[axis] + fraction * (to_m[axis] - from_m[axis]))
}
