//! The guard answers as the judge does, without allocating.

mod candidates;

use candidates::{candidate, scenario};
use harness::guard::{Guard, GuardError, Knot};
use harness::verdict::{self, KnotDefect, Status};
use scenarios::in_loop::Node;
use scenarios::multirotor::Trajectory;
use scenarios::{Plan, Scenario};

/// Bounds of the guard's clearance are this far apart, relative to the clearance, and 1e-4 m at least.
const RESOLUTION: f64 = 0.05;

fn guard(scenario: &Scenario) -> Guard {
    Guard::new(scenario, &scenario.vehicles[0].name).expect("a guard")
}

/// The judge's verdict on the plan with these knots, which starts where the vehicle does.
fn judged(scenario: &Scenario, knots: &[Knot]) -> verdict::Verdict {
    let mut scenario = scenario.clone();
    let [x_m, y_m, z_m] = knots[0].position_m;
    let start = &mut scenario.vehicles[0].start;
    (start.x_m, start.y_m, start.z_m) = (x_m, y_m, z_m);
    let node = |knot: &Knot| Node { t_s: knot.t_s, position_m: knot.position_m, velocity_mps: knot.velocity_mps };
    let nodes: Vec<Node> = knots.iter().map(node).collect();
    let trajectory = Trajectory::through(&scenario.vehicles[0].name, &nodes);
    verdict::judge(&scenario, &Plan::new(&scenario.name, "test", 0, vec![trajectory.into()]), None)
}

#[test]
fn the_guard_answers_as_the_judge_does() {
    let scenario = scenario();
    let mut guard = guard(&scenario);
    let mut statuses = Vec::new();
    for seed in 0..200 {
        let knots = candidate(seed);
        let assessment = guard.judge(&knots, None);
        let verdict = judged(&scenario, &knots);
        for name in ["plan.state_limits", "plan.control_limits", "plan.rest"] {
            let (own, judges) = (assessment.check(name).unwrap(), verdict.check(name).unwrap());
            assert_eq!((own.status, Some(own.value)), (judges.status, judges.value), "{seed}: {name}");
        }
        let (own, judges) = (assessment.check("plan.clearance").unwrap(), verdict.check("plan.clearance").unwrap());
        let (lower_m, upper_m) = (judges.lower.unwrap(), judges.upper.unwrap());
        assert!(
            own.value <= upper_m && own.value >= lower_m - (RESOLUTION * upper_m.abs()).max(1e-4),
            "{seed}: {own:?}"
        );
        assert!(own.status == judges.status || own.status == Status::Undecided, "{seed}: {own:?}, {judges:?}");
        statuses.push(own.status);
    }
    let count = |wanted| statuses.iter().filter(|status| **status == wanted).count();
    assert!(count(Status::Pass) > 20 && count(Status::Fail) > 20, "both sides are tried: {statuses:?}");
    assert!(count(Status::Undecided) <= 2, "{statuses:?}");
}

/// A straight flight at rest in the beginning and in the end, 2 m long, in the lane beside the first row.
fn straight(y_m: f64) -> Vec<Knot> {
    let knot =
        |t_s: f64, x_m: f64, vx_mps: f64| Knot { t_s, position_m: [x_m, y_m, 2.0], velocity_mps: [vx_mps, 0.0, 0.0] };
    vec![knot(0.0, 8.0, 0.0), knot(2.0, 9.0, 0.75), knot(4.0, 10.0, 0.0)]
}

