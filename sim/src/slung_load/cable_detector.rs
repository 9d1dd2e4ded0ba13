use scenarios::slung_load::Cable;

use crate::flight::EventKind;

/// Minimum duration of a taut or slack phase, s. Shorter ones are not reported: rounding and ripple would fill the log.
pub const MIN_PHASE_S: f64 = 0.01;
/// The impulse of the impact is that of the cable over this time after the switch, s.
const IMPACT_S: f64 = 0.0015;

/// Turns the state of the cable at each step of the plant into events at its switches.
#[derive(Clone, Copy, Debug)]
pub(super) struct CableDetector {
    cable: Cable,
    /// Since when the cable has been in the other state, s, and the impulse since then, N s.
    other: Option<(f64, f64)>,
}

impl CableDetector {
    pub fn new(cable: Cable) -> Self {
        Self { cable, other: None }
    }

    /// The state of the cable after the last reported switch.
    pub fn cable(&self) -> Cable {
        self.cable
    }

    /// Observes one step that began at `t_s`, s. Returns a switch with its time, s, once its phase has lasted long
    /// enough.
    pub fn observe(&mut self, t_s: f64, step_s: f64, cable: Cable, impulse_ns: f64) -> Option<(f64, EventKind)> {
        if cable == self.cable {
            self.other = None;
            return None;
        }
        let (since_s, impact_ns) = self.other.get_or_insert((t_s, 0.0));
        if t_s - *since_s < IMPACT_S {
            *impact_ns += impulse_ns;
        }
        let (since_s, impact_ns) = (*since_s, *impact_ns);
        if t_s + step_s - since_s < MIN_PHASE_S {
            return None;
        }
        self.cable = cable;
        self.other = None;
        let kind = match cable {
            Cable::Taut => EventKind::CableTaut { impulse_ns: impact_ns },
            Cable::Slack => EventKind::CableSlack,
        };
        Some((since_s, kind))
    }
}
