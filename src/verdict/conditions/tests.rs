use scenarios::{GustPulse, Gusts, Wind};
use sim::{Sample, VehicleLog};

use super::air_defect;
use crate::verdict::still_sample::still_sample;

/// A log of 4 s with this air.
fn log(wind_mps: impl Fn(f64) -> [f64; 3]) -> VehicleLog {
    let sample = |step: u32| {
        let t_s = f64::from(step) / 100.0;
        Sample { wind_mps: wind_mps(t_s), ..still_sample(t_s) }
    };
    VehicleLog { vehicle: "uav".into(), samples: (0..=400).map(sample).collect(), loads: Vec::new() }
}

fn wind(gusts: Option<Gusts>) -> Wind {
    let pulse = GustPulse { start_s: 1.0, duration_s: 2.0, peak_mps: [0.0, 4.0, 0.0] };
    Wind { mean_mps: [3.0, 0.0, 0.0], gusts, pulses: vec![pulse] }
}

/// The air of [`wind`] without turbulence: 3 m/s, and a pulse that peaks at 2 s.
fn prescribed(t_s: f64) -> [f64; 3] {
    let pulse = if (1.0..3.0).contains(&t_s) { 2.0 * (1.0 - (std::f64::consts::PI * (t_s - 1.0)).cos()) } else { 0.0 };
    [3.0, pulse, 0.0]
}

#[test]
fn air_without_turbulence_is_that_of_the_scenario_to_the_last_digit() {
    assert_eq!(air_defect(Some(&wind(None)), &log(prescribed)), None);
    assert_eq!(air_defect(None, &log(|_| [0.0; 3])), None);
    let off = |by: f64| log(move |t_s| prescribed(t_s).map(|it| it + if t_s > 3.5 { by } else { 0.0 }));
    for by in [1e-3, -1e-3, f64::NAN] {
        let defect = air_defect(Some(&wind(None)), &off(by)).expect("a defect");
        assert!(defect.starts_with("at 3.510 s the logged wind is"), "{defect}");
    }
}

/// Below 1000 ft the largest standard deviation is 0.2 of the wind at 20 ft, 2 m/s here: a gust may be 16 m/s, the mean 10 m/s.
#[test]
fn turbulence_is_bounded_by_its_intensity() {
    let gusts = |aloft| Some(Gusts { wind_at_20ft_mps: 10.0, sigma_aloft_mps: aloft });
    let turbulent = |amplitude: f64, mean: f64| {
        log(move |t_s| {
            let [x, y, z] = prescribed(t_s);
            [x + mean, y, z + amplitude * (40.0 * t_s).sin()]
        })
    };
    let defect = |aloft, amplitude, mean| air_defect(Some(&wind(gusts(aloft))), &turbulent(amplitude, mean));
    assert_eq!(defect(0.5, 15.5, 0.0), None);
    assert!(defect(0.5, 16.5, 0.0).unwrap().contains("too strong for the scenario's turbulence"));
    assert_eq!(defect(3.0, 16.5, 0.0), None);
    assert_eq!(defect(0.5, 1.0, 9.5), None);
    assert!(defect(0.5, 1.0, 10.5).unwrap().contains("the mean of its wind differs"));
    assert_eq!(defect(0.5, 0.0, 0.0).unwrap(), "the scenario has gusts, the log has none");
}
