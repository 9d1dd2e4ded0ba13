use nalgebra::{Matrix3, Vector3};

use super::turbulence::Turbulence;
use crate::kinematics::PointState;

/// Turbulence around one vehicle over a step of the simulator, linear in time between samples.
///
/// A sample is taken at the end of every step, with the altitude, the airspeed and the axes of its beginning. The log
/// holds these samples, so that it determines the air of an ordinary flight at every instant. A flight with finer steps
/// has the same samples, and others between them.
#[derive(Clone, Debug)]
pub(super) struct GustPath {
    turbulence: Turbulence,
    mean_mps: Vector3<f64>,
    began_s: f64,
    step_s: f64,
    /// At equidistant instants, from the beginning of the step to its end, world frame, m/s.
    samples_mps: Vec<Vector3<f64>>,
}

impl GustPath {
    /// Around a vehicle that starts in this state.
    ///
    /// - `mean_mps`: the mean wind
    pub fn new(turbulence: Turbulence, mean_mps: Vector3<f64>, start: &PointState) -> Self {
        let first_mps = turbulence.gust_mps(start.position_m.z);
        let samples_mps = vec![world_from_gust(&mean_mps, &start.velocity_mps) * first_mps];
        Self { turbulence, mean_mps, began_s: 0.0, step_s: f64::INFINITY, samples_mps }
    }

    /// Continues from `t_s` to `t_s + step_s`, around a vehicle that is in this state, and has this airspeed, at `t_s`.
    pub fn advance(&mut self, t_s: f64, step_s: f64, vehicle: &PointState, airspeed_mps: f64) {
        let gusts_mps = self.turbulence.advance(step_s, vehicle.position_m.z, airspeed_mps);
        let world_from_gust = world_from_gust(&self.mean_mps, &vehicle.velocity_mps);
        self.samples_mps.drain(..self.samples_mps.len() - 1);
        self.samples_mps.extend(gusts_mps.iter().map(|gust_mps| world_from_gust * gust_mps));
        (self.began_s, self.step_s) = (t_s, step_s);
    }

    /// At an instant of the current step, world frame, m/s.
    pub fn velocity_mps(&self, t_s: f64) -> Vector3<f64> {
        let last = self.samples_mps.len() - 1;
        let place = ((t_s - self.began_s) / self.step_s).clamp(0.0, 1.0) * last as f64;
        let from = place as usize;
        self.samples_mps[from].lerp(&self.samples_mps[(from + 1).min(last)], place.fract())
    }
}

/// World from gust axes: u along the horizontal mean wind (without wind, along the vehicle's horizontal velocity), v to
/// its left, w up.
fn world_from_gust(mean_mps: &Vector3<f64>, vehicle_mps: &Vector3<f64>) -> Matrix3<f64> {
    let along = if mean_mps.xy().norm() > 0.0 { *mean_mps } else { vehicle_mps - mean_mps };
    let horizontal = Vector3::new(along.x, along.y, 0.0);
    let u = horizontal.try_normalize(1e-9).unwrap_or_else(Vector3::x);
    Matrix3::from_columns(&[u, Vector3::new(-u.y, u.x, 0.0), Vector3::z()])
}
