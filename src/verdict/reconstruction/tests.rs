use super::*;

/// Numerical integral over s ∈ [0, 1] of |kernel|, in n intervals.
fn integral(kernel: impl Fn(f64) -> f64) -> f64 {
    let n = 20_000;
    (0..n).map(|k| kernel((f64::from(k) + 0.5) / f64::from(n)).abs()).sum::<f64>() / f64::from(n)
}

/// Weight of p''(s) in p(u) - h(u), from p1 = p0 + v0 + ∫ (1 - s) p'' ds and v1 = v0 + ∫ p'' ds, for T = 1.
fn hermite_kernel(u: f64, s: f64) -> f64 {
    (u - s).max(0.0) - (3.0 * u * u - 2.0 * u.powi(3)) * (1.0 - s) - (u.powi(3) - u * u)
}

#[test]
fn the_closed_forms_are_the_integrals_of_the_kernels() {
    let step = 1e-5;
    let mut fastest = 0.0_f64;
    for k in 1..40 {
        let u = f64::from(k) / 40.0;
        let chord_kernel = |s: f64| (u - s).max(0.0) - u * (1.0 - s);
        for (given, kernel) in [
            (GivenRows::Positions, &chord_kernel as &dyn Fn(f64) -> f64),
            (GivenRows::States(Vec::new()), &|s| hermite_kernel(u, s)),
        ] {
            let factor = max_position_factor(&given, [u, u]);
            assert!((factor - integral(kernel)).abs() < 1e-6, "{given:?} at {u}: {factor}");
        }
        let rate = |s| (hermite_kernel(u + step, s) - hermite_kernel(u - step, s)) / (2.0 * step);
        fastest = fastest.max(integral(rate));
    }
    assert!((0.25..MAX_VELOCITY_FACTOR).contains(&fastest), "{fastest}");
    assert_eq!(max_position_factor(&GivenRows::States(Vec::new()), [0.0, 1.0]), 1.0 / 16.0);
    assert_eq!(max_position_factor(&GivenRows::Positions, [0.2, 1.0]), 1.0 / 8.0);
    assert!((max_position_factor(&GivenRows::Positions, [0.0, 0.2]) - 0.08).abs() < 1e-15);
}

/// 4 s at ±2 m/s²: with velocities at both ends the sharpest motion accelerates for 1 s, brakes for 2 s and accelerates
/// again, and is 2 m away from the curve of no acceleration.
#[test]
fn the_bounds_are_attained() {
    assert_eq!(max_distance_m(&GivenRows::States(Vec::new()), 2.0, 4.0), 2.0);
    assert_eq!(max_distance_m(&GivenRows::Positions, 2.0, 4.0), 4.0);
    assert_eq!(max_distance_m(&GivenRows::Everything, 2.0, 4.0), 0.0);
}
