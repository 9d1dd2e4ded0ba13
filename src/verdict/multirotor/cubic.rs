//! Speed and accelerations of the cubic between two nodes.

use crate::verdict::bernstein;
use crate::verdict::compare::exceeds;
use crate::verdict::motion::{Knot, Segment};

/// Nodes at one time that differ by less than this, m and m/s, are the same: rounding.
const SAME_NODE: f64 = 1e-9;
/// Distance between the bounds of an extreme squared speed that counts as close enough, m²/s².
const RESOLUTION_M2PS2: f64 = 1e-9;

/// Length of a vector.
pub fn norm([x, y, z]: [f64; 3]) -> f64 {
    (x * x + y * y + z * z).sqrt()
}

/// Largest speed in a segment, m/s, and when, s: the squared speed is a polynomial of degree 4.
pub fn fastest(segment: &Segment) -> (f64, f64) {
    const SHARES: [[f64; 3]; 3] = [[1.0, 0.5, 1.0 / 6.0], [0.5, 2.0 / 3.0, 0.5], [1.0 / 6.0, 0.5, 1.0]];
    let duration_s = segment.t_s[1] - segment.t_s[0];
    let v: [[f64; 3]; 3] = std::array::from_fn(|i| {
        std::array::from_fn(|axis| (segment.points_m[i + 1][axis] - segment.points_m[i][axis]) * 3.0 / duration_s)
    });
    // c_k = Σ_{i+j=k} C(2,i) C(2,j) / C(4,k) v_i·v_j, with the sign turned: the minimum is sought.
    let mut c = [0.0; 5];
    for i in 0..3 {
        for j in 0..3 {
            let dot: f64 = (0..3).map(|axis| v[i][axis] * v[j][axis]).sum();
            c[i + j] -= SHARES[i][j] * dot;
        }
    }
    let minimum = bernstein::minimise(&c, f64::INFINITY, |_| RESOLUTION_M2PS2);
    ((-minimum.lower).sqrt(), minimum.at.map_or(segment.t_s[0], |u| segment.instant_s(u)))
}

/// Accelerations at both ends of a segment, m/s².
pub fn accelerations_mps2(segment: &Segment) -> [[f64; 3]; 2] {
    let duration_s = segment.t_s[1] - segment.t_s[0];
    let second = |first: usize| {
        std::array::from_fn(|axis| {
            let [a, b, c] = [0, 1, 2].map(|i| segment.points_m[first + i][axis]);
            6.0 * (a - 2.0 * b + c) / (duration_s * duration_s)
        })
    };
    [second(0), second(1)]
}

/// Whether two knots share a time, but not position and velocity.
pub fn is_jump(pair: &[Knot]) -> bool {
    let differ = |a: [f64; 3], b: [f64; 3]| exceeds(norm([a[0] - b[0], a[1] - b[1], a[2] - b[2]]), SAME_NODE);
    pair[0].t_s == pair[1].t_s
        && (differ(pair[0].position_m, pair[1].position_m) || differ(pair[0].velocity_mps, pair[1].velocity_mps))
}

