//! Single gusts at awkward instants, on a quadrotor and its load with the cable slack and taut.

use std::f64::consts::TAU;

use nalgebra::{SVector, Vector3};
use scenarios::slung_load::{Cable, GRAVITY_MPS2, Model, State};
use scenarios::{GustPulse, Wind};
use sim::{Flight, FlightOptions, fly_with};

use crate::arena::{plan, scenario, silent, trajectory};
use crate::plant::OPEN_LOOP;
use crate::reference_flight::{L_0, M_L, M_Q};

/// Step of the integrator, s.
const FINE_S: f64 = 5e-5;

fn pulses() -> Vec<GustPulse> {
    let pulse = |start_s, duration_s, peak_mps| GustPulse { start_s, duration_s, peak_mps };
    vec![
        pulse(0.0333, 0.0087, [0.0, 25.0, 0.0]),
        pulse(0.06, 0.002, [60.0, 0.0, 0.0]),
        pulse(0.08, 0.09, [0.0, -8.0, 0.0]),
    ]
}

fn wind_mps(t_s: f64) -> Vector3<f64> {
    let pulses = pulses();
    let blowing = pulses.iter().filter(|it| (0.0..=1.0).contains(&((t_s - it.start_s) / it.duration_s)));
    let gust =
        |it: &GustPulse| Vector3::from(it.peak_mps) * (0.5 - 0.5 * (TAU * (t_s - it.start_s) / it.duration_s).cos());
    blowing.map(gust).sum()
}

/// Level flight for 0.2 s under a constant total thrust, N.
fn flown(load_below_m: f64, cable: Cable, total_n: f64, drag_areas_m2: [f64; 2], halvings: u32) -> Flight {
    let start = State {
        position_m: [0.0; 3],
        velocity_mps: [0.0; 3],
        roll_pitch_yaw_rad: [0.0; 3],
        body_rate_radps: [0.0; 3],
        load_position_m: [0.0, 0.0, -load_below_m],
        load_velocity_mps: [0.0; 3],
    };
    let nodes = [0.0, 0.2].map(|t_s| (t_s, start, [total_n / 4.0; 4], cable));
    let mut scenario = scenario();
    scenario.world.ground_m = None;
    scenario.simulation.coast_s = 0.0;
    scenario.simulation.wind = Some(Wind { mean_mps: [0.0; 3], gusts: None, pulses: pulses() });
    let model: &mut Model = scenario.models.slung_load.get_mut("quad").unwrap();
    [model.drag_area_m2, model.load_drag_area_m2] = drag_areas_m2;
    let options = FlightOptions { halvings, ..OPEN_LOOP };
    fly_with(&scenario, &plan(trajectory(&nodes)), 0, &options, &mut silent)
}

/// Positions at every sample of a body that starts at rest in the air, accelerated upwards, m.
fn reference_m(flight: &Flight, drag_area_m2: f64, mass_kg: f64, up_mps2: f64) -> Vec<Vector3<f64>> {
    let rate = |state: &SVector<f64, 7>| {
        let velocity: Vector3<f64> = state.fixed_rows::<3>(3).into();
        let relative = wind_mps(state[6]) - velocity;
        let mut rate = SVector::<f64, 7>::zeros();
        rate.fixed_rows_mut::<3>(0).copy_from(&velocity);
        let drag = relative * (relative.norm() * 0.5 * 1.225 * drag_area_m2 / mass_kg);
        rate.fixed_rows_mut::<3>(3).copy_from(&(drag + Vector3::z() * up_mps2));
        rate[6] = 1.0;
        rate
    };
    let mut state = SVector::<f64, 7>::zeros();
    let positions = flight.vehicles[0].samples.iter().map(|sample| {
        while state[6] < sample.t_s - 1e-9 {
            let k1 = rate(&state);
            let k2 = rate(&(state + k1 * (FINE_S / 2.0)));
            let k3 = rate(&(state + k2 * (FINE_S / 2.0)));
            let k4 = rate(&(state + k3 * FINE_S));
            state += (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (FINE_S / 6.0);
        }
        state.fixed_rows::<3>(0).into_owned()
    });
    positions.collect()
}

/// Largest distances of quadrotor and load from their references, m.
fn errors_m(flight: &Flight, [quadrotor, load]: [Vec<Vector3<f64>>; 2], load_below_m: f64) -> f64 {
    let log = &flight.vehicles[0];
    let below_m = Vector3::z() * load_below_m;
    let of_body = log.samples.iter().zip(quadrotor).map(|(it, wanted)| (Vector3::from(it.position_m) - wanted).norm());
    let of_load =
        log.loads.iter().zip(load).map(|(it, wanted)| (Vector3::from(it.position_m) + below_m - wanted).norm());
    of_body.chain(of_load).fold(0.0, f64::max)
}

#[test]
fn gusts_move_a_quadrotor_and_a_falling_load_each_by_what_they_should() {
    let areas_m2 = [0.05, 0.01];
    let error_m = |halvings| {
        let flight = flown(0.1, Cable::Slack, M_Q * GRAVITY_MPS2, areas_m2, halvings);
        let wanted =
            [reference_m(&flight, areas_m2[0], M_Q, 0.0), reference_m(&flight, areas_m2[1], M_L, -GRAVITY_MPS2)];
        assert!(wanted[0].last().unwrap().norm() > 1e-3);
        errors_m(&flight, wanted, 0.1)
    };
    assert!(error_m(0) < 1e-6, "{} m", error_m(0));
    assert!(error_m(1) < 0.4 * error_m(0) + 1e-10, "{} m, {} m", error_m(0), error_m(1));
}

/// Quadrotor and load with drag in the ratio of their masses drift together: the cable stays straight down.
#[test]
fn gusts_move_a_taut_pair_together() {
    let (areas_m2, total_n) = ([0.05, 0.05 * M_L / M_Q], (M_Q + M_L) * GRAVITY_MPS2);
    let flight = flown(L_0, Cable::Taut, total_n, areas_m2, 0);
    let wanted = [areas_m2[0] / M_Q; 2].map(|ratio| reference_m(&flight, ratio, 1.0, 0.0));
    let error_m = errors_m(&flight, wanted, L_0);
    assert!(error_m < 5e-6, "{error_m} m");
}
