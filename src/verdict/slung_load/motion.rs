//! Quadrotor and load as a continuous motion: curves through dense samples, with bounds of their speed.

use nalgebra::Vector3;
use sim::slung_load::SlungLoadState;

use crate::verdict::bernstein;

/// A larger mean acceleration within a segment is an impact, m/s².
pub const IMPACT_MPS2: f64 = 50.0;

/// Derivatives are not estimated from shorter segments, s: rounding would dominate them.
const MIN_SEGMENT_S: f64 = 1e-5;

/// Quadrotor and load at one instant.
#[derive(Clone, Copy, Debug)]
pub struct MotionSample {
    /// Time, s.
    pub t_s: f64,
    /// Their state.
    pub body: SlungLoadState,
}

/// A motion through samples: between two of them the positions are cubic Hermite curves and the attitude rotates at a
/// constant rate.
///
/// Samples are dense (at most 5 ms apart), so that positions are within micrometres of the true motion, and a point of the
/// body within 0.1 mm. Two samples may share one time; the jump between them is not motion.
#[derive(Clone, Debug)]
pub struct SlungLoadMotion {
    samples: Vec<MotionSample>,
    /// One per segment; empty if the curves are the motion itself.
    deviations: Vec<Deviation>,
}

/// Bounds of the difference between the true motion and the curves of a segment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// The quadrotor's centre, m.
    pub quadrotor_m: f64,
    /// The load, m.
    pub load_m: f64,
    /// The attitude, rad.
    pub turn_rad: f64,
}

/// Largest speeds and distances within a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speeds {
    /// Of the quadrotor's centre, m/s.
    pub quadrotor_mps: f64,
    /// Of the load, m/s.
    pub load_mps: f64,
    /// Of the load relative to the quadrotor, m/s.
    pub relative_mps: f64,
    /// Of the attitude, rad/s.
    pub turn_radps: f64,
    /// Distance of the load from the quadrotor, m.
    pub reach_m: f64,
}

impl SlungLoadMotion {
    /// Through these samples, in the order of time.
    pub fn new(samples: Vec<MotionSample>) -> Self {
        Self { samples, deviations: Vec::new() }
    }

    /// Treats the samples as those of a motion that is smooth except for impacts. Its interpolation errors are
    ///
    /// ```text
    /// |p - cubic| <= h⁴/384 max|p''''|,   |angle| <= h²/8 max|ω'|              for a smooth motion
    /// |p - cubic| <= 4/27 h |Δv|                                              for a jump of the velocity
    /// ```
    ///
    /// with twice the p'''' and ω' that adjacent segments give. In a segment that is too short for that, the deviation is
    /// bounded by the length of the curve.
    pub fn sampled(mut self) -> Self {
        let mut deviations = vec![Deviation::default(); self.samples.len().saturating_sub(1)];
        let (regular, short): (Vec<usize>, Vec<usize>) =
            self.segments().partition(|segment| self.duration_s(*segment) >= MIN_SEGMENT_S);
        for segment in short {
            deviations[segment] = self.extent(segment);
        }
        for pair in regular.windows(2) {
            let between = self.deviation_between(pair[0], pair[1]);
            for segment in pair {
                let so_far = &mut deviations[*segment];
                so_far.quadrotor_m = so_far.quadrotor_m.max(between.quadrotor_m);
                so_far.load_m = so_far.load_m.max(between.load_m);
                so_far.turn_rad = so_far.turn_rad.max(between.turn_rad);
            }
        }
        self.deviations = deviations;
        self
    }

    /// Bounds of the difference between the true motion and the curves of a segment.
    pub fn deviation(&self, segment: usize) -> Deviation {
        self.deviations.get(segment).copied().unwrap_or_default()
    }

