//! Velocity through the air in a flight: at every sample, and at the peak of every single gust between two of them.

use nalgebra::Vector3;
use scenarios::{GustPulse, Scenario, Wind};
use sim::{LoggedAir, Sample};

/// Times, s, and velocities relative to the air, world frame, m/s.
pub fn air_velocities<'a>(
    scenario: &'a Scenario,
    samples: &'a [Sample],
) -> impl Iterator<Item = (f64, [f64; 3])> + use<'a> {
    let wind = scenario.simulation.wind.as_ref();
    let pulses = wind.map_or(&[][..], |wind| wind.pulses.as_slice());
    let at_peaks = pulses.iter().filter_map(move |pulse| at_peak(wind, pulse, samples));
    samples.iter().map(|sample| (sample.t_s, sample.air_velocity_mps())).chain(at_peaks)
}

/// At the peak of a single gust; `None` if the samples do not extend on both sides of it.
fn at_peak(wind: Option<&Wind>, pulse: &GustPulse, samples: &[Sample]) -> Option<(f64, [f64; 3])> {
    let peak_s = pulse.start_s + pulse.duration_s / 2.0;
    let after = samples.partition_point(|sample| sample.t_s <= peak_s);
    let [before, after] = [samples.get(after.checked_sub(1)?)?, samples.get(after)?];
    let fraction = (peak_s - before.t_s) / (after.t_s - before.t_s);
    let [from_mps, to_mps] = [before, after].map(|sample| Vector3::from(sample.velocity_mps));
    let velocity_mps = from_mps + (to_mps - from_mps) * fraction;
    let air = LoggedAir::new(wind, [before, after]);
    Some((peak_s, (velocity_mps - air.velocity_mps(fraction)).into()))
}
