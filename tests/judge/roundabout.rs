//! The hardest fleet for the search of the smallest separation: neighbours that are equally close at all times.

use std::f64::consts::{PI, TAU};

use harness::verdict::Status;

use crate::fleet::{Case, SPEED_MPS, STEP_S, sample};

/// Distance between neighbours along the circle, m.
const ARC_M: f64 = 101.0;

fn radius_m(count: usize) -> f64 {
    ARC_M * count as f64 / TAU
}

/// `count` aircraft one behind the other on a circle.
fn roundabout(count: usize) -> Case {
    let norths_m: Vec<f64> = (0..count).map(|index| ARC_M * index as f64).collect();
    let mut case = Case::straight(&norths_m, STEP_S);
    let radius_m = radius_m(count);
    for vehicle in 0..count {
        let phase = TAU * vehicle as f64 / count as f64;
        for logged in case.samples(vehicle) {
            let (sin, cos) = (phase + SPEED_MPS / radius_m * logged.t_s).sin_cos();
            let velocity_mps = [-SPEED_MPS * sin, SPEED_MPS * cos, 0.0];
            *logged = sample(logged.t_s, [radius_m * cos, radius_m * sin, 400.0], velocity_mps);
        }
    }
    case
}

/// The chord is 2 r sin(π / n).
#[test]
fn neighbours_on_a_circle_are_a_chord_apart() {
    for count in [7, 60] {
        let case = roundabout(count);
        let chord_m = 2.0 * radius_m(count) * (PI / count as f64).sin();
        let check = case.check("flight.separation");
        assert!((check.value.unwrap() - chord_m).abs() < 1e-6, "{count}: {check:#?}, chord {chord_m} m");
        assert_eq!(check.status, if chord_m > 100.0 { Status::Pass } else { Status::Fail }, "{count}");
    }
}
