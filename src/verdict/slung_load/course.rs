//! Quadrotor and load as a continuous motion: between dense instants a curve whose every point moves no faster than a
//! known speed.

use nalgebra::Vector3;
use sim::slung_load::Body;

/// Quadrotor and load at one time.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    /// Time, s.
    pub t_s: f64,
    /// Where they are.
    pub body: Body,
}

/// A motion through instants: positions between two of them are the cubic Hermite of their positions and velocities, the
/// attitude turns at a constant rate.
///
/// Instants are dense (5 ms apart at most), so that this follows the true motion within micrometres, a point of the body
/// within 0.1 mm. Two instants may share one time: what lies between them is a jump, not motion.
#[derive(Clone, Debug)]
pub struct Course {
    instants: Vec<Instant>,
}

/// Largest speeds within a segment.
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
}

impl Course {
    /// Through these instants, in the order of time.
    pub fn new(instants: Vec<Instant>) -> Self {
        Self { instants }
    }

    /// The instants.
    pub fn instants(&self) -> &[Instant] {
        &self.instants
    }

    /// The segments that last, by the index of the instant at which they begin.
    pub fn segments(&self) -> impl Iterator<Item = usize> + '_ {
        (1..self.instants.len()).map(|end| end - 1).filter(|index| self.duration_s(*index) > 0.0)
    }

    /// Time at the share `u` in [0, 1] of a segment, s.
    pub fn time_s(&self, segment: usize, u: f64) -> f64 {
        self.instants[segment].t_s + u * self.duration_s(segment)
    }

    /// Length of a segment, s.
    pub fn duration_s(&self, segment: usize) -> f64 {
        self.instants[segment + 1].t_s - self.instants[segment].t_s
    }

    /// Quadrotor and load at the share `u` in [0, 1] of a segment. Velocities and rates are those of its beginning.
    pub fn at(&self, segment: usize, u: f64) -> Body {
        let (a, b) = self.ends(segment);
        let [quadrotor, load] = self.control_points(segment);
        let turn = (a.attitude.inverse() * b.attitude).scaled_axis();
        Body {
            position_m: cubic(&quadrotor, u),
            load_position_m: cubic(&load, u),
            attitude: a.attitude * nalgebra::UnitQuaternion::from_scaled_axis(turn * u),
            ..*a
        }
    }

    /// Speeds that nothing in a segment exceeds: a cubic's derivative lies in the hull of its control points' differences.
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
        }
    }

    fn ends(&self, segment: usize) -> (&Body, &Body) {
        (&self.instants[segment].body, &self.instants[segment + 1].body)
    }

    /// Of the cubics of quadrotor and load, in Bernstein form.
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
