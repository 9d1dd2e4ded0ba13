use scenarios::fixed_wing::{Control, Limits};

use super::air_path::{AirPath, acceleration_mps2, gravity_mps2};
use super::reference::ReferencePoint;
use crate::sensors::Measurement;

/// Follows a reference from measurements: feed-forward of the planned load factors, feedback on position and velocity.
///
/// ```text
/// a_cmd = a_ref + ω² (p_ref - p) + 2 ζ ω (v_ref - v)
/// ```
///
/// with a_ref the acceleration of the planned load factors along the reference. For a consistent plan, without
/// disturbance and inside the limits, the error obeys e'' + 2 ζ ω e' + ω² e = 0; an inconsistency of the plan acts as a
/// disturbance. The tracker knows neither the wind nor the true mass: it takes the velocity over ground for the
/// velocity through the air.
#[derive(Clone, Debug)]
pub(super) struct Tracker {
    /// ω², 1/s².
    position_gain: f64,
    /// 2 ζ ω, 1/s.
    velocity_gain: f64,
    /// Time for which a command is held, s.
    step_s: f64,
}

impl Tracker {
    pub fn new(settings: &scenarios::Tracker, step_s: f64) -> Self {
        let ω = settings.natural_frequency_radps;
        Self { position_gain: ω * ω, velocity_gain: 2.0 * settings.damping_ratio * ω, step_s }
    }

    /// Load factors to hold over the coming step, before any limit.
    ///
    /// - `measured`, `reference`: now, for the feedback
    /// - `ahead`: the reference half a step ahead, for the feed-forward
    ///
    /// The load factors refer to the axes of the air path half a step ahead, so that holding the command causes no lag
    /// of first order.
    pub fn command(&self, measured: &Measurement, reference: &ReferencePoint, ahead: &ReferencePoint) -> Control {
        let acceleration_mps2 = acceleration_mps2(&ahead.velocity_mps, ahead.control)
            + (reference.position_m - measured.position_m) * self.position_gain
            + (reference.velocity_mps - measured.velocity_mps) * self.velocity_gain;
        let velocity_mps = measured.velocity_mps + acceleration_mps2 * (self.step_s / 2.0);
        AirPath::new(&velocity_mps).load_factors(&(acceleration_mps2 - gravity_mps2()))
    }
}

/// The command with each load factor clamped to its physical limits.
pub(super) fn saturated(command: Control, limits: &Limits) -> Control {
    let ranges = limits.controls();
    let command: [f64; 3] = command.to_array();
    Control::from_array(std::array::from_fn(|axis| command[axis].clamp(ranges[axis].min, ranges[axis].max)))
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use scenarios::Range;

    use super::*;

    /// A reference whose load factors produce `acceleration_mps2`, and whose second derivative is something else.
    fn point(position_m: Vector3<f64>, velocity_mps: Vector3<f64>, acceleration_mps2: Vector3<f64>) -> ReferencePoint {
        let control = AirPath::new(&velocity_mps).load_factors(&(acceleration_mps2 - gravity_mps2()));
        ReferencePoint { position_m, velocity_mps, acceleration_mps2: Vector3::repeat(9.0), control }
    }

    #[test]
    fn the_command_obeys_the_feedback_law_half_a_step_ahead() {
        let tracker = Tracker::new(&scenarios::Tracker { natural_frequency_radps: 0.6, damping_ratio: 0.8 }, 0.02);
        let (p, v) = (Vector3::new(10.0, 20.0, 400.0), Vector3::new(30.0, 12.0, -1.0));
        let (δp, δv, a) = (Vector3::new(1.0, -2.0, 0.5), Vector3::new(-0.3, 0.2, 0.1), Vector3::new(0.1, 0.8, -0.2));
        let reference = point(p + δp, v + δv, a);
        let command = tracker.command(&Measurement { position_m: p, velocity_mps: v }, &reference, &reference);
        let law = a + δp * 0.36 + δv * (2.0 * 0.8 * 0.6);
        assert!((acceleration_mps2(&(v + law * 0.01), command) - law).norm() < 1e-13);
    }

    #[test]
    fn saturation_clamps_each_component_to_its_own_limits() {
        let limits = Limits {
            altitude_m: Range::new(0.0, 1e3),
            speed_mps: Range::new(20.0, 50.0),
            flight_path_deg: Range::new(-10.0, 10.0),
            n_x: Range::new(-0.3, 0.25),
            n_y: Range::new(-0.4, 0.4),
            n_z: Range::new(0.7, 1.3),
        };
        let control = saturated(Control { n_x: 2.0, n_y: 0.1, n_z: -3.0 }, &limits);
        assert_eq!(control, Control { n_x: 0.25, n_y: 0.1, n_z: 0.7 });
    }
}