    fn deviation_between(&self, one: usize, other: usize) -> Deviation {
        let [one_s, other_s] = [one, other].map(|segment| self.duration_s(segment));
        let (long_s, short_s) = (one_s.max(other_s), one_s.min(other_s));
        let jerk = |points: &[Vector3<f64>; 4], h: f64| {
            (points[3] - points[0] + (points[1] - points[2]) * 3.0) * 6.0 / h.powi(3)
        };
        let [one_points, other_points] = [one, other].map(|segment| self.control_points(segment));
        let deviation_m = |which: usize| {
            let change = (jerk(&one_points[which], one_s) - jerk(&other_points[which], other_s)).norm();
            let smooth_m = 2.0 / 384.0 * long_s.powi(4) / short_s * change;
            let jump_m = [(one_points[which], one_s), (other_points[which], other_s)].map(|(points, h)| {
                let jump_mps = ((points[3] - points[2]) - (points[1] - points[0])).norm() * 3.0 / h;
                if jump_mps > IMPACT_MPS2 * h { 4.0 / 27.0 * h * jump_mps } else { 0.0 }
            });
            smooth_m.max(jump_m[0]).max(jump_m[1])
        };
        let rate = |segment: usize, h: f64| {
            let (a, b) = self.ends(segment);
            (a.attitude.inverse() * b.attitude).scaled_axis() / h
        };
        let turn_rad = 2.0 / 8.0 * long_s * (rate(one, one_s) - rate(other, other_s)).norm();
        Deviation { quadrotor_m: deviation_m(0), load_m: deviation_m(1), turn_rad }
    }

    /// Largest displacements within a segment.
    fn extent(&self, segment: usize) -> Deviation {
        let speeds = self.speeds(segment);
        let duration_s = self.duration_s(segment);
        Deviation {
            quadrotor_m: speeds.quadrotor_mps * duration_s,
            load_m: speeds.load_mps * duration_s,
            turn_rad: speeds.turn_radps * duration_s,
        }
    }

    /// The samples.
    pub fn samples(&self) -> &[MotionSample] {
        &self.samples
    }

    /// The segments of positive duration, by the index of their first sample.
    pub fn segments(&self) -> impl Iterator<Item = usize> + '_ {
        (1..self.samples.len()).map(|end| end - 1).filter(|index| self.duration_s(*index) > 0.0)
    }

    /// Time at the fraction `u` in [0, 1] of a segment, s.
    pub fn time_s(&self, segment: usize, u: f64) -> f64 {
        self.samples[segment].t_s + u * self.duration_s(segment)
    }

    /// Duration of a segment, s.
    pub fn duration_s(&self, segment: usize) -> f64 {
        self.samples[segment + 1].t_s - self.samples[segment].t_s
    }

    /// Quadrotor and load at the fraction `u` in [0, 1] of a segment. Velocities and rates are those of its beginning.
    pub fn at(&self, segment: usize, u: f64) -> SlungLoadState {
        let (a, b) = self.ends(segment);
        let [quadrotor, load] = self.control_points(segment);
        let turn = (a.attitude.inverse() * b.attitude).scaled_axis();
        SlungLoadState {
            position_m: cubic(&quadrotor, u),
            load_position_m: cubic(&load, u),
            attitude: a.attitude * nalgebra::UnitQuaternion::from_scaled_axis(turn * u),
            ..*a
        }
    }

    /// Upper bounds of the speeds in a segment: the derivative of a cubic lies in the convex hull of the differences of its
    /// control points.
    pub fn speeds(&self, segment: usize) -> Speeds {
        let (a, b) = self.ends(segment);
        let duration_s = self.duration_s(segment);
        let [quadrotor, load] = self.control_points(segment);
        let relative: [Vector3<f64>; 4] = std::array::from_fn(|i| load[i] - quadrotor[i]);
        let fastest = |points: &[Vector3<f64>; 4]| {
            points.windows(2).map(|pair| (pair[1] - pair[0]).norm() * 3.0 / duration_s).fold(0.0, f64::max)
        };
        Speeds {
            quadrotor_mps: fastest(&quadrotor),
            load_mps: fastest(&load),
            relative_mps: fastest(&relative),
            turn_radps: a.attitude.angle_to(&b.attitude) / duration_s,
            reach_m: relative.iter().map(|point| point.norm()).fold(0.0, f64::max),
        }
    }

    /// Control points of quadrotor and load over a part of a segment, projected onto a direction, m.
    pub fn along(&self, segment: usize, fraction: [f64; 2], direction: &Vector3<f64>) -> [[f64; 4]; 2] {
        self.control_points(segment).map(|points| {
            let (until, _) = bernstein::split(&points.map(|point| point.dot(direction)), fraction[1]);
            bernstein::split(&until, fraction[0] / fraction[1]).1
        })
    }

    /// Control points of the load in a segment, m.
    pub fn load_points_m(&self, segment: usize) -> [Vector3<f64>; 4] {
        self.control_points(segment)[1]
    }

    /// The rotation within a segment, about an axis that is constant in the world frame: axis times angle, rad.
    pub fn turn_rad(&self, segment: usize) -> Vector3<f64> {
        let (a, b) = self.ends(segment);
        a.attitude * (a.attitude.inverse() * b.attitude).scaled_axis()
    }

    fn ends(&self, segment: usize) -> (&SlungLoadState, &SlungLoadState) {
        (&self.samples[segment].body, &self.samples[segment + 1].body)
    }

    /// Control points of the cubics of quadrotor and load, in Bernstein form.
    fn control_points(&self, segment: usize) -> [[Vector3<f64>; 4]; 2] {
        let (a, b) = self.ends(segment);
        let third_s = self.duration_s(segment) / 3.0;
        let points = |p0: &Vector3<f64>, v0: &Vector3<f64>, p1: &Vector3<f64>, v1: &Vector3<f64>| {
            [*p0, p0 + v0 * third_s, p1 - v1 * third_s, *p1]
        };
        [
            points(&a.position_m, &a.velocity_mps, &b.position_m, &b.velocity_mps),
            points(&a.load_position_m, &a.load_velocity_mps, &b.load_position_m, &b.load_velocity_mps),
        ]
    }
}

