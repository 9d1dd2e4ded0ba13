use scenarios::GustPulse;

use crate::air::overlaps;
use crate::request::FlightRequest;

/// Steps of the plant for each single gust, at least.
const STEPS_PER_PULSE: f64 = 16.0;

/// A thousandth of a thousandth of a step is rounding, not time.
const ROUNDING: f64 = 1e-6;

/// Into how many steps of the plant each step of the simulator is divided. A command is held, and the log written, once
/// per step of the simulator.
#[derive(Clone, Debug)]
pub(crate) struct PlantSteps {
    step_s: f64,
    max_plant_step_s: f64,
    pulses: Vec<GustPulse>,
    halvings: u32,
}

impl PlantSteps {
    /// For plants whose step is at most `max_plant_step_s`, s.
    pub fn new(request: &FlightRequest<'_>, max_plant_step_s: f64) -> Self {
        let wind = request.scenario.simulation.wind.as_ref();
        Self {
            step_s: request.step_s(),
            max_plant_step_s,
            pulses: wind.map_or_else(Vec::new, |wind| wind.pulses.clone()),
            halvings: request.options.halvings,
        }
    }

    /// The steps of the plant within the simulator's step that begins at `t_s`: their beginnings, s, and their length, s.
    pub fn within(&self, t_s: f64) -> (impl Iterator<Item = f64> + use<>, f64) {
        let pulses = self.pulses.iter().filter(|pulse| overlaps(pulse, [t_s, t_s + self.step_s]));
        let max_step_s =
            pulses.fold(self.max_plant_step_s, |max_s, pulse| max_s.min(pulse.duration_s / STEPS_PER_PULSE));
        let count = ((self.step_s / max_step_s - ROUNDING).ceil().max(1.0) as usize) << self.halvings;
        let plant_step_s = self.step_s / count as f64;
        ((0..count).map(move |step| t_s + step as f64 * plant_step_s), plant_step_s)
    }
}
