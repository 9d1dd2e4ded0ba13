use nalgebra::{Vector3, Vector4};
use scenarios::Range;

use super::RotorGeometry;

/// Thrusts for a total thrust, N, and a torque, N m, without regard to their limits: the inverse of
/// [`RotorGeometry::wrench`].
pub(crate) fn unlimited(rotors: &RotorGeometry, total_n: f64, torque_nm: &Vector3<f64>) -> Vector4<f64> {
    let [tilt_n, yaw_n] = parts(rotors, torque_nm);
    Vector4::repeat(total_n / 4.0) + tilt_n + yaw_n
}

/// Thrusts inside their limits that approximate a total thrust, N, and a torque, N m.
///
/// The torque about the body's z axis is reduced first, then the torque about x and y, which keeps its direction. The
/// total thrust has priority over both.
pub(crate) fn limited(rotors: &RotorGeometry, total_n: f64, torque_nm: &Vector3<f64>, limits: Range) -> Vector4<f64> {
    let [tilt_n, yaw_n] = parts(rotors, torque_nm);
    let mut thrust_n = Vector4::repeat((total_n / 4.0).clamp(limits.min, limits.max));
    for part in [tilt_n, yaw_n] {
        thrust_n += part * max_fraction(&thrust_n, &part, limits);
    }
    thrust_n.map(|thrust| thrust.clamp(limits.min, limits.max))
}

/// Differences of thrust for the torque about x and y, and for that about z, N.
fn parts(rotors: &RotorGeometry, torque_nm: &Vector3<f64>) -> [Vector4<f64>; 2] {
    let roll_n = torque_nm.x / (4.0 * rotors.arm_m);
    let pitch_n = torque_nm.y / (4.0 * rotors.arm_m);
    let turn_n = torque_nm.z / (4.0 * rotors.torque_per_thrust_m);
    let tilt_n = Vector4::new(-1.0, 1.0, 1.0, -1.0) * roll_n + Vector4::new(-1.0, -1.0, 1.0, 1.0) * pitch_n;
    [tilt_n, Vector4::new(1.0, -1.0, 1.0, -1.0) * turn_n]
}

/// Largest fraction of `part` in [0, 1] for which every thrust stays inside its limits.
fn max_fraction(thrust_n: &Vector4<f64>, part: &Vector4<f64>, limits: Range) -> f64 {
    let fraction = |(thrust, part): (&f64, &f64)| match part.total_cmp(&0.0) {
        std::cmp::Ordering::Greater => (limits.max - thrust) / part,
        std::cmp::Ordering::Less => (limits.min - thrust) / part,
        std::cmp::Ordering::Equal => 1.0,
    };
    thrust_n.iter().zip(part).map(fraction).fold(1.0, f64::min).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROTORS: RotorGeometry = RotorGeometry { arm_m: 0.225, torque_per_thrust_m: 0.015 };

    #[test]
    fn allocation_inverts_the_rotors() {
        let torque_nm = Vector3::new(0.3, -0.2, 0.02);
        let thrust_n = unlimited(&ROTORS, 14.0, &torque_nm);
        let (total_n, given_nm) = ROTORS.wrench(&thrust_n);
        assert!((total_n - 14.0).abs() < 1e-12 && (given_nm - torque_nm).norm() < 1e-12);
        assert!((limited(&ROTORS, 14.0, &torque_nm, Range::new(0.0, 10.0)) - thrust_n).norm() < 1e-12);
    }

    #[test]
    fn yaw_is_reduced_first_then_tilt_and_the_total_thrust_is_kept() {
        let limits = Range::new(1.0, 5.0);
        let (total_n, torque_nm) = ROTORS.wrench(&limited(&ROTORS, 14.0, &Vector3::new(0.5, 0.5, 9.0), limits));
        assert!((total_n - 14.0).abs() < 1e-12);
        assert!((torque_nm.x - 0.5).abs() < 1e-12 && (torque_nm.y - 0.5).abs() < 1e-12, "{torque_nm}");
        assert!(torque_nm.z > 0.0 && torque_nm.z < 9.0, "{torque_nm}");
        let thrust_n = limited(&ROTORS, 14.0, &Vector3::new(5.0, 2.5, 0.0), limits);
        let (total_n, torque_nm) = ROTORS.wrench(&thrust_n);
        assert!((total_n - 14.0).abs() < 1e-12 && (torque_nm.x - 2.0 * torque_nm.y).abs() < 1e-12);
        assert!(thrust_n.iter().all(|thrust| limits.contains(*thrust)));
        assert_eq!(limited(&ROTORS, 99.0, &torque_nm, limits), Vector4::repeat(5.0));
    }
}
