//! The lowest altitude of the load.
//!
//! Where the cable becomes taut within a segment, the velocity v jumps, and the cubic through the ends of the segment bulges by
//! up to 4/27 h |Δv| to the other side of the motion, whose velocity is between those of the ends up to smooth changes. From
//! each end the altitude therefore is at least
//!
//! ```text
//! max(z₀ + t min(v₀, v₁), z₁ - (h - t) max(v₀, v₁)) - A h²/8
//! ```
//!
//! with A the largest acceleration that is no impact. The larger of this bound and the cubic's counts.

use crate::verdict::bernstein;
use crate::verdict::compare::is_smaller;
use crate::verdict::slung_load::motion::{IMPACT_MPS2, SlungLoadMotion};

/// Distance between the bounds of an altitude that counts as close enough, m.
const RESOLUTION_M: f64 = 1e-9;

impl SlungLoadMotion {
    /// Lowest altitude of the load's centre, m, and when, s. `None` without a segment.
    pub fn lowest_load_m(&self) -> Option<(f64, f64)> {
        let lowest = self.segments().map(|segment| self.lowest_in(segment));
        lowest.reduce(|lowest, next| if is_smaller(next.0, lowest.0) { next } else { lowest })
    }

    fn lowest_in(&self, segment: usize) -> (f64, f64) {
        let altitudes_m = self.load_points_m(segment).map(|point_m| point_m.z);
        let minimum = bernstein::minimise(&altitudes_m, f64::INFINITY, |_| RESOLUTION_M);
        let at_s = self.time_s(segment, minimum.at.unwrap_or(0.0));
        match kinked(&altitudes_m, self.duration_s(segment)) {
            Some(kinked_m) if minimum.lower < kinked_m => (kinked_m, at_s),
            _ => (minimum.lower, at_s),
        }
    }
}

/// The lower bound of a coordinate whose velocity jumps, by the control points of the cubic through its ends; `None` if it does
/// not jump.
fn kinked([begin_m, after_m, before_m, end_m]: &[f64; 4], duration_s: f64) -> Option<f64> {
    let velocities_mps = [after_m - begin_m, end_m - before_m].map(|leg_m| leg_m * 3.0 / duration_s);
    let [slow_mps, fast_mps] = [velocities_mps[0].min(velocities_mps[1]), velocities_mps[0].max(velocities_mps[1])];
    let jump_mps = fast_mps - slow_mps;
    if !jump_mps.is_finite() || jump_mps <= IMPACT_MPS2 * duration_s {
        return None;
    }
    // Where the two lines meet, or the end from which they do not.
    let meeting_s = ((end_m - begin_m - fast_mps * duration_s) / (slow_mps - fast_mps)).clamp(0.0, duration_s);
    let from_ends_m = [begin_m + slow_mps * meeting_s, end_m - fast_mps * (duration_s - meeting_s)];
    let lowest_m = begin_m.min(*end_m).min(from_ends_m[0].max(from_ends_m[1]));
    Some(lowest_m - IMPACT_MPS2 * duration_s * duration_s / 8.0)
}

#[cfg(test)]
mod tests {
    use super::kinked;

    /// Control points of the cubic through altitudes and velocities at both ends of 10 ms.
    fn points([z0, v0]: [f64; 2], [z1, v1]: [f64; 2]) -> [f64; 4] {
        [z0, z0 + v0 * 0.01 / 3.0, z1 - v1 * 0.01 / 3.0, z1]
    }

    #[test]
    fn a_load_that_is_jerked_off_the_ground_has_not_been_in_it() {
        // At rest for 9 ms, then 1.2 m/s upwards: the cubic dips by a millimetre.
        let lowest_m = kinked(&points([0.0, 0.0], [0.0012, 1.2]), 0.01).expect("a jump");
        assert!((lowest_m + 50.0 * 1e-4 / 8.0).abs() < 1e-12, "{lowest_m}");
    }

    #[test]
    fn a_load_that_falls_before_it_is_jerked_up_has() {
        // 1 m/s downwards, after half of the time 1 m/s upwards.
        let lowest_m = kinked(&points([0.0, -1.0], [0.0, 1.0]), 0.01).expect("a jump");
        assert!((lowest_m - (-0.005 - 50.0 * 1e-4 / 8.0)).abs() < 1e-12, "{lowest_m}");
        // Farther than its velocities tell: the lower end counts.
        assert!(kinked(&points([0.0, -1.0], [-0.3, 1.0]), 0.01).expect("a jump") < -0.3);
    }

    #[test]
    fn neither_a_smooth_motion_nor_one_that_is_not_finite_has_a_kink() {
        assert_eq!(kinked(&points([0.0, 0.0], [0.0012, 0.4]), 0.01), None);
        for broken in [f64::NAN, f64::INFINITY] {
            assert_eq!(kinked(&points([0.0, broken], [0.0012, 1.2]), 0.01), None);
        }
    }
}
