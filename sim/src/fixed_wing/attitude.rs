use nalgebra::{Matrix3, Rotation3, UnitQuaternion, Vector3};
use scenarios::fixed_wing::Control;

use super::air_path::AirPath;

/// Attitude of an aircraft that flies without sideslip: world from body (x forward, y left, z up).
///
/// The body's x axis lies along the velocity relative to the air (a point mass has no angle of attack), and its z axis
/// carries the lift n_y e_h + n_z e_n: it banks into the turn. Without lift the wings stay level.
///
/// Returns a unit quaternion (x, y, z, w).
pub fn world_from_body(air_velocity_mps: &Vector3<f64>, control: Control) -> [f64; 4] {
    let path = AirPath::new(air_velocity_mps);
    let lift = path.left * control.n_y + path.up * control.n_z;
    let up = lift.try_normalize(1e-9).unwrap_or(path.up);
    let axes = Matrix3::from_columns(&[path.forward, up.cross(&path.forward), up]);
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes)).coords.into()
}

#[cfg(test)]
mod tests {
    use nalgebra::Quaternion;

    use super::*;

    fn rotation(air_velocity_mps: Vector3<f64>, control: Control) -> UnitQuaternion<f64> {
        let [x, y, z, w] = world_from_body(&air_velocity_mps, control);
        UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z))
    }

    #[test]
    fn level_cruise_to_the_north_is_a_yaw_of_a_right_angle() {
        let attitude = rotation(Vector3::new(0.0, 30.0, 0.0), Control::CRUISE);
        assert!((attitude * Vector3::x() - Vector3::y()).norm() < 1e-15);
        assert!((attitude * Vector3::z() - Vector3::z()).norm() < 1e-15);
    }

    #[test]
    fn a_left_turn_banks_left_by_the_ratio_of_the_load_factors() {
        let attitude = rotation(Vector3::new(30.0, 0.0, 0.0), Control { n_x: 0.0, n_y: 0.5, n_z: 1.0 });
        let (roll, pitch, yaw) = attitude.euler_angles();
        // Positive roll about x (forward) with y to the left raises the left wing: a left bank is negative.
        assert!((roll + 0.5_f64.atan()).abs() < 1e-15 && pitch.abs() < 1e-15 && yaw.abs() < 1e-15);
    }

    #[test]
    fn the_nose_follows_the_climb() {
        let velocity = Vector3::new(-20.0, 11.0, 6.0);
        let attitude = rotation(velocity, Control { n_x: 0.2, n_y: -0.1, n_z: 1.1 });
        assert!((attitude * Vector3::x() - velocity.normalize()).norm() < 1e-15);
    }
}
