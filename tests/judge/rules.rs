//! Which checks decide (skipped, advisory, required), and what the verdict says about the planner.

use harness::metrics::over_time::{clearance_over_time, separation_over_time};
use harness::metrics::{Metrics, measure};
use harness::verdict::{FlownMotions, Outcome, Status, Verdict};
use scenarios::{CHECKS, Cylinder, Geofence, GeofenceKind, PlanStatus, SeparationMeasure};

use crate::fleet::{Case, SPEED_MPS, check, factors};

#[test]
fn what_does_not_apply_is_skipped_with_the_reason() {
    let mut case = Case::straight(&[0.0], 0.01);
    case.scenario.world.cylinders.clear();
    case.scenario.fleet.simultaneous_arrival = false;
    let verdict = case.judge();
    assert_eq!(verdict.outcome, Outcome::Pass);
    for name in ["nodes.separation", "plan.separation", "flight.clearance", "plan.arrival", "flight.arrival"] {
        let check = check(&verdict, name);
        assert_eq!(check.status, Status::Skip);
        assert!(check.reason.is_some() && check.value.is_none());
    }
}

#[test]
fn a_required_check_that_is_skipped_fails() {
    let mut case = Case::good();
    case.scenario.world.cylinders.clear();
    assert_eq!(case.judge().outcome, Outcome::Pass);
    case.scenario.verdict.required = vec!["plan.clearance".to_owned()];
    assert_eq!(case.status("plan.clearance"), Status::Fail);
    assert_eq!(case.judge().outcome, Outcome::Fail);
}

#[test]
fn a_required_check_that_does_not_exist_fails() {
    let mut case = Case::good();
    case.scenario.verdict.required = vec!["plan.charm".to_owned()];
    assert_eq!(case.status("plan.charm"), Status::Fail);
    assert_eq!(case.judge().outcome, Outcome::Fail);
}

#[test]
fn an_advisory_check_is_shown_and_does_not_decide() {
    let mut case = Case::good();
    case.scenario.vehicles[2].goal.z_m += 1.5 * case.scenario.limits().goal_m;
    assert_eq!(case.judge().outcome, Outcome::Fail);
    case.scenario.verdict.advisory = ["nodes.goal", "plan.goal", "flight.goal"].map(str::to_owned).to_vec();
    let verdict = case.judge();
    let goal = check(&verdict, "plan.goal");
    assert_eq!((goal.status, goal.advisory), (Status::Fail, true));
    assert_eq!(verdict.outcome, Outcome::Pass);
    assert!(verdict.overclaimed, "advisory or not, the planner said more than is true");
}

#[test]
fn a_crash_and_what_makes_a_log_believable_decide_even_if_advisory() {
    let mut case = Case::good();
    case.trajectory(2).states[6].x_m += 1.5;
    let always_decisive = CHECKS.iter().filter(|check| !check.may_be_advisory());
    case.scenario.verdict.advisory = always_decisive.map(|check| check.name.to_owned()).collect();
    assert_eq!(case.scenario.verdict.advisory.len(), 8, "{:?}", case.scenario.verdict.advisory);
    let verdict = case.judge();
    assert_eq!(check(&verdict, "plan.dynamics").status, Status::Fail);
    assert_eq!(verdict.outcome, Outcome::Fail);
}

#[test]
fn an_honest_planner_does_not_overclaim() {
    let mut case = Case::good();
    case.trajectory(2).states[6].x_m += 1.5;
    case.plan.status = PlanStatus::NotConverged;
    let verdict = case.judge();
    assert_eq!((verdict.outcome, verdict.overclaimed), (Outcome::Fail, false));
}

#[test]
fn nodes_at_different_times_are_not_compared() {
    let mut case = Case::good();
    case.trajectory(1).times_s[5] += 2e-6;
    let separation = case.check("nodes.separation");
    assert_eq!(separation.status, Status::Skip);
    assert!(separation.reason.is_some_and(|reason| reason.contains("uav-1") && reason.contains("uav-2")));
    case.trajectory(1).times_s[5] -= 1.5e-6;
    assert_eq!(case.status("nodes.separation"), Status::Pass);
}

