//! Distances of load and cable from the quadrotor that carries them.
//!
//! The load is kept off the disc that represents the body. The cable begins at the centre of that disc, so that it is kept off
//! the rotors only: discs of the propellers' radius that touch the body's disc from inside, on the diagonals of the body axes.
//! Between two of them a load may swing up beside the quadrotor.

use nalgebra::Vector3;

use super::{Parts, golden_section};
use crate::slung_load::SlungLoadState;

/// Half the thickness of the disc that a propeller sweeps, m: its blades are twisted, and bend.
const ROTOR_HALF_THICKNESS_M: f64 = 0.005;

impl Parts {
    /// Number of rotors.
    pub const ROTORS: usize = 4;

    /// Signed distance between the load's ball and the body's disc, m.
    pub fn load_to_body_m(&self, state: &SlungLoadState) -> f64 {
        to_disc_m(&load_in_body_m(state), [0.0; 2], self.body_radius_m) - self.load_radius_m
    }

    /// Distance between the cable, as a straight line, and the disc that a rotor sweeps, m; negative if the cable passes
    /// through it.
    ///
    /// - `rotor`: counted from 0
    pub fn cable_to_rotor_m(&self, state: &SlungLoadState, rotor: usize) -> f64 {
        let (end_m, center_m) = (load_in_body_m(state), self.rotor_center_m(rotor));
        // The distance from a convex set is a convex function along the cable.
        let distance_m = |fraction: f64| to_disc_m(&(end_m * fraction), center_m, self.propeller_radius_m);
        distance_m(golden_section::argmin(distance_m, [0.0, 1.0])) - ROTOR_HALF_THICKNESS_M
    }

    /// Centre of a rotor in body axes x and y, m.
    fn rotor_center_m(&self, rotor: usize) -> [f64; 2] {
        let offset_m = (self.body_radius_m - self.propeller_radius_m) / std::f64::consts::SQRT_2;
        let [x, y] = [[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]][rotor];
        [x * offset_m, y * offset_m]
    }
}

/// Position of the load in body axes, m.
fn load_in_body_m(state: &SlungLoadState) -> Vector3<f64> {
    state.attitude.inverse_transform_vector(&state.cable_m())
}

/// Distance of a point from a disc in the plane z = 0, m.
fn to_disc_m(point_m: &Vector3<f64>, [x_m, y_m]: [f64; 2], radius_m: f64) -> f64 {
    let beyond_m = (point_m.x - x_m).hypot(point_m.y - y_m) - radius_m;
    // max() would hide NaN.
    if beyond_m <= 0.0 { point_m.z.abs() } else { beyond_m.hypot(point_m.z) }
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;

    const PARTS: Parts = Parts { body_radius_m: 0.35, load_radius_m: 0.03, propeller_radius_m: 0.13 };

    /// A quadrotor at any attitude, with the load at a position in body axes.
    fn carrying(load_m: [f64; 3]) -> SlungLoadState {
        let attitude = UnitQuaternion::from_euler_angles(0.3, -0.2, 1.1);
        let position_m = Vector3::new(4.0, -2.0, 3.0);
        let still = Vector3::zeros();
        SlungLoadState {
            position_m,
            velocity_mps: still,
            attitude,
            body_rate_radps: still,
            load_position_m: position_m + attitude * Vector3::from(load_m),
            load_velocity_mps: still,
        }
    }

    #[test]
    fn the_load_is_beside_below_or_inside_the_disc() {
        for (load_m, distance_m) in [
            ([0.0, 0.0, -0.5], 0.47),
            ([0.12, 0.0, -0.025], -0.005),
            ([0.0, 0.0, 0.0], -0.03),
            ([0.0, 0.65, 0.0], 0.27),
            ([0.35 + 0.3, 0.0, 0.4], 0.47),
        ] {
            let found_m = PARTS.load_to_body_m(&carrying(load_m));
            assert!((found_m - distance_m).abs() < 1e-12, "{load_m:?}: {found_m}");
        }
        assert!(PARTS.load_to_body_m(&carrying([f64::NAN, 0.0, 0.0])).is_nan());
    }

    /// The rotors are 0.22 m from the centre, at 45°.
    #[test]
    fn the_cable_passes_between_rotors_and_through_them() {
        let nearest_m = |load_m: [f64; 3]| {
            let state = carrying(load_m);
            (0..Parts::ROTORS).map(|rotor| PARTS.cable_to_rotor_m(&state, rotor)).fold(f64::INFINITY, f64::min)
        };
        let is = |load_m, distance_m: f64| {
            let found_m = nearest_m(load_m) + ROTOR_HALF_THICKNESS_M;
            assert!((found_m - distance_m).abs() < 1e-10, "{load_m:?}: {found_m}");
        };
        let along_axis_m = 0.22 / 2.0_f64.sqrt() - 0.13;
        is([0.0, 0.0, -0.65], 0.09);
        is([0.65, 0.0, 0.0], along_axis_m);
        is([0.0, -0.65, 0.0], along_axis_m);
        is([0.4, 0.4, 0.0], 0.0);
        // Under a rotor, the closest point lies below its inner edge.
        is([-0.3, 0.3, -0.3 * 2.0_f64.sqrt()], 0.09 / 2.0_f64.sqrt());
        assert!(PARTS.cable_to_rotor_m(&carrying([f64::NAN, 0.0, -0.1]), 0).is_nan());
    }
}
