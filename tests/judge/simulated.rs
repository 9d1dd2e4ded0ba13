//! The judge and the simulator together.

use harness::verdict::{Outcome, Status};
use scenarios::Wind;

use crate::fleet::Case;

fn flown(prepare: fn(&mut Case)) -> Case {
    let mut case = Case::good();
    prepare(&mut case);
    case.flight = Some(sim::fly(&case.scenario, &case.plan, 0, &mut |_| {}));
    case
}

#[test]
fn the_good_plan_passes_when_it_is_really_flown() {
    let case = flown(|_| {});
    let verdict = case.judge();
    assert_eq!(verdict.outcome, Outcome::Pass, "{verdict:#?}");
    assert!(case.check("flight.tracking_max").value.is_some_and(|error_m| error_m < 1e-6));
    assert!((case.check("flight.separation").value.unwrap() - 200.0).abs() < 1e-6);
}

/// 35 m/s over ground across a wind of 30 m/s are 46 m/s through the air, of which 45 are allowed.
#[test]
fn the_limits_are_those_of_the_airspeed() {
    let case = flown(|case| {
        case.scenario.simulation.wind = Some(Wind { mean_mps: [0.0, 30.0, 0.0], gusts: None, pulses: vec![] });
    });
    let check = case.check("flight.state_limits");
    assert_eq!((check.status, check.limit, check.unit.as_str()), (Status::Fail, Some(45.0), "m/s"));
    assert!(check.value.is_some_and(|speed_mps| speed_mps >= 35.0_f64.hypot(30.0) - 1e-9));
}

/// The airframe touches while its centre is still outside, and the log ends within a step of 0.35 m.
#[test]
fn a_flight_into_the_pillar_crashes() {
    let case = flown(|case| case.scenario.world.cylinders[0].center_m = [350.0, -399.0]);
    for name in
        ["plan.clearance", "flight.clearance", "flight.crash", "flight.complete", "flight.goal", "flight.arrival"]
    {
        assert_eq!(case.status(name), Status::Fail, "{name}");
    }
    assert_eq!(case.check("flight.crash").between, ["uav-1", "pillar"]);
    let clearance_m = case.check("flight.clearance").value.unwrap();
    assert!(clearance_m <= 0.0 && clearance_m > -0.35, "{clearance_m}");
}
