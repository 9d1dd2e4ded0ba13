//! The motion of the air around one vehicle: a constant mean, single gusts and continuous turbulence.
//!
//! All of it is a function of time over every step of the simulator, so that a plant may take as many steps within it as
//! it needs: the mean and the single gusts are known at every instant, the turbulence is linear between samples.

mod drag;
mod dryden;
mod gust_path;
mod logged;
mod pulse;
mod turbulence;

use nalgebra::Vector3;
use scenarios::{GustPulse, Vehicle};

pub(crate) use drag::{DragBody, drag_n};
pub use logged::LoggedAir;
pub(crate) use pulse::overlaps;

use crate::kinematics::PointState;
use crate::request::FlightRequest;
use gust_path::GustPath;
use turbulence::Turbulence;

/// The air around one vehicle.
#[derive(Clone, Debug)]
pub(crate) struct Air {
    mean_mps: Vector3<f64>,
    gusts: Option<GustPath>,
    pulses: Vec<GustPulse>,
}

impl Air {
    /// The air of a scenario around one of its vehicles. The turbulence begins in its stationary distribution.
    ///
    /// - `start`: of the vehicle
    pub fn new(request: &FlightRequest<'_>, vehicle: &Vehicle, start: &PointState) -> Self {
        let settings = request.scenario.simulation.wind.as_ref();
        let mean_mps = settings.map_or_else(Vector3::zeros, |wind| wind.mean_mps.into());
        let gusts = settings.and_then(|wind| wind.gusts.as_ref()).map(|gusts| {
            let halvings = 1..=request.options.halvings;
            let refinement = halvings.map(|halving| request.stream(&format!("gusts-{halving}"), vehicle)).collect();
            let turbulence = Turbulence::new(gusts, request.stream("gusts", vehicle), refinement);
            GustPath::new(turbulence, mean_mps, start)
        });
        Self { mean_mps, gusts, pulses: settings.map_or_else(Vec::new, |wind| wind.pulses.clone()) }
    }

    /// Begins a step of the simulator: continues the turbulence from `t_s` to `t_s + step_s`.
    ///
    /// - `vehicle`: at `t_s`
    pub fn begin_step(&mut self, t_s: f64, step_s: f64, vehicle: &PointState) {
        let airspeed_mps = (vehicle.velocity_mps - self.velocity_mps(t_s)).norm();
        if let Some(gusts) = &mut self.gusts {
            gusts.advance(t_s, step_s, vehicle, airspeed_mps);
        }
    }

    /// Velocity of the air at an instant of the current step, world frame, m/s.
    pub fn velocity_mps(&self, t_s: f64) -> Vector3<f64> {
        let gust_mps = self.gusts.as_ref().map_or_else(Vector3::zeros, |gusts| gusts.velocity_mps(t_s));
        self.mean_mps + pulse::sum_mps(&self.pulses, t_s) + gust_mps
    }
}