#[test]
fn a_distance_that_misses_its_limit_by_rounding_is_at_the_limit() {
    let mut case = Case::good();
    case.scenario.fleet.separation_m = Some(200.0);
    let check = case.check("plan.separation");
    assert_eq!((check.status, check.margin), (Status::Pass, Some(0.0)), "{check:#?}");
    // A micrometre exceeds rounding between the nodes, and is within a solver's tolerance at them.
    case.scenario.fleet.separation_m = Some(200.0 + 1e-6);
    assert_eq!(case.status("plan.separation"), Status::Fail);
    assert_eq!(case.status("nodes.separation"), Status::Pass);
    case.scenario.fleet.separation_m = Some(200.0 + 2e-5);
    assert_eq!(case.status("nodes.separation"), Status::Fail);
}

#[test]
fn the_planning_limits_bind_the_nodes_and_the_physical_ones_the_rest() {
    let mut case = Case::good();
    case.trajectory(1).controls[3].n_y = 0.3;
    case.trajectory(1).states[3].speed_mps = 42.0;
    for (name, status) in [
        ("nodes.control_limits", Status::Fail),
        ("plan.control_limits", Status::Pass),
        ("nodes.state_limits", Status::Fail),
        ("plan.state_limits", Status::Pass),
    ] {
        assert_eq!(case.status(name), status, "{name}");
    }
}

#[test]
fn the_map_is_a_state_limit_of_nodes_plan_and_flight() {
    let mut case = Case::good();
    // The body has a radius of 1 m.
    case.scenario.world.map.y_m.max = 399.0;
    for name in ["nodes.state_limits", "plan.state_limits", "flight.state_limits"] {
        let check = case.check(name);
        assert_eq!((check.status, check.value, check.limit), (Status::Fail, Some(400.0), Some(398.0)));
        assert_eq!(check.between, ["uav-3"]);
    }
}

/// 3 m of 200 m are less than 2 m/s of 10 m/s.
#[test]
fn the_limit_named_is_the_one_of_which_most_is_used() {
    let mut case = Case::good();
    case.trajectory(0).states[4].z_m = 497.0;
    case.trajectory(1).states[4].speed_mps = 38.0;
    let check = case.check("nodes.state_limits");
    assert_eq!((check.value, check.unit.as_str(), check.status), (Some(497.0), "m", Status::Pass));
    assert_eq!(check.between, ["uav-1"]);
}

#[test]
fn a_climb_too_steep_is_seen_in_plan_and_flight() {
    for (climb_deg, status) in [(10.001_f64, Status::Fail), (9.999, Status::Pass)] {
        let mut case = Case::good();
        case.trajectory(0).states[3].flight_path_rad = climb_deg.to_radians();
        // With n_z = 1 the climb would keep steepening after the node.
        case.trajectory(0).controls[3].n_z = 0.9;
        let (sin, cos) = climb_deg.to_radians().sin_cos();
        case.samples(0)[600].velocity_mps = [35.0 * cos, 0.0, -35.0 * sin];
        assert_eq!(case.status("plan.state_limits"), status);
        assert_eq!(case.status("flight.state_limits"), status);
    }
}

#[test]
fn tracking_counts_while_the_plan_lasts() {
    let mut case = Case::good();
    for sample in case.samples(1) {
        sample.position_m[0] -= 10.0;
        sample.reference_position_m = sample.position_m;
    }
    // It arrives 0.29 s late; it is judged until then, although its plan has ended.
    case.samples(1)[2010].reference_position_m[0] += 6.0;
    assert_eq!(case.status("flight.tracking_max"), Status::Pass);
    case.samples(1)[1990].reference_position_m[0] += 6.0;
    assert_eq!(case.status("flight.tracking_max"), Status::Fail);
}

#[test]
fn what_happens_while_coasting_after_the_arrival_does_not_count() {
    let mut case = Case::good();
    case.scenario.world.map.x_m.max = 705.0;
    assert_eq!(case.judge().outcome, Outcome::Pass);
    // A vehicle that arrives late is judged until it arrives.
    for sample in case.samples(1) {
        sample.position_m[0] -= 10.0;
    }
    case.samples(1).iter_mut().filter(|sample| sample.t_s > 20.1).for_each(|sample| factors(sample).control.n_y = 0.9);
    assert_eq!(case.status("flight.control_limits"), Status::Fail);
}

