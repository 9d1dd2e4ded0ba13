//! Velocities from positions: the slopes of a cubic spline.

/// Velocities at the nodes of the cubic spline with continuous second derivative through `positions_m`.
///
/// ```text
/// m_{k-1}/h_{k-1} + 2 (1/h_{k-1} + 1/h_k) m_k + m_{k+1}/h_k = 3 (d_{k-1}/h_{k-1} + d_k/h_k),   d_k = (p_{k+1} - p_k)/h_k
/// ```
///
/// Its first slope is `start_mps`, the velocity at the start of the flight. At its end the not-a-knot condition holds, so
/// that the error is of order h³ everywhere. [de Boor, A Practical Guide to Splines, chapter IV]
///
/// - `times_s`: of the nodes, increasing, at least two
/// - `positions_m`: at the nodes
///
/// Returns velocities in the world frame, m/s.
pub(super) fn of(times_s: &[f64], positions_m: &[[f64; 3]], start_mps: [f64; 3]) -> Vec<[f64; 3]> {
    let steps_s: Vec<f64> = times_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let axis =
        |axis: usize| slopes(&steps_s, &positions_m.iter().map(|p| p[axis]).collect::<Vec<_>>(), start_mps[axis]);
    let [x, y, z] = [0, 1, 2].map(axis);
    (0..times_s.len()).map(|node| [x[node], y[node], z[node]]).collect()
}

/// Slopes of one coordinate, by elimination of the tridiagonal system.
fn slopes(h: &[f64], values: &[f64], first: f64) -> Vec<f64> {
    let last = h.len();
    let d: Vec<f64> = values.windows(2).zip(h).map(|(pair, h)| (pair[1] - pair[0]) / h).collect();
    let mut diagonal = vec![1.0; last + 1];
    let mut above = vec![0.0; last + 1];
    let mut slopes = vec![first; last + 1];
    for k in 1..=last {
        let (below, own, next, right) = row(k, h, &d);
        let factor = below / diagonal[k - 1];
        diagonal[k] = own - factor * above[k - 1];
        above[k] = next;
        slopes[k] = right - factor * slopes[k - 1];
    }
    slopes[last] /= diagonal[last];
    for k in (0..last).rev() {
        slopes[k] = (slopes[k] - above[k] * slopes[k + 1]) / diagonal[k];
    }
    slopes
}

/// Row `k` > 0: below the diagonal, on it, above it, right-hand side.
fn row(k: usize, h: &[f64], d: &[f64]) -> (f64, f64, f64, f64) {
    if k < h.len() {
        let (before, after) = (1.0 / h[k - 1], 1.0 / h[k]);
        (before, 2.0 * (before + after), after, 3.0 * (d[k - 1] * before + d[k] * after))
    } else if k == 1 {
        // A single piece: its second derivative is zero at the end.
        (1.0, 2.0, 0.0, 3.0 * d[0])
    } else {
        let (before, own) = (h[k - 2], h[k - 1]);
        let both = before + own;
        (both, before, 0.0, (own * own * d[k - 2] + (2.0 * both + own) * before * d[k - 1]) / both)
    }
}

#[cfg(test)]
mod tests {
    use super::of;

    /// A cubic is its own spline.
    #[test]
    fn a_cubic_is_differentiated_exactly_at_uneven_times() {
        let times_s = [0.0, 0.7, 1.5, 3.0, 3.4, 5.0];
        let position = |t: f64| [1.0 + 2.0 * t - 0.5 * t * t + 0.1 * t * t * t, -t * t, 400.0];
        let velocity = |t: f64| [2.0 - t + 0.3 * t * t, -2.0 * t, 0.0];
        for count in 3..=times_s.len() {
            let positions: Vec<_> = times_s[..count].iter().map(|t| position(*t)).collect();
            for (t, found) in times_s.iter().zip(of(&times_s[..count], &positions, velocity(0.0))) {
                for (found, exact) in found.into_iter().zip(velocity(*t)) {
                    assert!((found - exact).abs() < 1e-12, "{found} instead of {exact} at {t} s of {count} nodes");
                }
            }
        }
    }

    #[test]
    fn the_error_falls_with_the_third_power_of_the_step_or_faster() {
        let error = |n: usize| {
            let times_s: Vec<f64> = (0..=n).map(|k| 10.0 * k as f64 / n as f64).collect();
            let positions: Vec<_> = times_s.iter().map(|t| [t.sin(), t.cos(), 0.0]).collect();
            let found = of(&times_s, &positions, [1.0, 0.0, 0.0]);
            let off = times_s.iter().zip(found).map(|(t, v)| (v[0] - t.cos()).hypot(v[1] + t.sin()));
            off.fold(0.0, f64::max)
        };
        assert!(error(40) / error(80) > 7.5, "{} and {}", error(40), error(80));
    }

    #[test]
    fn two_nodes_are_enough() {
        assert_eq!(of(&[0.0, 2.0], &[[0.0; 3], [60.0, 0.0, 0.0]], [30.0, 0.0, 0.0]), [[30.0, 0.0, 0.0]; 2]);
    }
}
