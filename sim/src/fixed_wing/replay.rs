use scenarios::fixed_wing::Control;

use super::air_path::{AirPath, gravity_mps2};
use super::propagate::Knot;
use crate::air::LoggedAir;
use crate::kinematics::PointState;
use crate::runge_kutta;

/// Controls and air of an aircraft over one step of the simulator.
#[derive(Clone, Debug)]
pub struct AppliedControls<'a> {
    /// Load factors, constant over the step.
    pub control: Control,
    /// The air.
    pub air: LoggedAir<'a>,
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
    pub fn advanced(&self, start: &Knot, AppliedControls { control, air }: &AppliedControls<'_>) -> Knot {
        let (step_s, intervals) = (air.step_s(), air.smooth_intervals());
        let PointState { position_m, velocity_mps } =
            runge_kutta::advanced_point(&start.point_state(), step_s, &intervals, |velocity_mps, fraction| {
                let air_path = AirPath::new(&(velocity_mps - air.velocity_mps(fraction)));
                air_path.specific_force_mps2(*control) / self.mass_ratio + gravity_mps2()
            });
        Knot { t_s: start.t_s + step_s, position_m, velocity_mps }
    }
}