#[test]
fn a_verdict_survives_json() {
    let mut case = Case::good();
    case.samples(0)[3].wind_mps[0] = f64::NAN;
    let verdict = case.judge();
    let text = serde_json::to_string(&verdict).unwrap();
    let read: Verdict = serde_json::from_str(&text).unwrap();
    assert_eq!(serde_json::to_string(&read).unwrap(), text);
    // Everything except the key of the limit, which is not in the JSON.
    let mut verdict = verdict;
    verdict.checks.iter_mut().for_each(|check| check.limit_key = None);
    assert_eq!(read, verdict);
}

#[test]
fn the_figures_of_the_straight_fleet_are_known() {
    let mut case = Case::good();
    case.trajectory(0).controls[2] = scenarios::fixed_wing::Control { n_x: -0.1, n_y: 0.05, n_z: 0.98 };
    case.trajectory(1).controls[2].n_y = -0.05;
    let metrics = measure(&case.scenario, &case.plan, case.flight.as_ref());
    let (plan, flight) = (metrics.plan.clone().unwrap(), metrics.flight.clone().unwrap());
    let close = |measured: Option<f64>, wanted: f64| assert!((measured.unwrap() - wanted).abs() < 1e-6, "{measured:?}");
    close(plan.flight_time_s, 20.0);
    close(plan.mean_speed_mps, 35.0);
    close(plan.speed_std_mps, 0.0);
    close(plan.sum_abs_n_x, 0.1);
    close(plan.sum_abs_n_y, 0.1);
    close(plan.sum_abs_n_z_minus_1, 0.02);
    close(plan.at_nodes.separation_m, 200.0);
    close(plan.at_nodes.clearance_m, 99.0);
    close(flight.flight_time_s, 20.0);
    close(flight.mean_speed_mps, 35.0);
    close(flight.altitude_std_m, 0.0);
    close(flight.tracking_max_m, 0.0);
    close(flight.saturation, 0.0);
    close(flight.distances.separation_m, 200.0);
    close(flight.distances.clearance_m, 99.0);
    let text = serde_json::to_string(&metrics).unwrap();
    assert_eq!(serde_json::from_str::<Metrics>(&text).unwrap(), metrics);
}

#[test]
fn a_standard_deviation_is_that_of_the_population() {
    let mut case = Case::straight(&[0.0], 0.01);
    for (node, state) in case.trajectory(0).states.iter_mut().enumerate().skip(1) {
        state.speed_mps += if node % 2 == 0 { 1.0 } else { -1.0 };
    }
    let plan = measure(&case.scenario, &case.plan, None).plan.unwrap();
    assert!((plan.speed_std_mps.unwrap() - (10.0_f64 / 11.0).sqrt()).abs() < 1e-12);
}

#[test]
fn a_broken_plan_has_no_figures() {
    let mut case = Case::good();
    case.trajectory(0).states[3].x_m = f64::NAN;
    assert_eq!(measure(&case.scenario, &case.plan, case.flight.as_ref()), Metrics::default());
}

#[test]
fn distances_over_time_agree_with_the_verdict() {
    let mut case = Case::good();
    for sample in case.samples(1) {
        sample.position_m[1] -= 2.0 * sample.t_s;
        sample.velocity_mps[1] = -2.0;
    }
    let flown = FlownMotions::new(&case.scenario, &case.plan, case.flight.as_ref().unwrap()).unwrap();
    let separation = separation_over_time(&flown.motions, SeparationMeasure::Horizontal, 0.5);
    assert_eq!(separation.len(), 41);
    for nearest in &separation {
        let apart_m = 200.0 - 2.0 * nearest.t_s;
        assert!((nearest.distance_m - apart_m).abs() < 1e-9 && nearest.who == [0, 1], "{nearest:?}");
    }
    let clearance = clearance_over_time(&case.scenario, &flown.motions, 0.5);
    let smallest = clearance.iter().map(|nearest| nearest.distance_m).fold(f64::INFINITY, f64::min);
    assert!((smallest - case.check("flight.clearance").value.unwrap()).abs() < 1e-6);
}

