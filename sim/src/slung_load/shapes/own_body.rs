//! Distances of load and cable from the quadrotor that carries them.
//!
//! The load is kept off the disc that represents the body. The cable begins at the centre of that disc, so that it is kept off
//! the rotors only: discs of the propellers' radius that touch the body's disc from inside, on the diagonals of the body axes.
//! Between two of them a load may swing up beside the quadrotor.

use nalgebra::Vector3;

use super::Parts;
use crate::slung_load::SlungLoadState;

/// Half the thickness of the disc that a propeller sweeps, m: its blades are twisted, and bend.
const ROTOR_HALF_THICKNESS_M: f64 = 0.005;

/// Bisections after which the nearest place is known to 1e-12 of the cable.
const BISECTIONS: usize = 40;

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
        let nearest_m = end_m * nearest_fraction(&end_m, center_m, self.propeller_radius_m);
        to_disc_m(&nearest_m, center_m, self.propeller_radius_m) - ROTOR_HALF_THICKNESS_M
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
    let beyond_m = length(point_m.x - x_m, point_m.y - y_m) - radius_m;
    // max() would hide NaN.
    if beyond_m <= 0.0 { point_m.z.abs() } else { length(beyond_m, point_m.z) }
}

/// The place on the way from the centre of the body to `end_m`, from 0 to 1, that is nearest to a disc.
///
/// The square of the distance from a convex set is a convex function of s along a line, with a derivative that does not fall:
///
/// ```text
/// d²(s) = max(h(s) - r, 0)² + z² s²,   h(s) = |e s - c|,   (d²)'/2 = max(h - r, 0) e · (e s - c) / h + z² s
/// ```
///
/// The root of the derivative is bisected: this runs for every rotor at every instant of a flight that is judged.
fn nearest_fraction(end_m: &Vector3<f64>, [x_m, y_m]: [f64; 2], radius_m: f64) -> f64 {
    let slope = |s: f64| {
        let (across_m, along_m) = (end_m.x * s - x_m, end_m.y * s - y_m);
        let apart_m = length(across_m, along_m);
        let beyond_m = apart_m - radius_m;
        let inwards = if beyond_m <= 0.0 { 0.0 } else { beyond_m * (end_m.x * across_m + end_m.y * along_m) / apart_m };
        inwards + end_m.z * end_m.z * s
    };
    if slope(0.0) >= 0.0 {
        return 0.0;
    }
    if slope(1.0) <= 0.0 {
        return 1.0;
    }
    let [mut from, mut to] = [0.0, 1.0];
    for _ in 0..BISECTIONS {
        let middle = f64::midpoint(from, to);
        if slope(middle) < 0.0 { from = middle } else { to = middle }
    }
    f64::midpoint(from, to)
}

/// √(x² + y²) of lengths in metres, whose squares neither overflow nor vanish: `hypot` takes several times as long.
fn length(x_m: f64, y_m: f64) -> f64 {
    (x_m * x_m + y_m * y_m).sqrt()
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;
    use crate::slung_load::shapes::golden_section;

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

    /// Against a search that needs no derivative, for loads all around.
    #[test]
    fn the_nearest_place_is_that_of_a_golden_section() {
        for number in 0..200 {
            let (turn, lift) = (0.7 * f64::from(number), 0.33 * f64::from(number));
            let end_m = Vector3::new(turn.cos() * lift.cos(), turn.sin() * lift.cos(), lift.sin()) * 0.65;
            for rotor in 0..Parts::ROTORS {
                let center_m = PARTS.rotor_center_m(rotor);
                let distance_m = |s: f64| to_disc_m(&(end_m * s), center_m, PARTS.propeller_radius_m);
                let wanted_m = distance_m(golden_section::argmin(distance_m, [0.0, 1.0]));
                let found_m = distance_m(nearest_fraction(&end_m, center_m, PARTS.propeller_radius_m));
                assert!((found_m - wanted_m).abs() < 1e-11, "{number}, rotor {rotor}: {found_m} instead of {wanted_m}");
            }
        }
    }
}