/// An acceleration, m/s², less what rounding of positions and times may contribute, where that decides.
///
/// ```text
/// δa = 6/h² (4 ε |p| + |v| ε t)                          ε of double precision, over an interval of length h
/// ```
///
/// Rows some nanoseconds apart have second differences that are all rounding.
pub fn without_rounding(value_mps2: f64, limit_mps2: f64, segment: &Segment) -> f64 {
    let [from_s, to_s] = segment.t_s;
    let duration_s = to_s - from_s;
    let position_m = segment.points_m.iter().map(|point| norm(*point)).fold(0.0, f64::max);
    let leg_m = |first: usize| {
        norm(std::array::from_fn(|axis| segment.points_m[first + 1][axis] - segment.points_m[first][axis]))
    };
    // The speeds of the nodes, not the distance between them: a jump must not excuse itself.
    let time_error_m = 3.0 * leg_m(0).max(leg_m(2)) / duration_s * to_s.abs() * f64::EPSILON;
    let rounding_mps2 = 6.0 * (4.0 * f64::EPSILON * position_m + time_error_m) / (duration_s * duration_s);
    let decides = exceeds(value_mps2, limit_mps2) && !exceeds(value_mps2 - rounding_mps2, limit_mps2);
    if decides { (value_mps2 - rounding_mps2).max(0.0) } else { value_mps2 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speed_and_acceleration_of_a_cubic_are_found_between_its_ends() {
        // x = 6 t² - 4 t³ on [0, 1]: v = 12 t (1 - t), largest 3 m/s in the middle; a = 12 - 24 t.
        let knot = |t_s: f64| Knot {
            t_s,
            position_m: [6.0 * t_s * t_s - 4.0 * t_s.powi(3), 0.0, 0.0],
            velocity_mps: [12.0 * t_s * (1.0 - t_s), 0.0, 0.0],
        };
        let segment = Segment::between(&knot(0.0), &knot(1.0));
        let (speed_mps, at_s) = fastest(&segment);
        assert!((speed_mps - 3.0).abs() < 1e-6 && (at_s - 0.5).abs() < 1e-3, "{speed_mps} at {at_s}");
        let [first, last] = accelerations_mps2(&segment);
        assert!((first[0] - 12.0).abs() < 1e-12 && (last[0] + 12.0).abs() < 1e-12, "{first:?} {last:?}");
    }

    /// Half an ulp of 1000 m and of 1e6 s at 7 m/s, over 1e-4 s: accelerations up to the sum of both are rounding.
    #[test]
    fn rounding_is_taken_off_where_it_decides_and_not_beyond() {
        let interval_s = 2.0_f64.powi(-13);
        let knot = |t_s: f64, x_m: f64| Knot { t_s, position_m: [x_m, 0.0, 0.0], velocity_mps: [7.0, 0.0, 0.0] };
        let segment = Segment::between(&knot(1e6, 1000.0), &knot(1e6 + interval_s, 1000.0 + 7.0 * interval_s));
        let furthest_m = 1000.0 + 7.0 * interval_s;
        let rounding_m = f64::EPSILON * (4.0 * furthest_m + 7.0 * (1e6 + interval_s));
        let rounding_mps2 = 6.0 * rounding_m / (interval_s * interval_s);
        assert!(rounding_mps2 > 0.5, "{rounding_mps2}");
        let left = |value_mps2: f64| without_rounding(value_mps2, 3.0, &segment);
        assert_eq!(left(2.9), 2.9);
        assert!((left(3.0 + 0.9 * rounding_mps2) - (3.0 - 0.1 * rounding_mps2)).abs() < 1e-6 * rounding_mps2);
        assert_eq!(left(3.0 + 1.1 * rounding_mps2), 3.0 + 1.1 * rounding_mps2);
    }

    #[test]
    fn a_jump_needs_an_infinite_acceleration_and_rounding_none() {
        let knot =
            |t_s: f64, x_m: f64, v_mps: f64| Knot { t_s, position_m: [x_m, 0.0, 0.0], velocity_mps: [v_mps, 0.0, 0.0] };
        assert!(is_jump(&[knot(1.0, 2.0, 1.0), knot(1.0, 2.5, 1.0)]));
        assert!(is_jump(&[knot(1.0, 2.0, 1.0), knot(1.0, 2.0, -1.0)]));
        assert!(!is_jump(&[knot(1.0, 2.0, 1.0), knot(1.0, 2.0, 1.0)]));
        assert!(!is_jump(&[knot(1.0, 2.0, 1.0), knot(1.1, 2.5, 1.0)]));
        let aside = |y_m: f64| Knot { position_m: [2.0, y_m, -y_m], ..knot(1.0, 2.0, 1.0) };
        assert!(!is_jump(&[aside(4.0), aside(4.0)]) && is_jump(&[aside(4.0), aside(4.5)]));
        // 3 ns on a motion at constant velocity: the second difference is rounding.
        let [a, b] = [4.0, 4.0 + 3e-9].map(|t_s| knot(t_s, 0.7 * t_s, 0.7));
        let segment = Segment::between(&a, &b);
        for value in accelerations_mps2(&segment) {
            assert!(without_rounding(norm(value), 3.0, &segment) <= 3.0, "{value:?}");
        }
        // A hop of a micrometre within the same interval is no rounding.
        let hop = Segment::between(&a, &knot(b.t_s, b.position_m[0] + 1e-6, 0.7));
        assert!(accelerations_mps2(&hop).iter().all(|value| without_rounding(norm(*value), 3.0, &hop) > 1e6));
        // Nor is one between two neighbouring numbers of time.
        let hop = Segment::between(&a, &knot(a.t_s.next_up(), a.position_m[0] + 0.5, 0.7));
        assert!(accelerations_mps2(&hop).iter().all(|value| without_rounding(norm(*value), 3.0, &hop) > 1e6));
    }
}
