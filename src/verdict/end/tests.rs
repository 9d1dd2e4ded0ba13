use std::path::Path;

use scenarios::{Family, Scenario};

use super::End;
use crate::verdict::motion::Knot;
use crate::verdict::tube::EndError;

fn scenario() -> Scenario {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/fixed-wing");
    let mut scenario = scenarios::load(&folder.join("rendezvous-2.toml")).unwrap();
    let goal = &mut scenario.vehicles[0].goal;
    (goal.heading_deg, goal.flight_path_deg, goal.speed_mps) = (70.0, 2.0, 35.0);
    scenario
}

/// Bounds by which position, heading, flight-path angle and speed are off at the first vehicle's goal.
fn off(heading_deg: f64, flight_path_deg: f64, speed_mps: f64, error: EndError) -> Vec<[f64; 2]> {
    let scenario = scenario();
    let vehicle = &scenario.vehicles[0];
    let (heading, climb) = (heading_deg.to_radians(), flight_path_deg.to_radians());
    let [x, y, z] = vehicle.goal.position_m();
    let velocity = [heading.cos() * climb.cos(), heading.sin() * climb.cos(), climb.sin()];
    let knot = Knot { t_s: 5.0, position_m: [x + 3.0, y, z - 4.0], velocity_mps: velocity.map(|it| it * speed_mps) };
    let parts = End::at(vehicle, &knot, error).parts(Family::FixedWing, vehicle, &scenario.limits());
    parts.iter().map(|part| part.off).collect()
}

#[track_caller]
fn assert_near(found: &[[f64; 2]], expected: [[f64; 2]; 4]) {
    for (found, expected) in found.iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < 1e-9, "{found}, not {expected}");
    }
}

#[test]
fn every_part_is_measured_from_the_goal() {
    let exact = EndError::default();
    assert_near(&off(75.0, 5.0, 33.0, exact), [[5.0; 2], [5.0; 2], [3.0; 2], [2.0; 2]]);
    assert_near(&off(-110.0, -2.0, 35.0, exact), [[5.0; 2], [180.0; 2], [4.0; 2], [0.0; 2]]);
    assert_near(&off(-285.0, 2.0, 36.0, exact), [[5.0; 2], [5.0; 2], [0.0; 2], [1.0; 2]]);
}

#[test]
fn an_error_of_the_end_widens_every_part_to_both_sides_but_not_below_zero() {
    let error = EndError { position_m: 1.0, velocity_mps: 0.5 };
    let horizontal_mps = 33.0 * 5.0_f64.to_radians().cos();
    let (turn, climb) = ((0.5 / horizontal_mps).asin().to_degrees(), (0.5 / 33.0_f64).asin().to_degrees());
    let expected = [[4.0, 6.0], [5.0 - turn, 5.0 + turn], [3.0 - climb, 3.0 + climb], [1.5, 2.5]];
    assert_near(&off(75.0, 5.0, 33.0, error), expected);
    let large = EndError { position_m: 9.0, velocity_mps: 4.0 };
    assert_eq!(off(75.0, 5.0, 33.0, large)[0], [0.0, 14.0]);
    assert_eq!(off(75.0, 5.0, 33.0, large)[3][0], 0.0);
}
