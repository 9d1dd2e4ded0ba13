use crate::flight::EventKind;

/// Breaks of a saturation that are shorter than this, s, are not reported: noise at a limit would fill the log.
const MIN_BREAK_S: f64 = 0.5;

/// Turns "the command is saturated" at each step into events at the beginning and end of a saturation.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SaturationDetector {
    is_saturated: bool,
    /// Since when the command has been inside its limits again, s.
    free_since_s: Option<f64>,
}

impl SaturationDetector {
    /// Observes one step. Returns an event with its time, s. The end of a saturation is reported once the break has
    /// lasted long enough, with the time at which the break began.
    pub fn observe(&mut self, t_s: f64, is_saturated: bool) -> Option<(f64, EventKind)> {
        if is_saturated {
            self.free_since_s = None;
            return (!std::mem::replace(&mut self.is_saturated, true)).then_some((t_s, EventKind::SaturationBegan));
        }
        let since_s = *self.free_since_s.get_or_insert(t_s);
        if t_s - since_s >= MIN_BREAK_S { self.finish() } else { None }
    }

    /// Ends the flight. Returns the end of a saturation that was still pending.
    pub fn finish(&mut self) -> Option<(f64, EventKind)> {
        let since_s = self.free_since_s?;
        std::mem::replace(&mut self.is_saturated, false).then_some((since_s, EventKind::SaturationEnded))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn events(saturated: &[u8]) -> Vec<(f64, EventKind)> {
        let mut detector = SaturationDetector::default();
        let steps = saturated.iter().enumerate();
        let mut events: Vec<_> = steps.flat_map(|(step, on)| detector.observe(step as f64 * 0.25, *on == 1)).collect();
        events.extend(detector.finish());
        events
    }

    #[test]
    fn begins_and_ends_with_the_limits() {
        let expected = vec![(0.25, EventKind::SaturationBegan), (0.75, EventKind::SaturationEnded)];
        assert_eq!(events(&[0, 1, 1, 0, 0, 0, 0]), expected);
    }

    #[test]
    fn a_short_break_is_not_reported() {
        let expected = vec![(0.0, EventKind::SaturationBegan), (1.0, EventKind::SaturationEnded)];
        assert_eq!(events(&[1, 0, 0, 1, 0]), expected);
    }

    #[test]
    fn without_saturation_nothing_happens() {
        assert_eq!(events(&[0, 0, 0, 0]), vec![]);
    }
}
