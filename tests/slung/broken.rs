//! Invalid plans and flights of slung loads, and motions that cheat between the nodes.

use harness::verdict::{Outcome, Status};
use scenarios::slung_load::Cable;
use scenarios::{Prism, Range};
use sim::{Event, EventKind};

use crate::case::Case;

type Break = (&'static str, fn(&mut Case), &'static str);

/// Ways to cheat, each with the check that detects it.
const BREAKS: &[Break] = &[
    ("a state missing", |case| case.trajectory().states.truncate(600), "plan.complete"),
    ("a cable mode missing", |case| case.trajectory().cable.truncate(600), "plan.complete"),
    ("time goes back", |case| case.trajectory().times_s[9] = 0.0, "plan.complete"),
    ("another load at the start", |case| case.trajectory().states[0].load_position_m[0] += 0.02, "plan.complete"),
    ("NaN in a state", |case| case.trajectory().states[9].load_velocity_mps[1] = f64::NAN, "plan.finite"),
    ("NaN in a thrust", |case| case.trajectory().controls[9].thrust_n[1] = f64::NAN, "plan.finite"),
    ("a taut cable called slack", |case| case.trajectory().cable.fill(Cable::Slack), "plan.dynamics"),
    ("a jump of velocity", |case| jump(case, 0.2), "plan.dynamics"),
    (
        "thrusts of another motion",
        |case| case.trajectory().controls.iter_mut().for_each(|u| u.thrust_n = [3.7; 4]),
        "plan.dynamics",
    ),
    ("no flight", |case| case.flight = None, "flight.complete"),
    ("NaN in a load", |case| case.loads()[9].position_m[0] = f64::NAN, "flight.clearance"),
    ("NaN in a tension", |case| case.loads()[9].tension_n = f64::NAN, "flight.tension"),
    ("no attitude", |case| case.samples()[9].world_from_body = [0.0; 4], "flight.clearance"),
    ("loads missing", |case| case.loads().clear(), "flight.swing"),
    ("a switch that was not planned", |case| case.flight().events.push(slack(1.0)), "flight.slack"),
];

/// At one node, and only there, everything moves faster: densely sampled plans must not hide it.
fn jump(case: &mut Case, by_mps: f64) {
    for state in &mut case.trajectory().states[300..=300] {
        state.velocity_mps[2] += by_mps;
        state.load_velocity_mps[2] += by_mps;
    }
}

fn slack(t_s: f64) -> Event {
    Event { t_s, kind: EventKind::CableSlack, vehicles: vec!["quad-1".to_owned()] }
}

#[test]
fn what_is_not_whole_or_not_true_fails() {
    for (what, spoil, check) in BREAKS {
        let mut case = Case::good();
        spoil(&mut case);
        assert_ne!(case.judge().outcome, Outcome::Pass, "{what}");
        assert_eq!(case.status(check), Status::Fail, "{what}: {:?}", case.check(check));
    }
}

#[test]
fn an_impact_that_is_left_out_is_missed() {
    let mut case = Case::caught();
    // As if the cable had not pulled: the velocities before the impact are kept after it.
    case.trajectory().states[2] = case.trajectory().states[1];
    assert_eq!(case.status("plan.dynamics"), Status::Fail);
    let mut case = Case::caught();
    case.flight().events.clear();
    assert_eq!(case.status("flight.slack"), Status::Fail);
}

