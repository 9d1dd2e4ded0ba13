//! The tracker on hand-made plans.

use nalgebra::Vector3;
use scenarios::slung_load::{Cable, Control, GRAVITY_MPS2, State};
use scenarios::{GustPulse, Mismatch, Scenario, Sensors, Wind};
use sim::slung_load::{Plant, SlungLoadState, propagate};
use sim::{EventKind, Flight, fly};

use crate::arena::{model, plan, scenario, silent, trajectory};
use crate::flatness::Swing;

fn swing() -> Swing {
    Swing {
        from_m: Vector3::new(-2.0, 0.0, 0.65),
        to_m: Vector3::new(2.0, 0.0, 0.85),
        bow_m: Vector3::new(0.0, -1.2, 0.0),
        duration_s: 6.0,
    }
}

fn flown(change: impl FnOnce(&mut Scenario)) -> Flight {
    let mut scenario = scenario();
    change(&mut scenario);
    fly(&scenario, &plan(swing().plan(&scenario.models.slung_load["quad"])), 1, &mut silent)
}

fn max_error_m(flight: &Flight) -> f64 {
    let error = |(a, b): ([f64; 3], [f64; 3])| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
    let samples = flight.vehicles[0].samples.iter();
    samples.map(|sample| error((sample.position_m, sample.reference_position_m))).fold(0.0, f64::max)
}

fn max_load_error_m(flight: &Flight) -> f64 {
    let error = |(a, b): ([f64; 3], [f64; 3])| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
    let samples = flight.vehicles[0].loads.iter();
    samples.map(|sample| error((sample.position_m, sample.reference_position_m))).fold(0.0, f64::max)
}

fn report(what: &str, flight: &Flight) {
    let saturated = flight.vehicles[0].samples.iter().filter(|sample| sample.is_saturated()).count();
    println!(
        "{what}: error {:.4} m, load {:.4} m, saturated {saturated} of {}, {} events",
        max_error_m(flight),
        max_load_error_m(flight),
        flight.vehicles[0].samples.len(),
        flight.events.len()
    );
}

#[test]
fn the_plan_from_flatness_obeys_the_equations() {
    let plant = Plant::nominal(&model(), None);
    let trajectory = swing().plan(&model());
    let thrusts = trajectory.controls.iter().flat_map(|control| control.thrust_n);
    println!("thrusts from {:?} to {:?} N", thrusts.clone().reduce(f64::min), thrusts.reduce(f64::max));
    for k in 0..trajectory.times_s.len() - 1 {
        let start = SlungLoadState::from(&trajectory.states[k]);
        let controls = [&trajectory.controls[k], &trajectory.controls[k + 1]];
        let end =
            propagate(&plant, &start, controls, Cable::Taut, [trajectory.times_s[k], trajectory.times_s[k + 1]], 0.01);
        let (end, next) = (end.last().unwrap().state, SlungLoadState::from(&trajectory.states[k + 1]));
        assert!((end.position_m - next.position_m).norm() < 1e-7, "{k}");
        assert!(
            (end.velocity_mps - next.velocity_mps).norm() < 1e-4,
            "{k}: {}",
            (end.velocity_mps - next.velocity_mps).norm()
        );
        assert!((end.load_velocity_mps - next.load_velocity_mps).norm() < 1e-4, "{k}");
        assert!(end.attitude.angle_to(&next.attitude) < 1e-4, "{k}");
        assert!((end.body_rate_radps - next.body_rate_radps).norm() < 1e-2, "{k}");
    }
}

#[test]
fn the_undisturbed_flight_follows_the_plan() {
    let flight = flown(|_| {});
    report("undisturbed", &flight);
    assert!(max_error_m(&flight) < 1e-4, "{}", max_error_m(&flight));
    assert!(max_load_error_m(&flight) < 1e-4);
    assert!(flight.events.is_empty(), "{:?}", flight.events);
}

/// Quadrotor and load are offset together, so that the cable keeps its length.
#[test]
fn the_start_is_drawn_from_the_disc_of_the_scenario() {
    let [nominal, drawn] = [0.0, 0.04].map(|radius_m| {
        let flight = flown(|s| s.simulation.mismatch.start_radius_m = radius_m);
        let log = &flight.vehicles[0];
        [log.samples[0].position_m, log.loads[0].position_m].map(Vector3::from)
    });
    let offset_m = drawn[0] - nominal[0];
    assert!(0.0 < offset_m.norm() && offset_m.norm() <= 0.04 && offset_m.z == 0.0, "{offset_m}");
    assert!((drawn[1] - nominal[1] - offset_m).norm() < 1e-12);
}

