//! Events between two samples or two nodes are detected, and none is invented.

use harness::verdict::Status;
use scenarios::Cylinder;

use crate::fleet::{Case, END_S, SPEED_MPS, sample};

fn pillar(x_m: f64, y_m: f64, radius_m: f64) -> Cylinder {
    Cylinder { name: "needle".to_owned(), center_m: [x_m, y_m], radius_m }
}

/// Samples are 0.35 m apart; the needle stands between the two at 3.50 m and 3.85 m. The body reaches 1 m to the side.
#[test]
fn a_needle_between_two_samples_is_hit() {
    for (y_m, status) in [(0.0, Status::Fail), (1.049, Status::Fail), (1.051, Status::Pass)] {
        let mut case = Case::good();
        case.scenario.world.cylinders = vec![pillar(3.675, y_m, 0.05)];
        assert_eq!(case.status("flight.clearance"), status, "needle at {y_m} m");
        assert_eq!(case.status("plan.clearance"), status, "needle at {y_m} m");
        assert_eq!(case.status("nodes.clearance"), Status::Pass);
    }
}

/// Reverses the second aircraft, so that the two meet head-on, `offset_m` to the side.
fn head_on(offset_m: f64) -> Case {
    let mut case = Case::straight(&[0.0, offset_m], 0.01);
    let length_m = SPEED_MPS * END_S;
    let vehicle = &mut case.scenario.vehicles[1];
    std::mem::swap(&mut vehicle.start, &mut vehicle.goal);
    (vehicle.start.heading_deg, vehicle.goal.heading_deg) = (180.0, 180.0);
    for state in &mut case.trajectory(1).states {
        state.x_m = length_m - state.x_m;
        state.heading_rad = std::f64::consts::PI;
    }
    for sample in case.samples(1) {
        sample.position_m[0] = length_m - sample.position_m[0];
        sample.reference_position_m = sample.position_m;
        sample.velocity_mps[0] = -SPEED_MPS;
    }
    case
}

/// They pass in the middle between the nodes at 4 s and 16 s, where they are 420 m apart.
#[test]
fn meeting_head_on_between_the_nodes_is_seen() {
    for (offset_m, status) in [(0.0, Status::Fail), (99.999, Status::Fail), (100.001, Status::Pass)] {
        let mut case = head_on(offset_m);
        for vehicle in 0..2 {
            let trajectory = case.trajectory(vehicle);
            for node in [9, 7, 6, 5, 4, 3, 1] {
                trajectory.times_s.remove(node);
                trajectory.states.remove(node);
                trajectory.controls.remove(node);
            }
        }
        // Nodes at 0, 4, 16 and 20 s; they meet at 10 s.
        assert_eq!(case.trajectory(0).times_s, [0.0, 4.0, 16.0, 20.0]);
        case.scenario.world.cylinders.clear();
        assert_eq!(case.status("nodes.separation"), Status::Pass);
        for name in ["plan.separation", "flight.separation"] {
            let check = case.check(name);
            assert_eq!(check.status, status, "{check:#?}");
            assert!((check.at_s.unwrap() - 10.0).abs() < 1e-4 && (check.value.unwrap() - offset_m).abs() < 1e-6);
        }
    }
}

/// Two aircraft meet between two samples, between which they close by 0.7 m; the required separation is centimetres.
#[test]
fn meeting_head_on_between_two_samples_is_seen() {
    for (offset_m, status) in [(0.049, Status::Fail), (0.051, Status::Pass)] {
        let mut case = head_on(offset_m);
        case.scenario.fleet.separation_m = Some(0.05);
        for sample in case.samples(1) {
            sample.position_m[0] += 0.3;
        }
        assert_eq!(case.status("flight.separation"), status, "{offset_m} m aside");
    }
}