fn cubic(points: &[Vector3<f64>; 4], u: f64) -> Vector3<f64> {
    let v = 1.0 - u;
    points[0] * (v * v * v) + points[1] * (3.0 * v * v * u) + points[2] * (3.0 * v * u * u) + points[3] * (u * u * u)
}

#[cfg(test)]
mod tests {
    use nalgebra::{UnitQuaternion, Vector3};
    use sim::slung_load::SlungLoadState;

    use super::{MotionSample, SlungLoadMotion};

    /// A circle of 1 m at 1 m/s, and the same with every sample doubled a nanosecond later.
    #[test]
    fn samples_at_nearly_the_same_time_do_not_change_the_motion() {
        let at = |t_s: f64| {
            let (sin, cos) = t_s.sin_cos();
            let (position_m, velocity_mps) = (Vector3::new(cos, sin, 1.0), Vector3::new(-sin, cos, 0.0));
            let load_position_m = position_m - Vector3::z();
            let attitude = UnitQuaternion::from_euler_angles(0.0, 0.0, t_s);
            let (body_rate_radps, load_velocity_mps) = (Vector3::z(), velocity_mps);
            let body = SlungLoadState {
                position_m,
                velocity_mps,
                attitude,
                body_rate_radps,
                load_position_m,
                load_velocity_mps,
            };
            MotionSample { t_s, body }
        };
        let once: Vec<MotionSample> = (0..200).map(|k| at(0.005 * f64::from(k))).collect();
        let twice = once.iter().flat_map(|sample| [*sample, at(sample.t_s + 1e-9)]).collect();
        let largest_m = |samples: Vec<MotionSample>| {
            let motion = SlungLoadMotion::new(samples).sampled();
            let deviations = motion.segments().map(|segment| motion.deviation(segment).quadrotor_m);
            deviations.fold(0.0, f64::max)
        };
        let [smooth_m, doubled_m] = [largest_m(once), largest_m(twice)];
        assert!(smooth_m < 1e-9 && doubled_m < 1e-8, "{smooth_m} {doubled_m}");
    }
}