#[test]
fn disturbed_flights_stay_close_to_the_plan() {
    let mass =
        flown(|s| s.simulation.mismatch = Mismatch { mass_ratio: 1.05, load_mass_ratio: 1.05, ..Mismatch::default() });
    report("mass", &mass);
    let noise = flown(|s| s.simulation.sensors = sensors());
    report("noise", &noise);
    let gust = flown(gusts);
    report("gust", &gust);
    let lag = flown(|s| s.models.slung_load.get_mut("quad").unwrap().rotor_time_constant_s = Some(0.03));
    report("lag", &lag);
    let all = flown(|s| {
        s.simulation.mismatch = Mismatch { mass_ratio: 1.05, load_mass_ratio: 1.05, ..Mismatch::default() };
        s.simulation.sensors = sensors();
        gusts(s);
    });
    report("all", &all);
    for flight in [mass, noise, gust, lag, all] {
        assert!(max_error_m(&flight) < 0.02, "{}", max_error_m(&flight));
        assert!(max_load_error_m(&flight) < 0.03, "{}", max_load_error_m(&flight));
    }
}

fn sensors() -> Sensors {
    Sensors {
        position_noise_m: 0.005,
        velocity_noise_mps: 0.02,
        attitude_noise_deg: 0.2,
        rate_noise_degps: 1.0,
        load_position_noise_m: 0.01,
        load_velocity_noise_mps: 0.05,
        ..Sensors::default()
    }
}

fn gusts(scenario: &mut Scenario) {
    let model = scenario.models.slung_load.get_mut("quad").unwrap();
    (model.drag_area_m2, model.load_drag_area_m2) = (0.02, 0.004);
    let pulse = GustPulse { start_s: 1.0, duration_s: 1.5, peak_mps: [0.0, 3.0, 0.0] };
    scenario.simulation.wind = Some(Wind { mean_mps: [0.0; 3], gusts: None, pulses: vec![pulse] });
}

/// Drop and catch: slack over a fall of 0.2 m, then the impact, then a deceleration to rest.
#[test]
fn a_catch_is_flown_through() {
    let model = model();
    let plant = Plant::nominal(&model, None);
    let hover_n = [model.mass_kg * GRAVITY_MPS2 / 4.0; 4];
    let brake_n = [(model.mass_kg + model.load_mass_kg) * (GRAVITY_MPS2 + 2.0) / 4.0; 4];
    let start = State {
        position_m: [0.0, 0.0, 2.0],
        velocity_mps: [0.0; 3],
        roll_pitch_yaw_rad: [0.0; 3],
        body_rate_radps: [0.0; 3],
        load_position_m: [0.0, 0.0, 2.0 - 0.45],
        load_velocity_mps: [0.0; 3],
    };
    let fall_s = (2.0 * 0.2 / GRAVITY_MPS2).sqrt();
    let (hover, brake) = (Control { thrust_n: hover_n }, Control { thrust_n: brake_n });
    let before = propagate(&plant, &SlungLoadState::from(&start), [&hover; 2], Cable::Slack, [0.0, fall_s], 0.01)
        .last()
        .unwrap()
        .state;
    let (after, impulse_ns) = sim::slung_load::impact(&plant, &before);
    // Both fall at the same speed; brake at 2 m/s².
    let speed_mps = -after.velocity_mps.z;
    let brake_s = speed_mps / 2.0;
    let end = propagate(&plant, &after, [&brake; 2], Cable::Taut, [fall_s, fall_s + brake_s], 0.01);
    let end = end.last().unwrap().state;
    let hover_both_n = [model.hover_thrust_n(); 4];
    let rest = State::from(&end);
    let t = fall_s + brake_s;
    let nodes = [
        (0.0, start, hover_n, Cable::Slack),
        (fall_s, State::from(&before), hover_n, Cable::Slack),
        (fall_s, State::from(&after), brake_n, Cable::Taut),
        (t, rest, brake_n, Cable::Taut),
        (t, rest, hover_both_n, Cable::Taut),
        (t + 1.0, rest, hover_both_n, Cable::Taut),
    ];
    let flight = fly(&scenario(), &plan(trajectory(&nodes)), 1, &mut silent);
    report("catch", &flight);
    println!("{:?}, planned {fall_s} s, {impulse_ns} N s", flight.events);
    let [event] = flight.events.as_slice() else { panic!("{:?}", flight.events) };
    let EventKind::CableTaut { impulse_ns: flown_ns } = event.kind else { panic!("{event:?}") };
    assert!((event.t_s - fall_s).abs() < 0.005 && (flown_ns - impulse_ns).abs() < 0.02);
    assert!(max_error_m(&flight) < 0.01, "{}", max_error_m(&flight));
}