/// At 20 s it is at 700 m. The others are in the map and clear of the obstacles all the time.
#[test]
fn an_aircraft_that_has_arrived_stays_clear_of_obstacles_on_the_map_and_out_of_geofences_until_all_have() {
    let y_m = Case::good().with_early_arrival().scenario.vehicles[0].start.y_m;
    let broken = |change: &dyn Fn(&mut scenarios::Scenario), names: [&str; 2]| {
        let mut case = Case::good().with_early_arrival();
        assert!(names.map(|name| case.check(name).status).iter().all(|status| *status == Status::Pass));
        change(&mut case.scenario);
        for check in names.map(|name| case.check(name)) {
            assert_eq!(check.status, Status::Fail, "{check:#?}");
            assert!(check.between.contains(&case.scenario.vehicles[0].name), "{check:#?}");
            assert!(check.at_s.unwrap() > 10.0, "{check:#?}");
        }
    };
    let pillar = Cylinder { name: "mast".into(), center_m: [600.0, y_m], radius_m: 10.0 };
    broken(&|it| it.world.cylinders.push(pillar.clone()), ["plan.clearance", "flight.clearance"]);
    let states = ["plan.state_limits", "flight.state_limits"];
    let polygon_m = vec![[500.0, y_m - 50.0], [600.0, y_m - 50.0], [600.0, y_m + 50.0], [500.0, y_m + 50.0]];
    let fence =
        Geofence { name: "town".into(), kind: GeofenceKind::KeepOut, polygon_m, rings_m: Vec::new(), z_m: None };
    broken(&|it| it.world.geofences.push(fence.clone()), states);
    let asked = |scenario: &mut scenarios::Scenario| {
        let name = scenario.vehicles[0].name.clone();
        scenario.requirements.push(scenarios::requirement::Requirement {
            name: "early".into(),
            formula: format!("always distance({name}, point(700 m, {y_m} m, 400 m)) > 100 m"),
            description: String::new(),
            advisory: false,
            applies_to: scenarios::requirement::AppliesTo::Both,
        });
    };
    let mut case = Case::good().with_early_arrival();
    asked(&mut case.scenario);
    for name in ["plan.requirement.early", "flight.requirement.early"] {
        let check = check(&case.judge(), name);
        assert_eq!(check.status, Status::Fail, "{check:#?}");
        assert!((check.value.unwrap() + 100.0).abs() < 0.5, "{check:#?}");
    }
}

/// The first aircraft arrives after 10 s, 20° to the north of its course, and would fly on towards the second one, which is
/// under way for 10 s more.
#[test]
fn an_aircraft_that_has_arrived_counts_for_the_separation_until_all_have() {
    let arriving = |heading_deg: f64| {
        let mut case = Case::good().with_early_arrival();
        let trajectory = case.trajectory(0);
        trajectory.states[4].heading_rad = heading_deg.to_radians();
        let north_mps = SPEED_MPS * heading_deg.to_radians().tan();
        for sample in case.samples(0).iter_mut().filter(|sample| sample.t_s > 10.0) {
            sample.position_m[1] += north_mps * (sample.t_s - 10.0);
            sample.velocity_mps[1] += north_mps;
        }
        case
    };
    let (straight, turned) = (arriving(0.0), arriving(20.0));
    for (name, after_s) in [("plan.separation", 12.0), ("flight.separation", 10.0)] {
        assert_eq!(straight.check(name).status, Status::Pass, "{name}");
        let check = turned.check(name);
        assert_eq!(check.status, Status::Fail, "{check:#?}");
        assert!((check.at_s.unwrap() - 20.0).abs() < 0.02, "{check:#?}");
        let (north_m, behind_m) = match name {
            "plan.separation" => {
                (35.0 * 20_f64.to_radians().sin() * after_s, 35.0 * (1.0 - 20_f64.to_radians().cos()) * after_s)
            }
            _ => (35.0 * 20_f64.to_radians().tan() * after_s, 0.0),
        };
        assert!((check.value.unwrap() - (200.0 - north_m).hypot(behind_m)).abs() < 0.3, "{check:#?}");
    }
}
