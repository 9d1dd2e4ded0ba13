use scenarios::slung_load::Cable;

use crate::flight::EventKind;

/// A cable that is taut or slack for less than this, s, has not switched: rounding and ripple would fill the log.
pub const MIN_PHASE_S: f64 = 0.01;
/// The impulse of this long after the switch, s, is that of the impact.
const IMPACT_S: f64 = 0.0015;

/// Turns "the cable is taut" at each step of the simulator into events at its switches.
#[derive(Clone, Copy, Debug)]
pub(super) struct CableDetector {
    cable: Cable,
    /// Since when it has been the other, s, and the impulse at the beginning of it, N s.
    other: Option<(f64, f64)>,
}

impl CableDetector {
    pub fn new(cable: Cable) -> Self {
        Self { cable, other: None }
    }

    /// What the cable is held to be.
    pub fn cable(&self) -> Cable {
        self.cable
    }

    /// Takes in one step that began at `t_s`, s. Returns a switch with its time, s, once it has lasted.
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
