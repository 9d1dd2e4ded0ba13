use nalgebra::Vector3;

/// Name of the ground in events and reports.
pub const GROUND: &str = "ground";

/// First contact of two balls (or circles) that move along straight lines at constant velocity.
///
/// ```text
/// |r + (r' - r) fraction| = R,   fraction in [0, 1]
/// ```
///
/// - `start_m`, `end_m`: position of one relative to the other at the beginning and at the end, r and r'
/// - `reach_m`: sum of their radii R
///
/// Returns the fraction of the motion at first contact: 0 if they overlap from the beginning, `None` if they never
/// touch.
pub(crate) fn time_of_impact(start_m: &Vector3<f64>, end_m: &Vector3<f64>, reach_m: f64) -> Option<f64> {
    let gap = start_m.norm_squared() - reach_m * reach_m;
    if gap <= 0.0 {
        return Some(0.0);
    }
    let travel_m = end_m - start_m;
    // a fraction² + 2 b fraction + gap = 0, smaller root; the form below loses no digits when a is small.
    let (a, b) = (travel_m.norm_squared(), start_m.dot(&travel_m));
    let discriminant = b * b - a * gap;
    if b >= 0.0 || discriminant < 0.0 {
        return None;
    }
    let fraction = gap / (discriminant.sqrt() - b);
    (fraction <= 1.0).then_some(fraction)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn head_on() {
        let fraction = time_of_impact(&Vector3::new(10.0, 0.0, 0.0), &Vector3::new(-10.0, 0.0, 0.0), 2.0);
        assert!((fraction.unwrap() - 0.4).abs() < 1e-15);
    }

    #[test]
    fn a_near_miss_between_the_ends_is_none_and_a_graze_is_seen() {
        let pass = |offset| time_of_impact(&Vector3::new(5.0, offset, 0.0), &Vector3::new(-5.0, offset, 0.0), 1.0);
        assert_eq!(pass(1.0 + 1e-9), None);
        assert!((pass(1.0 - 1e-9).unwrap() - 0.5).abs() < 1e-4);
    }

    #[test]
    fn parting_late_and_overlapping() {
        assert_eq!(time_of_impact(&Vector3::new(2.0, 0.0, 0.0), &Vector3::new(9.0, 0.0, 0.0), 1.0), None);
        assert_eq!(time_of_impact(&Vector3::new(9.0, 0.0, 0.0), &Vector3::new(2.0, 0.0, 0.0), 1.0), None);
        assert_eq!(time_of_impact(&Vector3::new(0.5, 0.0, 0.0), &Vector3::new(9.0, 0.0, 0.0), 1.0), Some(0.0));
        assert_eq!(time_of_impact(&Vector3::new(2.0, 0.0, 0.0), &Vector3::new(2.0, 0.0, 0.0), 1.0), None);
    }
}
