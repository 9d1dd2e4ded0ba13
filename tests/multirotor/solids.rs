//! Multirotors among meshes and other shapes: on paper, in the simulator, and planned.

use harness::verdict::{Outcome, Status, judge};
use scenarios::Mesh;
use scenarios::geometry::{Loaded, Surface};
use sim::EventKind;

use crate::case::Case;

/// A wall at x = 3 m with a window around the first path, z = 2 m, of this half size. It reaches up to the second, 3 m away.
fn wall(half_m: f64) -> Mesh {
    let sheet = |y: [f64; 2], z: [f64; 2]| {
        let [a, b, c, d] = [[3.0, y[0], z[0]], [3.0, y[1], z[0]], [3.0, y[1], z[1]], [3.0, y[0], z[1]]];
        [[a, b, c], [a, c, d]]
    };
    let (low, high) = (2.0 - half_m, 2.0 + half_m);
    let parts = [
        sheet([-2.0, 2.0], [0.0, low]),
        sheet([-2.0, 2.0], [high, 4.0]),
        sheet([-2.0, -half_m], [low, high]),
        sheet([half_m, 2.0], [low, high]),
    ];
    let triangles = parts.concat();
    let indices: Vec<[u32; 3]> =
        (0..triangles.len() as u32).map(|it| [0, 1, 2].map(|corner| 3 * it + corner)).collect();
    let surface = Loaded::new(Surface::new(&triangles.concat(), &indices).unwrap());
    let (name, file) = ("facade".into(), "facade.stl".into());
    Mesh { name, file, scale: 1.0, rotation_deg: [0.0; 3], offset_m: [0.0; 3], surface }
}

fn behind(half_m: f64) -> Case {
    let mut case = Case::good();
    case.scenario.world.boxes.clear();
    case.scenario.world.meshes.push(wall(half_m));
    case
}

#[test]
fn a_window_of_the_body_size_is_the_limit() {
    for (half_m, status) in [(0.351, Status::Pass), (0.349, Status::Fail)] {
        let verdict = behind(half_m).judge();
        for name in ["plan.clearance", "flight.clearance"] {
            let check = verdict.check(name).unwrap();
            assert_eq!(check.status, status, "{check:#?}");
            assert_eq!(check.between, ["uav-1", "facade"], "{check:#?}");
            let expected_m = half_m - 0.35;
            assert!(
                check.lower.unwrap() <= expected_m + 1e-6 && expected_m <= check.upper.unwrap() + 1e-6,
                "{check:#?}"
            );
        }
    }
}

#[test]
fn the_simulator_crashes_into_the_frame_of_a_window_that_is_too_small() {
    let crash = |half_m: f64| {
        let case = behind(half_m);
        let flight = sim::fly(&case.scenario, &case.plan, 0, &mut |_| {});
        let crash =
            |kind: &EventKind| matches!(kind, EventKind::Crash { obstacle } if obstacle.as_deref() == Some("facade"));
        let is_crashed = flight.events.iter().any(|event| crash(&event.kind));
        assert_eq!(judge(&case.scenario, &case.plan, Some(&flight)).outcome == Outcome::Pass, !is_crashed);
        is_crashed
    };
    assert!(crash(0.3) && !crash(0.4));
}