#[test]
fn each_check_fails_on_its_own_fault() {
    let scenario = scenario();
    let mut guard = guard(&scenario);
    let good = straight(7.75);
    let assessment = guard.judge(&good, Some(&good[0]));
    assert_eq!(assessment.status, Status::Pass, "{assessment:?}");
    let mut fails = |name: &str, knots: &[Knot], measured: &Knot| {
        let assessment = guard.judge(knots, Some(measured));
        assert_eq!(assessment.status, Status::Fail, "{name}");
        let failed = assessment.margins.iter().filter(|margin| margin.status == Status::Fail);
        assert_eq!(failed.map(|margin| margin.check).collect::<Vec<_>>(), [name], "{assessment:?}");
        assert!(assessment.check(name).unwrap().margin < 0.0, "{assessment:?}");
    };
    let tracking_max_m = scenario.limits().tracking_max_m;
    let mut away = good[0];
    away.position_m[1] += tracking_max_m * 1.01;
    fails("start.position", &good, &away);
    let mut moving = good[0];
    moving.velocity_mps[1] = 100.0;
    fails("start.velocity", &good, &moving);
    let mut through_a_prism = good.clone();
    through_a_prism.iter_mut().for_each(|knot| knot.position_m[1] = 4.0);
    through_a_prism.iter_mut().for_each(|knot| knot.position_m[0] += 3.0);
    fails("plan.clearance", &through_a_prism, &through_a_prism[0]);
    let in_a_thousandth = |knot: &Knot| Knot {
        t_s: knot.t_s / 1e3,
        velocity_mps: knot.velocity_mps.map(|component| component * 1e3),
        ..*knot
    };
    let rushing: Vec<Knot> = good.iter().map(in_a_thousandth).collect();
    let mut jumping = good.clone();
    jumping.insert(1, Knot { t_s: 2.0, position_m: [9.0, 7.8, 2.0], velocity_mps: [0.75, 0.0, 0.0] });
    let mut fails = |name: &str, knots: &[Knot]| {
        let assessment = guard.judge(knots, Some(&knots[0]));
        assert_eq!(assessment.check(name).unwrap().status, Status::Fail, "{assessment:?}");
    };
    fails("plan.state_limits", &rushing);
    fails("plan.control_limits", &jumping);
    let mut in_motion = good.clone();
    in_motion[2].velocity_mps[0] = 0.5;
    fails("plan.rest", &in_motion);
}

#[test]
fn what_is_no_motion_fails() {
    let scenario = scenario();
    let mut guard = guard(&scenario);
    let good = straight(7.75);
    assert_eq!(guard.judge(&[], None).defect, Some(KnotDefect::TooFew(0)));
    assert_eq!(guard.judge(&good[..1], None).defect, Some(KnotDefect::TooFew(1)));
    for bad in [f64::NAN, f64::INFINITY, 1e12] {
        let mut knots = good.clone();
        knots[1].position_m[2] = bad;
        let assessment = guard.judge(&knots, None);
        assert_eq!((assessment.status, assessment.defect), (Status::Fail, Some(KnotDefect::OutOfRange(2.0))));
        assert!(assessment.margins.iter().all(|margin| margin.status == Status::Fail));
    }
    let reversed: Vec<Knot> = good.iter().rev().copied().collect();
    assert_eq!(guard.judge(&reversed, None).defect, Some(KnotDefect::DecreasingTime(4.0)));
    // A measured state at another time, or one that is no number, is not continued.
    for measured in [Knot { t_s: 9.0, ..good[0] }, Knot { position_m: [f64::NAN; 3], ..good[0] }] {
        let assessment = guard.judge(&good, Some(&measured));
        assert_eq!(assessment.check("start.position").unwrap().status, Status::Fail, "{measured:?}");
    }
}

#[test]
fn the_obstacles_known_now_decide() {
    let scenario = scenario();
    let mut guard = guard(&scenario);
    let mut through = straight(4.0);
    through.iter_mut().for_each(|knot| knot.position_m[0] += 3.0);
    let assessment = guard.judge(&through, None);
    assert_eq!(assessment.status, Status::Fail);
    let hit = assessment.check("plan.clearance").unwrap().obstacle;
    assert_eq!(guard.obstacle_name(hit), "prism-1");
    guard.set_world(&scenario.world.with_static_obstacles(|name| name != "prism-1"));
    assert_eq!(guard.judge(&through, None).status, Status::Pass);
}

#[test]
fn there_is_a_guard_for_multirotors_only() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios");
    let fixed_wing = scenarios::load(&folder.join("fixed-wing/rendezvous-1.toml")).unwrap();
    assert!(matches!(Guard::new(&fixed_wing, "uav-1"), Err(GuardError::Family { .. })));
    let scenario = scenario();
    let error = Guard::new(&scenario, "uav-9").unwrap_err().to_string();
    assert!(error.contains("found no vehicle `uav-9`; did you mean `uav-1`?"), "{error}");
}

#[test]
fn a_guard_that_has_seen_a_candidate_allocates_nothing() {
    let scenario = scenario();
    let mut guard = guard(&scenario);
    let candidates: Vec<Vec<Knot>> = (0..40).map(candidate).collect();
    guard.judge(&candidates[0], None);
    let counted = allocation_counter::measure(|| {
        for knots in &candidates {
            guard.judge(knots, Some(&knots[0]));
        }
        guard.judge(&candidates[0][..1], None);
    });
    assert_eq!(counted.count_total, 0);
}