/// A flight on a circle of 125 m, logged once per second: between two samples the arc bulges 1.2 m beyond the chord.
fn circling(needle: Cylinder) -> Case {
    let mut case = Case::straight(&[0.0], 1.0);
    let (radius_m, rate_radps) = (125.0, SPEED_MPS / 125.0);
    case.scenario.world.cylinders = vec![needle];
    case.scenario.models.fixed_wing.get_mut("paper").unwrap().body_radius_m = 0.1;
    for step in 0..=22 {
        let t_s = f64::from(step);
        let (sin, cos) = (rate_radps * t_s).sin_cos();
        let position_m = [radius_m * sin, radius_m - radius_m * cos, 400.0];
        case.samples(0)[step as usize] = sample(t_s, position_m, [SPEED_MPS * cos, SPEED_MPS * sin, 0.0]);
    }
    case
}

/// The needle stands at the middle of the arc from 5 s to 6 s, `outside_m` outside of it; needle and body are 0.3 m wide.
fn needle_beside_the_arc(outside_m: f64) -> Cylinder {
    let (sin, cos) = (SPEED_MPS / 125.0 * 5.5).sin_cos();
    let distance_m = 125.0 + outside_m;
    pillar(distance_m * sin, 125.0 - distance_m * cos, 0.2)
}

#[test]
fn an_arc_hits_what_its_chord_clears() {
    assert_eq!(circling(needle_beside_the_arc(0.2)).status("flight.clearance"), Status::Fail);
    assert_eq!(circling(needle_beside_the_arc(0.31)).status("flight.clearance"), Status::Pass);
}

#[test]
fn an_arc_clears_what_its_chord_hits() {
    assert_eq!(circling(needle_beside_the_arc(-1.2)).status("flight.clearance"), Status::Pass);
    assert_eq!(circling(needle_beside_the_arc(-0.31)).status("flight.clearance"), Status::Pass);
    assert_eq!(circling(needle_beside_the_arc(-0.29)).status("flight.clearance"), Status::Fail);
}

/// n_z swings from 1.2 to 0.8 and back between two pairs of nodes that are level: the aircraft climbs in between.
#[test]
fn a_climb_between_level_nodes_breaks_the_altitude_limit_of_the_plan_only() {
    let mut case = Case::good();
    case.scenario.models.fixed_wing.get_mut("paper").unwrap().limits.altitude_m.max = 400.5;
    case.scenario.models.fixed_wing.get_mut("paper").unwrap().planning_limits.altitude_m.max = 400.5;
    (case.trajectory(0).controls[4].n_z, case.trajectory(0).controls[5].n_z) = (1.2, 0.8);
    assert_eq!(case.status("nodes.state_limits"), Status::Pass);
    let check = case.check("plan.state_limits");
    assert_eq!((check.status, check.limit), (Status::Fail, Some(400.5)), "{check:#?}");
}

/// Aircraft do not vanish at their goals: one that has arrived flies on, and the others have to keep away from it.
#[test]
fn an_arrived_vehicle_counts_for_separation_until_the_others_have_arrived() {
    // The first arrives after 10 s; the second flies through it at 12 s.
    let mut case = Case::straight(&[0.0, 200.0], 0.01).with_early_arrival();
    for sample in case.samples(1).iter_mut().filter(|sample| sample.t_s > 12.0) {
        sample.position_m[1] = 0.0;
    }
    assert_eq!(case.status("flight.separation"), Status::Fail);
    assert_eq!(case.status("plan.separation"), Status::Pass);
}

/// What cannot be judged of the time after an arrival is no separation.
#[test]
fn a_log_without_numbers_after_an_arrival_does_not_pass_for_separation() {
    let mut case = Case::straight(&[0.0, 200.0], 0.01).with_early_arrival();
    assert_eq!(case.status("flight.separation"), Status::Pass);
    for sample in case.samples(0).iter_mut().filter(|sample| (14.0..15.0).contains(&sample.t_s)) {
        sample.position_m[1] = f64::NAN;
    }
    assert_eq!(case.status("flight.separation"), Status::Fail);
}
