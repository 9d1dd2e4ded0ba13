//! Single gusts between the samples of a log, as the judge sees them.

use harness::verdict::Status;
use scenarios::{GustPulse, Wind};

use crate::case::Case;

/// The flight in gusts of 40 ms, whose peaks lie between two samples.
fn gusty(peak_mps: f64) -> Case {
    let mut case = Case::good();
    case.model().drag_area_m2 = 0.05;
    let pulse =
        |k: u32| GustPulse { start_s: 1.005 + 0.05 * f64::from(k), duration_s: 0.04, peak_mps: [0.0, 0.0, peak_mps] };
    let pulses = (0..4).map(pulse).collect();
    case.scenario.simulation.wind = Some(Wind { mean_mps: [0.0; 3], gusts: None, pulses });
    case.fly();
    case
}

#[test]
fn a_log_in_gusts_is_explained_by_them_and_by_no_others() {
    let mut case = gusty(20.0);
    let dynamics = case.check("flight.dynamics");
    assert!(dynamics.status == Status::Pass && dynamics.value.unwrap() < 1e-4, "{dynamics:?}");
    // A shorter, stronger gust has the same samples, but other air between them.
    let wind = case.scenario.simulation.wind.as_mut().unwrap();
    wind.pulses.push(GustPulse { start_s: 2.0001, duration_s: 0.0098, peak_mps: [0.0, 0.0, 150.0] });
    assert_eq!(case.status("flight.conditions"), Status::Pass, "no sample shows it");
    let dynamics = case.check("flight.dynamics");
    assert!(dynamics.status == Status::Fail && (2.0..2.3).contains(&dynamics.at_s.unwrap()), "{dynamics:?}");
}

/// Airspeed is judged at the peak of a gust, even between samples.
#[test]
fn the_airspeed_at_the_peak_of_a_gust_counts() {
    for (peak_mps, wanted) in [(2.0, Status::Pass), (2.95, Status::Fail)] {
        let mut case = gusty(peak_mps);
        case.model().limits.speed_mps = 2.85;
        let airspeed_mps = |[x, y, z]: [f64; 3]| (x * x + y * y + z * z).sqrt();
        let sampled_mps = case.samples(0).iter().map(|it| airspeed_mps(it.air_velocity_mps())).fold(0.0, f64::max);
        assert!(sampled_mps < 2.85, "no sample shows it: {sampled_mps}");
        let check = case.check("flight.state_limits");
        assert_eq!(check.status, wanted, "{check:?}");
    }
}
