//! Replay of a fixed wing's log: its controls and air determine its motion.

use scenarios::{CheckSpec, Scenario, Wind};
use sim::fixed_wing::{AppliedControls, Knot, Replay};
use sim::{Flight, LoggedAir, Sample, VehicleLog};

use crate::verdict::evidence::CheckResult;
use crate::verdict::physics::{Defect, check_largest, difference_m};

/// Largest distance between a log and the motion that an independent integrator makes of its controls and air, restarted at
/// the beginning of every window.
///
/// A window is 2/ω long, with the natural frequency ω of the tracker. A constant error d of the acceleration grows to
/// d/2 (2/ω)² = 2 d/ω² within it, twice its steady state in closed loop. So the value is also a conservative estimate of the
/// distance between this flight and one with the better integrator.
pub fn check(spec: &CheckSpec, scenario: &Scenario, flight: &Flight) -> CheckResult {
    let window_s = 2.0 / scenario.simulation.tracker.natural_frequency_radps;
    let replay = Replay::new(scenario.simulation.mismatch.mass_ratio);
    let wind = scenario.simulation.wind.as_ref();
    check_largest(spec, scenario, flight, |_, log| Ok(largest_defect(log, wind, window_s, &replay)))
}

/// Of one aircraft. `None` if its log has no step.
fn largest_defect(log: &VehicleLog, wind: Option<&Wind>, window_s: f64, replay: &Replay) -> Option<Defect> {
    let mut worst: Option<Defect> = None;
    let mut began_s = f64::NEG_INFINITY;
    let mut motion = knot(log.samples.first()?);
    for pair in log.samples.windows(2) {
        if pair[0].t_s - began_s >= window_s {
            (motion, began_s) = (knot(&pair[0]), pair[0].t_s);
        }
        let applied = AppliedControls {
            control: pair[0].load_factors().control,
            air: LoggedAir::new(wind, [&pair[0], &pair[1]]),
        };
        motion = replay.advanced(&motion, &applied);
        let logged = knot(&pair[1]);
        let defect_m = difference_m(
            &(motion.position_m - logged.position_m),
            &((motion.velocity_mps - logged.velocity_mps) * window_s),
        );
        let defect = Defect { defect_m, t_s: pair[1].t_s };
        worst = Some(worst.map_or(defect, |worst| worst.worse(defect)));
    }
    worst
}

fn knot(sample: &Sample) -> Knot {
    Knot { t_s: sample.t_s, position_m: sample.position_m.into(), velocity_mps: sample.velocity_mps.into() }
}
