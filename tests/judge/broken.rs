//! Invalid plans and flights never pass, and never make the judge panic.

use harness::verdict::{Outcome, Status};
use scenarios::PlanStatus;
use scenarios::fixed_wing::{Control, State, Trajectory};
use sim::Sample;

use crate::fleet::{Case, END_S, factors};

/// A description of the defect, and how it is made.
type Break = (&'static str, fn(&mut Case));

const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

fn assert_fails(case: &Case, check: &str, what: &str) {
    let verdict = case.judge();
    assert_ne!(verdict.outcome, Outcome::Pass, "{what}");
    assert_eq!(case.status(check), Status::Fail, "{what}");
}

#[test]
fn a_number_that_is_not_finite_fails_wherever_a_plan_holds_it() {
    for bad in BAD {
        for node in [0, 5, 10] {
            for field in 0..10 {
                let mut case = Case::good();
                let trajectory = case.trajectory(1);
                let mut state = trajectory.states[node].to_array();
                let mut control = trajectory.controls[node].to_array();
                match field {
                    0..6 => state[field] = bad,
                    6..9 => control[field - 6] = bad,
                    _ => trajectory.times_s[node] = bad,
                }
                trajectory.states[node] = State::from_array(state);
                trajectory.controls[node] = Control::from_array(control);
                let what = format!("{bad} in field {field} of node {node}");
                assert_fails(&case, "plan.finite", &what);
                assert_fails(&case, "plan.separation", &what);
                assert_fails(&case, "flight.separation", &what);
            }
        }
    }
}

#[test]
fn a_number_that_is_not_finite_fails_wherever_a_flight_holds_it() {
    type Field = fn(&mut Sample) -> &mut f64;
    let fields: [Field; 12] = [
        |sample| &mut sample.t_s,
        |sample| &mut sample.position_m[0],
        |sample| &mut sample.position_m[2],
        |sample| &mut sample.velocity_mps[1],
        |sample| &mut sample.wind_mps[0],
        |sample| &mut sample.world_from_body[3],
        |sample| &mut sample.measured_position_m[1],
        |sample| &mut sample.measured_velocity_mps[2],
        |sample| &mut sample.reference_position_m[0],
        |sample| &mut sample.reference_velocity_mps[0],
        |sample| &mut factors(sample).command.n_x,
        |sample| &mut factors(sample).control.n_z,
    ];
    for bad in BAD {
        for (index, field) in fields.iter().enumerate() {
            for step in [0, 1000, 2200] {
                let mut case = Case::good();
                *field(&mut case.samples(2)[step]) = bad;
                assert_fails(&case, "flight.finite", &format!("{bad} in field {index} of step {step}"));
            }
        }
    }
}

/// The checks that use a number fail by themselves, without relying on `flight.finite`.
#[test]
fn each_check_fails_of_itself_on_nan() {
    let nan = |spoil: fn(&mut Sample), checks: &[&str]| {
        let mut case = Case::good();
        spoil(&mut case.samples(0)[500]);
        for check in checks {
            assert_fails(&case, check, check);
        }
    };
    let motion = ["flight.separation", "flight.clearance", "flight.state_limits", "flight.goal", "flight.arrival"];
    nan(|sample| sample.position_m[1] = f64::NAN, &motion);
    nan(|sample| sample.velocity_mps[0] = f64::NAN, &motion);
    nan(|sample| sample.t_s = f64::NAN, &motion);
    nan(|sample| sample.wind_mps[1] = f64::NAN, &["flight.state_limits"]);
    nan(|sample| factors(sample).control.n_y = f64::NAN, &["flight.control_limits"]);
    nan(|sample| sample.reference_position_m[0] = f64::NAN, &["flight.tracking_max", "flight.tracking_rms"]);
}

#[test]
fn a_plan_that_is_not_whole_fails_every_check_that_applies() {
    let breaks: [Break; 12] = [
        ("missing vehicle", |case| {
            case.plan.trajectories.pop();
        }),
        ("one too many", |case| case.plan.trajectories.push(case.plan.trajectories[0].clone())),
        ("misnamed", |case| case.trajectory(1).vehicle = "uav-7".to_owned()),
        ("wrong order", |case| case.plan.trajectories.swap(0, 1)),
        ("empty", |case| clear(case.trajectory(1))),
        ("one node", |case| truncate(case.trajectory(1), 1)),
        ("a state missing", |case| {
            case.trajectory(1).states.pop();
        }),
        ("a control missing", |case| {
            case.trajectory(1).controls.pop();
        }),
        ("time goes back", |case| case.trajectory(1).times_s[4] = 5.0),
        ("time stands still", |case| case.trajectory(1).times_s[4] = 6.0),
        ("late first time", |case| case.trajectory(1).times_s[0] = 0.1),
        ("wrong start", |case| case.trajectory(1).states[0].x_m += 0.02),
    ];
    for (what, spoil) in breaks {
        let mut case = Case::good();
        spoil(&mut case);
        let verdict = case.judge();
        assert_eq!(verdict.outcome, Outcome::Fail, "{what}");
        assert!(verdict.overclaimed, "{what}");
        assert_fails(&case, "plan.complete", what);
        let passed: Vec<_> = verdict.checks.iter().filter(|check| check.status == Status::Pass).collect();
        assert!(passed.iter().all(|check| check.name == "plan.finite"), "{what}: {passed:?}");
    }
}

#[test]
fn a_start_in_another_direction_or_speed_is_no_start() {
    for spoil in [|state: &mut State| state.heading_rad += 0.01, |state: &mut State| state.speed_mps += 0.1] {
        let mut case = Case::good();
        spoil(&mut case.trajectory(0).states[0]);
        assert_fails(&case, "plan.complete", "start");
    }
    // A heading one full turn larger is the same direction.
    let mut case = Case::good();
    case.trajectory(0).states.iter_mut().for_each(|state| state.heading_rad += std::f64::consts::TAU);
    assert_eq!(case.judge().outcome, Outcome::Pass);
}

#[test]
fn a_flight_that_is_not_whole_fails() {
    let breaks: [Break; 12] = [
        ("missing vehicle", |case| {
            case.flight().vehicles.pop();
        }),
        ("one too many", |case| {
            let log = case.flight().vehicles[0].clone();
            case.flight().vehicles.push(log);
        }),
        ("misnamed", |case| case.flight().vehicles[1].vehicle = "uav-7".to_owned()),
        ("wrong order", |case| case.flight().vehicles.swap(0, 1)),
        ("empty", |case| case.samples(1).clear()),
        ("one sample", |case| case.samples(1).truncate(1)),
        ("short", |case| case.samples(1).truncate(1900)),
        ("time goes back", |case| case.samples(1)[50].t_s = 0.3),
        ("a sample twice", |case| {
            let twice = case.samples(1)[50];
            case.samples(1).insert(50, twice);
        }),
        ("a gap", |case| {
            case.samples(1).drain(700..703);
        }),
        ("late first time", |case| {
            case.samples(1).remove(0);
        }),
        ("wrong start", |case| case.samples(1)[0].position_m[1] += 6.0),
    ];
    for (what, spoil) in breaks {
        let mut case = Case::good();
        spoil(&mut case);
        assert_fails(&case, "flight.complete", what);
    }
}

#[test]
fn an_empty_log_leaves_no_flight_check_passed() {
    let mut case = Case::good();
    case.samples(0).clear();
    let passed: Vec<_> =
        case.judge().checks.into_iter().filter(|check| check.status == Status::Pass).map(|check| check.name).collect();
    let of_flight: Vec<_> = passed.iter().filter(|name| name.starts_with("flight.")).collect();
    assert_eq!(of_flight, ["flight.finite", "flight.crash"], "nothing else can be said");
}

#[test]
fn logs_of_other_vehicles_are_not_judged_in_their_place() {
    let mut case = Case::good();
    case.flight().vehicles.swap(0, 1);
    for check in ["flight.separation", "flight.goal", "flight.tracking_max", "flight.saturation"] {
        assert_fails(&case, check, "wrong order");
    }
}

#[test]
fn a_frozen_vehicle_fails() {
    let mut case = Case::good();
    for sample in case.samples(1) {
        sample.position_m = [0.0, 200.0, 400.0];
        sample.velocity_mps = [0.0; 3];
    }
    for check in ["flight.goal", "flight.tracking_max", "flight.tracking_rms", "flight.state_limits", "flight.arrival"]
    {
        assert_fails(&case, check, "frozen");
    }
}

#[test]
fn a_vehicle_still_on_its_way_when_the_log_ends_has_not_arrived() {
    let mut case = Case::good();
    // It covers 699.6 m until the log ends at 22 s: within the goal's 5 m, but not past it.
    for sample in case.samples(1) {
        sample.position_m[0] *= 699.6 / 770.0;
        sample.velocity_mps[0] *= 699.6 / 770.0;
    }
    let check = case.check("flight.arrival");
    assert_eq!(check.status, Status::Fail);
    assert!(check.reason.is_some_and(|reason| reason.contains("uav-2 has not arrived")));
}

/// It passes its goal after 5 s, long before its planned arrival, and flies on.
#[test]
fn passing_the_goal_on_the_way_is_no_arrival() {
    let mut case = Case::good();
    case.scenario.vehicles[1].goal.x_m = 175.0;
    let check = case.check("flight.goal");
    assert_eq!(check.status, Status::Fail);
    assert!((check.value.unwrap() - 175.0).abs() < 1e-6, "350 m at 10 s, when the window opens: {check:?}");
}

#[test]
fn a_crashed_vehicle_fails_for_its_crash_and_for_its_short_log() {
    let mut case = Case::good();
    case.samples(1).truncate(700);
    for check in ["flight.complete", "flight.goal", "flight.arrival"] {
        assert_fails(&case, check, "crashed");
    }
    assert_eq!(case.status("flight.separation"), Status::Pass, "until the crash it kept its distance");
}

#[test]
fn no_plan_is_no_plan() {
    let mut case = Case::good();
    (case.plan.status, case.flight) = (PlanStatus::NoPlan, None);
    case.plan.trajectories.clear();
    let verdict = case.judge();
    assert_eq!(verdict.outcome, Outcome::NoPlan);
    assert!(verdict.checks.iter().all(|check| matches!(check.status, Status::Fail | Status::Skip)));
    assert!(verdict.checks.iter().all(|check| check.reason.is_some()));
}

#[test]
fn a_plan_that_was_not_flown_fails_its_flight() {
    let mut case = Case::good();
    case.flight = None;
    let verdict = case.judge();
    assert_eq!(verdict.outcome, Outcome::Fail);
    for check in verdict.checks.iter().filter(|check| check.name.starts_with("flight.")) {
        assert!(matches!(check.status, Status::Fail | Status::Skip), "{check:?}");
    }
}

#[test]
fn a_plan_too_long_to_simulate_is_not_integrated() {
    let mut case = Case::good();
    case.trajectory(0).times_s[10] = 1e15;
    assert_fails(&case, "plan.duration", "long");
    assert_fails(&case, "plan.separation", "long");
}

#[test]
fn garbage_never_passes_and_never_panics() {
    const VALUES: [f64; 12] =
        [0.0, -0.0, 1.0, -1.0, 1e-300, 1e300, -1e300, f64::MAX, f64::NAN, f64::INFINITY, 1e9, 90.0];
    let mut dice = 12345_u64;
    let mut roll = |sides: usize| {
        dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (dice >> 33) as usize % sides
    };
    for round in 0..300 {
        let mut case = Case::good();
        for _ in 0..=roll(3) {
            let (vehicle, node, value) = (roll(3), roll(11), VALUES[roll(VALUES.len())]);
            let trajectory = case.trajectory(vehicle);
            match roll(6) {
                0 => trajectory.states[node] = State::from_array([value; 6]),
                1 => trajectory.states[node].speed_mps = value,
                2 => trajectory.controls[node] = Control::from_array([value; 3]),
                3 => trajectory.times_s[node] = value,
                4 => trajectory.states[node].flight_path_rad = value,
                _ => case.samples(vehicle)[node * 200].velocity_mps = [value; 3],
            }
        }
        let outcome = case.judge().outcome;
        assert!(outcome != Outcome::Pass || is_still_good(&case), "round {round}: {:#?}", case.plan);
    }
}

/// Some random changes only flip the sign of a zero or are small; such a plan may pass.
fn is_still_good(case: &Case) -> bool {
    let mild = |a: f64, b: f64| (a - b).abs() <= 0.2;
    let good = Case::good();
    case.plan.trajectories.iter().zip(&good.plan.trajectories).all(|(trajectory, wanted)| {
        let (trajectory, wanted) = (trajectory.fixed_wing(), wanted.fixed_wing());
        let states = trajectory.states.iter().zip(&wanted.states);
        let controls = trajectory.controls.iter().zip(&wanted.controls);
        states.flat_map(|(a, b)| a.to_array().into_iter().zip(b.to_array())).all(|(a, b)| mild(a, b))
            && controls.flat_map(|(a, b)| a.to_array().into_iter().zip(b.to_array())).all(|(a, b)| mild(a, b))
            && trajectory.times_s.iter().zip(&wanted.times_s).all(|(a, b)| mild(*a, *b))
    })
}

fn clear(trajectory: &mut Trajectory) {
    truncate(trajectory, 0);
}

fn truncate(trajectory: &mut Trajectory, nodes: usize) {
    trajectory.times_s.truncate(nodes);
    trajectory.states.truncate(nodes);
    trajectory.controls.truncate(nodes);
}

#[test]
fn a_short_plan_misses_its_goal() {
    let mut case = Case::good();
    truncate(case.trajectory(1), 9);
    for check in ["nodes.goal", "plan.goal", "plan.arrival"] {
        assert_fails(&case, check, "short");
    }
    assert!(case.trajectory(1).times_s.last().is_some_and(|&end_s| end_s < END_S));
}
