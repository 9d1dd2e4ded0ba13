//! Faults of flight logs of all families.

use sim::{Event, EventKind};

use super::super::{Fault, ReferenceCase};

/// The faults.
pub fn faults() -> Vec<Fault> {
    let mut all = incomplete();
    all.extend(not_numbers());
    all.extend(against_physics());
    all.extend(flattering());
    all
}

fn incomplete() -> Vec<Fault> {
    vec![
        Fault::new("flight.complete", "there is no flight", |it| it.flight = None),
        Fault::new("flight.complete", "a log is missing", |it| {
            it.flight().vehicles.pop();
        }),
        Fault::new("flight.complete", "a log is duplicated", |it| {
            let twice = it.flight().vehicles[0].clone();
            it.flight().vehicles.push(twice);
        }),
        Fault::new("flight.complete", "a log is that of another vehicle", |it| {
            it.flight().vehicles[0].vehicle.push('?');
        }),
        Fault::new("flight.complete", "a log is empty", |it| keep(it, 0.0)),
        Fault::new("flight.complete", "the last quarter of a flight is missing", |it| {
            let fraction = it.planned_steps() as f64 / it.steps() as f64;
            keep(it, 0.75 * fraction);
        }),
        Fault::new("flight.complete", "a flight ends just before its plan", |it| {
            let planned = it.planned_steps();
            it.samples(0).truncate(planned - 2);
            it.loads().truncate(planned - 2);
        }),
        Fault::new("flight.complete", "ten samples were lost", |it| cut_out(it, 10)),
        Fault::new("flight.complete", "one sample was lost", |it| cut_out(it, 1)),
        Fault::new("flight.complete", "time goes backwards", |it| {
            let middle = it.steps() / 2;
            it.samples(0)[middle].t_s -= 0.1;
        }),
        Fault::new("flight.complete", "a sample is duplicated", |it| {
            let middle = it.steps() / 2;
            let twice = it.samples(0)[middle];
            it.samples(0).insert(middle, twice);
            if let Some(load) = it.loads().get(middle).copied() {
                it.loads().insert(middle, load);
            }
        }),
        Fault::new("flight.complete", "the log begins late", |it| {
            it.samples(0).remove(0);
            if !it.loads().is_empty() {
                it.loads().remove(0);
            }
        }),
    ]
}

fn not_numbers() -> Vec<Fault> {
    let at_middle = |mutate: fn(&mut sim::Sample)| {
        move |it: &mut ReferenceCase| {
            let middle = it.steps() / 2;
            mutate(&mut it.samples(0)[middle]);
        }
    };
    vec![
        Fault::new("flight.finite", "one position is not a number", at_middle(|it| it.position_m[1] = f64::NAN)),
        Fault::new("flight.finite", "one velocity is infinite", at_middle(|it| it.velocity_mps[0] = f64::INFINITY)),
        Fault::new("flight.finite", "one time is not a number", at_middle(|it| it.t_s = f64::NAN)),
        Fault::new(
            "flight.finite",
            "one measurement is not a number",
            at_middle(|it| {
                it.measured_velocity_mps[2] = f64::NAN;
            }),
        ),
        Fault::new("flight.finite", "the time of an event is not a number", |it| {
            it.flight().events.push(Event { t_s: f64::NAN, kind: EventKind::SaturationBegan, vehicles: vec![] });
        }),
        Fault::new("flight.finite", "the impulse of an impact is not a number", |it| {
            let kind = EventKind::CableTaut { impulse_ns: f64::NAN };
            it.flight().events.push(Event { t_s: 1.0, kind, vehicles: vec![] });
        }),
    ]
}

