use crate::EventKind;

/// Interruptions of a saturation that are shorter than this, s, are not reported: noise at a limit would fill the log.
const SHORTEST_BREAK_S: f64 = 0.5;

/// Turns "the command is cut off" at each step into events at its beginning and end.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SaturationWatch {
    began: bool,
    /// Since when the command has been inside its limits again, s.
    free_since_s: Option<f64>,
}

impl SaturationWatch {
    /// Takes in one step. Returns an event with its time, s: an end is reported late, with the time when it began.
    pub fn observe(&mut self, t_s: f64, is_saturated: bool) -> Option<(f64, EventKind)> {
        if is_saturated {
            self.free_since_s = None;
            return (!std::mem::replace(&mut self.began, true)).then_some((t_s, EventKind::SaturationBegan));
        }
        let since_s = *self.free_since_s.get_or_insert(t_s);
        if t_s - since_s >= SHORTEST_BREAK_S { self.finish() } else { None }
    }

    /// The flight is over: reports an end that was still waiting.
    pub fn finish(&mut self) -> Option<(f64, EventKind)> {
        let since_s = self.free_since_s?;
        std::mem::replace(&mut self.began, false).then_some((since_s, EventKind::SaturationEnded))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn events(saturated: &[u8]) -> Vec<(f64, EventKind)> {
        let mut watch = SaturationWatch::default();
        let steps = saturated.iter().enumerate();
        let mut events: Vec<_> = steps.flat_map(|(step, on)| watch.observe(step as f64 * 0.25, *on == 1)).collect();
        events.extend(watch.finish());
        events
    }

    #[test]
    fn begins_and_ends_with_the_limits() {
        let expected = vec![(0.25, EventKind::SaturationBegan), (0.75, EventKind::SaturationEnded)];
        assert_eq!(events(&[0, 1, 1, 0, 0, 0, 0]), expected);
    }

    #[test]
    fn a_short_break_is_none() {
        let expected = vec![(0.0, EventKind::SaturationBegan), (1.0, EventKind::SaturationEnded)];
        assert_eq!(events(&[1, 0, 0, 1, 0]), expected);
    }

    #[test]
    fn without_saturation_nothing_happens() {
        assert_eq!(events(&[0, 0, 0, 0]), vec![]);
    }
}
