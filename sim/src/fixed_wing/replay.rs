use nalgebra::Vector3;
use scenarios::fixed_wing::Control;

use super::air_path::{AirPath, gravity_mps2};
use super::propagate::Knot;
use crate::kinematics::PointState;
use crate::runge_kutta;

/// Controls and air of an aircraft over one step of the simulator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AppliedControls {
    /// Load factors, constant over the step.
    pub control: Control,
    /// Velocity of the air at the two ends of the step, linear in time between them, world frame, m/s.
    pub wind_mps: [Vector3<f64>; 2],
}

/// Replays a flight: load factors and air are taken from the log, the motion is integrated anew, by a method that shares
/// only the forces with the simulator.
///
/// ```text
/// p' = v,   v' = f(v - w(t)) / r + g        f: specific force of the load factors, r: mass ratio
/// ```
///
/// The Runge-Kutta method is of order 6, the simulator's of order 2: over 2.5 s with steps of 10 ms they differ by less
/// than a millimetre, nearly all of which is the simulator's error.
#[derive(Clone, Copy, Debug)]
pub struct Replay {
    mass_ratio: f64,
}

impl Replay {
    /// `mass_ratio`: true mass over the nominal mass with which load factors become forces.
    pub fn new(mass_ratio: f64) -> Self {
        Self { mass_ratio }
    }

    /// Integrates one step.
    ///
    /// - `start`: at the beginning of the step
    /// - `applied`: over the step
    /// - `end_s`: time at its end, later than that of `start`, s
    pub fn advanced(&self, start: &Knot, applied: &AppliedControls, end_s: f64) -> Knot {
        let PointState { position_m, velocity_mps } =
            runge_kutta::advanced_point(&start.point_state(), end_s - start.t_s, |velocity_mps, fraction| {
                let [from, to] = applied.wind_mps;
                let air_velocity_mps = velocity_mps - (from + (to - from) * fraction);
                let force = AirPath::new(&air_velocity_mps).specific_force_mps2(applied.control) / self.mass_ratio;
                force + gravity_mps2()
            });
        Knot { t_s: end_s, position_m, velocity_mps }
    }
}
