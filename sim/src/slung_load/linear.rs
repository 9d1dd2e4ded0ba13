use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use scenarios::slung_load::{Cable, GRAVITY_MPS2};

/// Errors that the tracker feeds back, world frame: ∫e, e (position) and e' (velocity) of the quadrotor, then position
/// and velocity of the load.
pub(super) type Errors = SVector<f64, 15>;
/// Derivative of the error rates with respect to the errors.
pub(super) type ErrorRates = SMatrix<f64, 15, 15>;
/// Derivative of the error rates with respect to the quadrotor's acceleration.
pub(super) type InputRates = SMatrix<f64, 15, 3>;

/// Linearised equations of motion of the errors about a reference, with the quadrotor's acceleration as input.
///
/// ```text
/// p_Q'' = u,   p_L'' = -g e_3 - s d,   s = d·(-g e_3 - u) + |ζ|²/l     (taut)
///              p_L'' = -g e_3                                          (slack)
/// ```
///
/// - `cable_m`: from the quadrotor to the load, η = l d
/// - `relative_mps`: its time derivative ζ
/// - `acceleration_mps2`: u of the reference
pub(super) fn linearised(
    cable: Cable,
    cable_m: &Vector3<f64>,
    relative_mps: &Vector3<f64>,
    acceleration_mps2: &Vector3<f64>,
) -> (ErrorRates, InputRates) {
    let (mut a, mut b) = (ErrorRates::zeros(), InputRates::zeros());
    let one = Matrix3::identity();
    a.fixed_view_mut::<3, 3>(0, 3).copy_from(&one);
    a.fixed_view_mut::<3, 3>(3, 6).copy_from(&one);
    a.fixed_view_mut::<3, 3>(9, 12).copy_from(&one);
    b.fixed_view_mut::<3, 3>(6, 0).copy_from(&one);
    if cable == Cable::Taut {
        let length_m = cable_m.norm();
        let d = cable_m / length_m;
        let w = Vector3::new(0.0, 0.0, -GRAVITY_MPS2) - acceleration_mps2;
        let s = d.dot(&w) + relative_mps.norm_squared() / length_m;
        let across = (one - d * d.transpose()) / length_m;
        let by_cable = -d * (w.transpose() * across) - across * s;
        let by_relative = -d * relative_mps.transpose() * (2.0 / length_m);
        a.fixed_view_mut::<3, 3>(12, 9).copy_from(&by_cable);
        a.fixed_view_mut::<3, 3>(12, 3).copy_from(&-by_cable);
        a.fixed_view_mut::<3, 3>(12, 12).copy_from(&by_relative);
        a.fixed_view_mut::<3, 3>(12, 6).copy_from(&-by_relative);
        b.fixed_view_mut::<3, 3>(12, 0).copy_from(&(d * d.transpose()));
    }
    (a, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Acceleration of a load on a cable of constant length, m/s².
    fn load_mps2(cable_m: &Vector3<f64>, relative_mps: &Vector3<f64>, u: &Vector3<f64>, length_m: f64) -> Vector3<f64> {
        let gravity = Vector3::new(0.0, 0.0, -GRAVITY_MPS2);
        let d = cable_m.normalize();
        gravity - d * (d.dot(&(gravity - u)) + relative_mps.norm_squared() / length_m)
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let cable_m = Vector3::new(0.2, -0.3, -0.5).normalize() * 0.65;
        let (relative_mps, u) = (Vector3::new(0.7, 0.2, 0.16), Vector3::new(1.0, -2.0, 0.5));
        let (a, b) = linearised(Cable::Taut, &cable_m, &relative_mps, &u);
        let ε = 1e-6;
        for axis in 0..3 {
            let mut δ = Vector3::zeros();
            δ[axis] = ε;
            let difference = |plus: Vector3<f64>, minus: Vector3<f64>| (plus - minus) / (2.0 * ε);
            let at = |c: Vector3<f64>, r: Vector3<f64>, u: Vector3<f64>| load_mps2(&c, &r, &u, 0.65);
            let by_cable = difference(at(cable_m + δ, relative_mps, u), at(cable_m - δ, relative_mps, u));
            let by_relative = difference(at(cable_m, relative_mps + δ, u), at(cable_m, relative_mps - δ, u));
            let by_input = difference(at(cable_m, relative_mps, u + δ), at(cable_m, relative_mps, u - δ));
            assert!((a.fixed_view::<3, 1>(12, 9 + axis) - by_cable).norm() < 1e-7);
            assert!((a.fixed_view::<3, 1>(12, 3 + axis) + by_cable).norm() < 1e-7);
            assert!((a.fixed_view::<3, 1>(12, 12 + axis) - by_relative).norm() < 1e-7);
            assert!((a.fixed_view::<3, 1>(12, 6 + axis) + by_relative).norm() < 1e-7);
            assert!((b.fixed_view::<3, 1>(12, axis) - by_input).norm() < 1e-7);
        }
    }
}
