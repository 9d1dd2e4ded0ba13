//! Via-points: passed in their order, within their windows.

use harness::verdict::Status;
use scenarios::requirement::Requirement;
use scenarios::{Range, ViaPoint};

use crate::fleet::{Case, check};
use crate::requirements::requirement;

/// The first aircraft flies along y = 0 at 400 m and 35 m/s.
#[test]
fn via_points_are_passed_in_their_order_and_windows() {
    let via = |x_m: f64, y_m: f64, window_s| ViaPoint { x_m, y_m, z_m: 400.0, radius_m: 10.0, window_s };
    let [near, far] = [via(100.0, 4.0, None), via(300.0, 0.0, None)];
    for (points, robustness_m) in [
        (vec![near, far], Some(6.0)),
        (vec![far, near], None),
        (vec![via(100.0, 12.0, None)], Some(-2.0)),
        // Passed in the middle of the window: a second to its ends decides, and counts like a metre.
        (vec![via(100.0, 4.0, Some(Range::new(2.0, 4.0)))], Some(1.0)),
        (vec![via(100.0, 4.0, Some(Range::new(5.0, 9.0)))], None),
    ] {
        let mut case = Case::good();
        case.scenario.vehicles[0].via = points;
        let verdict = case.judge();
        for name in ["plan.requirement.via-uav-1", "flight.requirement.via-uav-1"] {
            let check = check(&verdict, name);
            let is_passed = robustness_m.is_some_and(|it| it > 0.0);
            assert_eq!(check.status, if is_passed { Status::Pass } else { Status::Fail }, "{check:?}");
            if let Some(robustness_m) = robustness_m {
                assert!((check.value.unwrap() - robustness_m).abs() < 1e-3, "{check:?}");
            }
        }
    }
    let mut case = Case::good();
    case.scenario.vehicles[1].via = vec![via(100.0, 200.0, None)];
    case.scenario.requirements.push(Requirement { name: "via-uav-2".into(), ..requirement("always speed > 1 m/s") });
    let issues = scenarios::validate(&case.scenario);
    assert!(issues.iter().any(|it| it.field == "requirements[0].name"), "{issues:?}");
}