/// A needle that only the cable or only the load touches, for a few milliseconds.
#[test]
fn what_is_cut_between_two_samples_is_found() {
    let mut case = Case::good();
    // Samples every 0.3 s are a legal log at a step of 0.3 s.
    case.scenario.simulation.step_s = 0.3;
    case.flight().step_s = 0.3;
    let thin = |log: &mut sim::VehicleLog| {
        log.samples = log.samples.iter().step_by(150).copied().collect();
        log.loads = log.loads.iter().step_by(150).copied().collect();
    };
    thin(&mut case.flight().vehicles[0]);
    let middle = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| f64::midpoint(a[i], b[i])) };
    let load = middle(case.loads()[9].position_m, case.loads()[10].position_m);
    let cable = middle(load, middle(case.samples()[9].position_m, case.samples()[10].position_m));
    for (place, part) in [(load, "load"), (cable, "cable")] {
        let mut case = case.clone();
        let half_m = 0.025;
        let corners = [[-half_m, -half_m], [half_m, -half_m], [half_m, half_m], [-half_m, half_m]];
        let corners_m = corners.map(|[x, y]| [place[0] + x, place[1] + y]).to_vec();
        let z_m = Some(Range::new(place[2] - 0.02, place[2] + 0.02));
        case.scenario.world.prisms.push(Prism { name: "needle".into(), corners_m, z_m });
        let check = case.check("flight.clearance");
        assert_eq!(check.status, Status::Fail, "{check:?}");
        assert!(check.reason.as_ref().is_some_and(|reason| reason.contains(part)), "{check:?}");
        for step in [9, 10] {
            let far = case.loads()[step].position_m.iter().zip(place).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
            assert!(far > 0.1, "the samples themselves stay clear");
        }
    }
}

#[test]
fn a_cable_that_would_have_to_push_fails() {
    let mut case = Case::good();
    // Rotors that stop let everything fall; a "taut" cable then holds the load back by pushing at a falling quadrotor.
    for control in &mut case.trajectory().controls[300..310] {
        control.thrust_n = [-3.0; 4];
    }
    let check = case.check("plan.tension");
    assert_eq!(check.status, Status::Fail, "{check:?}");
    assert!(check.reason.is_some_and(|reason| reason.contains("push")));
}

#[test]
fn angles_a_full_turn_apart_are_the_same() {
    for turns in [-2.0, -1.0, 1.0, 3.0] {
        for axis in 0..3 {
            let mut case = Case::good();
            case.trajectory().states[0].roll_pitch_yaw_rad[axis] += turns * std::f64::consts::TAU;
            assert_eq!(case.judge().outcome, Outcome::Pass, "{turns} turns about axis {axis}");
        }
    }
    let mut case = Case::good();
    case.trajectory().states[0].roll_pitch_yaw_rad[0] += 0.011;
    assert_eq!(case.status("plan.complete"), Status::Fail);
}

/// The load of the good flight begins with its lowest point at 0.62 m; the body stays above 1 m.
#[test]
fn a_load_may_lie_on_the_ground_and_not_be_in_it() {
    for (ground_m, status) in [(0.6195, Status::Pass), (0.6205, Status::Pass), (0.622, Status::Fail)] {
        let mut case = Case::good();
        case.scenario.world.ground_m = Some(ground_m);
        for name in ["nodes.clearance", "plan.clearance", "flight.clearance"] {
            let check = case.check(name);
            assert_eq!(check.status, status, "{ground_m}: {check:#?}");
            assert_eq!(check.between.last().is_some_and(|name| name == "ground"), status == Status::Fail);
        }
    }
}

/// Deep in an obstacle the motion between the nodes is no farther from it than the nodes.
#[test]
fn between_the_nodes_is_never_better_than_at_them() {
    for (south_m, z_m) in
        [(0.6, None), (1.0, None), (0.8, Some(Range::new(-1.0, 1.6))), (1.2, Some(Range::new(0.9, 1.2)))]
    {
        let mut case = Case::good();
        let wall = &mut case.scenario.world.boxes[0];
        (wall.center_m[1], wall.z_m) = (-south_m, z_m);
        let [nodes, plan] = ["nodes.clearance", "plan.clearance"].map(|name| case.check(name));
        assert_eq!((nodes.status, plan.status), (Status::Fail, Status::Fail));
        assert!(plan.value.unwrap() <= nodes.value.unwrap(), "{plan:#?} {nodes:#?}");
    }
}