fn against_physics() -> Vec<Fault> {
    vec![
        Fault::new("flight.goal", "a vehicle stands still from the beginning", |it| freeze(it, 0.0, 1.0)),
        Fault::new("flight.goal", "a vehicle stands still from the middle on", |it| freeze(it, 0.5, 1.0)),
        Fault::new("flight.dynamics", "a vehicle stands still for three samples", |it| {
            let fraction = 3.0 / it.steps() as f64;
            freeze(it, 0.4, 0.4 + fraction);
        }),
        Fault::new("flight.dynamics", "a vehicle jumps aside for one sample, inside the tracking limit", |it| {
            let (middle, half_m) = (it.steps() / 2 + 3, 0.5 * it.scenario.limits().tracking_max_m);
            it.shift(0, middle..middle + 1, [0.0, half_m, 0.0]);
        }),
        Fault::new("flight.dynamics", "a vehicle slides sideways, inside the tracking limit", |it| {
            let (steps, max_m) = (it.steps(), 0.9 * it.scenario.limits().tracking_rms_m);
            for step in 0..steps {
                let phase_sine = (step as f64 / steps as f64 * std::f64::consts::TAU * 8.0).sin();
                it.shift(0, step..step + 1, [0.0, 0.0, max_m * phase_sine]);
            }
        }),
        Fault::new("flight.dynamics", "velocities are 2 % too large", |it| {
            it.samples(0).iter_mut().for_each(|sample| {
                (0..3).for_each(|axis| sample.velocity_mps[axis] *= 1.02);
                sample.measured_velocity_mps = sample.velocity_mps;
            });
        }),
        Fault::new("flight.dynamics", "a wind acted that is not in the scenario", |it| {
            let mut windy = it.scenario.clone();
            let (mean_mps, gusts) = ([1.0, 0.5, 0.0], None);
            windy.simulation.wind = Some(scenarios::Wind { mean_mps, gusts, pulses: Vec::new() });
            let models = &mut windy.models;
            models.slung_load.values_mut().for_each(|model| model.drag_area_m2 = 0.3);
            models.multirotor.values_mut().for_each(|model| model.drag_area_m2 = 0.3);
            it.fly_in(&windy);
            it.samples(0).iter_mut().for_each(|sample| sample.wind_mps = [0.0; 3]);
        }),
        Fault::new("flight.dynamics", "another mass flew than the scenario's", |it| {
            let mut heavy = it.scenario.clone();
            heavy.simulation.mismatch.mass_ratio = 1.02;
            it.fly_in(&heavy);
        }),
        Fault::new("flight.crash", "a vehicle crashed", |it| {
            let vehicles = vec![it.scenario.vehicles[0].name.clone()];
            it.flight().events.push(Event { t_s: 1.0, kind: EventKind::Crash { obstacle: None }, vehicles });
        }),
    ]
}

fn flattering() -> Vec<Fault> {
    vec![
        Fault::new("flight.complete", "the reference in the log follows the vehicle", |it| {
            it.samples(0).iter_mut().for_each(|sample| sample.reference_position_m = sample.position_m);
        }),
        Fault::new("flight.complete", "the flight is that of another plan, a little aside", |it| {
            let aside_m = 0.2 * it.scenario.limits().tracking_max_m;
            let own = it.plan.clone();
            (0..own.trajectories.len()).for_each(|vehicle| it.edit(vehicle).move_north(aside_m));
            let other = std::mem::replace(&mut it.plan, own);
            it.fly_instead(&other);
        }),
        Fault::new("flight.conditions", "the log shows a wind that is not in the scenario", |it| {
            it.samples(0).iter_mut().for_each(|sample| sample.wind_mps[0] = 1e-3);
        }),
        Fault::new("flight.conditions", "measurements are off, without noise", |it| {
            it.samples(0).iter_mut().for_each(|sample| sample.measured_position_m[0] += 1e-3);
        }),
    ]
}

fn keep(it: &mut ReferenceCase, fraction: f64) {
    let kept = (it.steps() as f64 * fraction) as usize;
    it.samples(0).truncate(kept);
    it.loads().truncate(kept);
}

fn cut_out(it: &mut ReferenceCase, count: usize) {
    let middle = it.steps() / 2;
    it.samples(0).drain(middle..middle + count);
    if !it.loads().is_empty() {
        it.loads().drain(middle..middle + count);
    }
}

/// Holds the positions of vehicle and load, and leaves their velocities, from one fraction of the samples to another.
fn freeze(it: &mut ReferenceCase, from: f64, to: f64) {
    let steps = it.steps();
    let [from, to] = [from, to].map(|fraction| ((steps as f64 * fraction) as usize).min(steps));
    let held = it.samples(0)[from.min(steps - 1)];
    it.samples(0)[from..to].iter_mut().for_each(|sample| {
        sample.position_m = held.position_m;
        sample.measured_position_m = held.position_m;
    });
    let Some(held) = it.loads().get(from).copied() else { return };
    it.loads()[from..to].iter_mut().for_each(|load| {
        load.position_m = held.position_m;
        load.measured_position_m = held.position_m;
    });
}

/// Swaps the samples of two logs from one sample on, without their references.
pub fn swap(it: &mut ReferenceCase, from: usize) {
    let (one, other) = (it.samples(0).clone(), it.samples(1).clone());
    for (vehicle, source) in [(0, &other), (1, &one)] {
        for (sample, source) in it.samples(vehicle).iter_mut().zip(source).skip(from) {
            let kept = *sample;
            *sample = *source;
            sample.reference_position_m = kept.reference_position_m;
            sample.reference_velocity_mps = kept.reference_velocity_mps;
        }
    }
}

/// Delays the motion of the first vehicle.
pub fn delay(it: &mut ReferenceCase, late_s: f64) {
    let late = (late_s / it.scenario.simulation.step_s).round() as usize;
    let samples = it.samples(0).clone();
    for (step, sample) in it.samples(0).iter_mut().enumerate() {
        sample.position_m = samples[step.saturating_sub(late)].position_m;
        sample.velocity_mps = samples[step.saturating_sub(late)].velocity_mps;
    }
}
