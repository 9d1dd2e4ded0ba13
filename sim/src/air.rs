//! The motion of the air around one vehicle: a constant mean, single gusts and continuous turbulence.

mod dryden;
mod turbulence;

use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;
use scenarios::GustPulse;

use turbulence::Turbulence;

/// Density of the air, kg/m³ (ICAO standard atmosphere, sea level).
const AIR_DENSITY_KGPM3: f64 = 1.225;

/// Drag on a body, N: half the density of the air times the drag area times the square of the relative speed.
///
/// - `relative_mps`: velocity of the air relative to the body
pub(crate) fn drag_n(relative_mps: &Vector3<f64>, drag_area_m2: f64) -> Vector3<f64> {
    relative_mps * (relative_mps.norm() * 0.5 * AIR_DENSITY_KGPM3 * drag_area_m2)
}

/// The air around one vehicle.
#[derive(Clone, Debug)]
pub(crate) struct Air {
    mean_mps: Vector3<f64>,
    turbulence: Option<Turbulence>,
    pulses: Vec<GustPulse>,
    t_s: f64,
}

impl Air {
    /// Air at rest without settings. The turbulence begins in its stationary distribution.
    pub fn new(settings: Option<&scenarios::Wind>, rng: ChaCha8Rng) -> Self {
        Self {
            mean_mps: settings.map_or_else(Vector3::zeros, |wind| wind.mean_mps.into()),
            turbulence: settings.and_then(|wind| wind.gusts.as_ref()).map(|gusts| Turbulence::new(gusts, rng)),
            pulses: settings.map_or_else(Vec::new, |wind| wind.pulses.clone()),
            t_s: 0.0,
        }
    }

    /// Velocity of the air now, world frame, m/s.
    ///
    /// - `altitude_m`: of the vehicle, above z = 0
    /// - `vehicle_mps`: velocity of the vehicle over ground
    pub fn velocity_mps(&self, altitude_m: f64, vehicle_mps: &Vector3<f64>) -> Vector3<f64> {
        let pulses = self.pulses.iter().map(|pulse| pulse_mps(pulse, self.t_s));
        let deterministic_mps = pulses.fold(self.mean_mps, |sum, pulse| sum + pulse);
        match &self.turbulence {
            Some(turbulence) => deterministic_mps + self.world_from_gust(vehicle_mps) * turbulence.gust_mps(altitude_m),
            None => deterministic_mps,
        }
    }

    /// Advances the air by `step_s` around a vehicle that flies at an airspeed, m/s.
    pub fn advance(&mut self, step_s: f64, altitude_m: f64, airspeed_mps: f64) {
        self.t_s += step_s;
        if let Some(turbulence) = &mut self.turbulence {
            turbulence.advance(step_s, altitude_m, airspeed_mps);
        }
    }

    /// World from gust axes: u along the horizontal mean wind (without wind, along the vehicle's horizontal velocity),
    /// v to its left, w up.
    fn world_from_gust(&self, vehicle_mps: &Vector3<f64>) -> nalgebra::Matrix3<f64> {
        let along = if self.mean_mps.xy().norm() > 0.0 { self.mean_mps } else { vehicle_mps - self.mean_mps };
        let horizontal = Vector3::new(along.x, along.y, 0.0);
        let u = horizontal.try_normalize(1e-9).unwrap_or_else(Vector3::x);
        nalgebra::Matrix3::from_columns(&[u, Vector3::new(-u.y, u.x, 0.0), Vector3::z()])
    }
}

/// Velocity of the air in a single gust at `t_s`, m/s, of 1 - cos shape.
fn pulse_mps(pulse: &GustPulse, t_s: f64) -> Vector3<f64> {
    let fraction = (t_s - pulse.start_s) / pulse.duration_s;
    let height =
        if (0.0..=1.0).contains(&fraction) { 0.5 * (1.0 - (std::f64::consts::TAU * fraction).cos()) } else { 0.0 };
    Vector3::from(pulse.peak_mps) * height
}
