use nalgebra::{Vector3, Vector4};
use scenarios::Range;

use super::Rotors;

/// Thrusts that give a total thrust, N, and a torque, N m, whatever their limits: the inverse of [`Rotors::wrench`].
pub(crate) fn unlimited(rotors: &Rotors, total_n: f64, torque_nm: &Vector3<f64>) -> Vector4<f64> {
    let [tilt, turn] = parts(rotors, torque_nm);
    Vector4::repeat(total_n / 4.0) + tilt + turn
}

/// Thrusts inside their limits that come near a total thrust and a torque.
///
/// What does not fit is given up in this order: torque about the body's z axis, then the tilting torques, each scaled
/// down as a whole so that it keeps its direction; the total thrust gives way to neither.
pub(crate) fn limited(rotors: &Rotors, total_n: f64, torque_nm: &Vector3<f64>, limits: Range) -> Vector4<f64> {
    let [tilt, turn] = parts(rotors, torque_nm);
    let mut thrust_n = Vector4::repeat((total_n / 4.0).clamp(limits.min, limits.max));
    for part in [tilt, turn] {
        thrust_n += part * largest_share(&thrust_n, &part, limits);
    }
    thrust_n.map(|thrust| thrust.clamp(limits.min, limits.max))
}

/// Thrusts of the tilting torques and of the turning torque.
fn parts(rotors: &Rotors, torque_nm: &Vector3<f64>) -> [Vector4<f64>; 2] {
    let roll_n = torque_nm.x / (4.0 * rotors.arm_m);
    let pitch_n = torque_nm.y / (4.0 * rotors.arm_m);
    let yaw_n = torque_nm.z / (4.0 * rotors.torque_per_thrust_m);
    let tilt = Vector4::new(-1.0, 1.0, 1.0, -1.0) * roll_n + Vector4::new(-1.0, -1.0, 1.0, 1.0) * pitch_n;
    [tilt, Vector4::new(1.0, -1.0, 1.0, -1.0) * yaw_n]
}

/// Largest share of `part` in [0, 1] with which every thrust stays inside its limits.
fn largest_share(thrust_n: &Vector4<f64>, part: &Vector4<f64>, limits: Range) -> f64 {
    let share = |(thrust, part): (&f64, &f64)| match part.total_cmp(&0.0) {
        std::cmp::Ordering::Greater => (limits.max - thrust) / part,
        std::cmp::Ordering::Less => (limits.min - thrust) / part,
        std::cmp::Ordering::Equal => 1.0,
    };
    thrust_n.iter().zip(part).map(share).fold(1.0, f64::min).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROTORS: Rotors = Rotors { arm_m: 0.225, torque_per_thrust_m: 0.015 };

    #[test]
    fn allocation_inverts_the_rotors() {
        let torque_nm = Vector3::new(0.3, -0.2, 0.02);
        let thrust_n = unlimited(&ROTORS, 14.0, &torque_nm);
        let (total_n, given_nm) = ROTORS.wrench(&thrust_n);
        assert!((total_n - 14.0).abs() < 1e-12 && (given_nm - torque_nm).norm() < 1e-12);
        assert!((limited(&ROTORS, 14.0, &torque_nm, Range::new(0.0, 10.0)) - thrust_n).norm() < 1e-12);
    }

    #[test]
    fn yaw_goes_first_then_tilt_and_thrust_stays() {
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
