//! From differential equations to rows between neighbouring nodes.

use scenarios::Transcription;

use super::dynamics::State;
use super::interval::{Defect, Interval};
use super::{shooting, trapezoid};

/// The defect alone.
pub fn defect(transcription: Transcription, interval: &Interval) -> State {
    match transcription {
        Transcription::Trapezoid => trapezoid::defect(interval),
        Transcription::Shooting => shooting::defect(interval),
    }
}

/// The defect with its derivatives.
pub fn linearise(transcription: Transcription, interval: &Interval) -> Defect {
    match transcription {
        Transcription::Trapezoid => trapezoid::linearise(interval),
        Transcription::Shooting => shooting::linearise(interval),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scp::dynamics::Control;

    fn interval() -> Interval {
        Interval {
            states: [State::new(0.0, 0.0, 400.0, 34.0, 0.3, 0.02), State::new(190.0, 75.0, 405.0, 35.5, 0.45, -0.01)],
            controls: [Control::new(0.05, 0.12, 1.01), Control::new(-0.08, -0.15, 0.97)],
            dt_s: 5.8,
            ramp: 1.0,
        }
    }

    fn check(transcription: Transcription, ramp: f64) {
        let at = Interval { ramp, ..interval() };
        let exact = linearise(transcription, &at);
        assert!((exact.value - defect(transcription, &at)).amax() < 1e-12);
        let difference = |change: &dyn Fn(&mut Interval, f64)| {
            let ε = 1e-5;
            let (mut plus, mut minus) = (at, at);
            change(&mut plus, ε);
            change(&mut minus, -ε);
            (defect(transcription, &plus) - defect(transcription, &minus)) / (2.0 * ε)
        };
        for end in 0..2 {
            for j in 0..6 {
                let column = difference(&|interval, ε| interval.states[end][j] += ε);
                assert!((column - exact.by_states[end].column(j)).amax() < 1e-6, "{transcription:?} state {end} {j}");
            }
            for j in 0..3 {
                let column = difference(&|interval, ε| interval.controls[end][j] += ε);
                assert!(
                    (column - exact.by_controls[end].column(j)).amax() < 1e-5,
                    "{transcription:?} control {end} {j}"
                );
            }
        }
        let column = difference(&|interval, ε| interval.dt_s += ε);
        assert!((column - exact.by_dt).amax() < 1e-6, "{transcription:?} dt");
    }

    #[test]
    fn trapezoid_jacobians_agree_with_differences() {
        check(Transcription::Trapezoid, 1.0);
    }

    #[test]
    fn shooting_jacobians_agree_with_differences() {
        check(Transcription::Shooting, 1.0);
        check(Transcription::Shooting, 0.25);
    }
}
