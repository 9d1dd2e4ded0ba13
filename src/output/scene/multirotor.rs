//! Multirotors: vehicles with their sensor range, planning in the loop, speed and controls.

mod planning;
mod vehicle;

use scenarios::multirotor::Plant;
use scenarios::{Scenario, Vehicle};
use sim::{Actuation, Flight, Sample, VehicleLog};

use super::{Channel, Channels, FamilyScene, Plot, PlotView, Scene, Series, Tab, colours, distance_m, distances, norm};
use crate::metrics::over_time::clearance_in_space_over_time;
use crate::output::run::JudgedRun;

/// Largest number of points of one series.
const MAX_POINTS: usize = 2000;
/// Clearance up to which the plot is shown, m.
const CLEARANCE_WINDOW_M: f64 = 2.5;
/// In larger fleets the low plots below the verdict have no legend.
const MAX_ENTRIES_OF_LOW_PLOT: usize = 3;

/// Groups of the controls: of point masses, and of vehicles with rotors.
const ACCELERATION: &str = "acceleration_mps2";
const THRUST: &str = "thrust_n";

/// What multirotors add to a scene.
pub const SCENE: FamilyScene = FamilyScene { add, legend, end_of_plan: "the flight is over" };

fn add<'a>(scene: &mut Scene<'a>, run: &JudgedRun<'a>, flight: &'a Flight) {
    vehicle::add(scene, run.scenario, flight);
    if let Some(log) = &flight.planning {
        planning::add(scene, run.scenario, log);
    }
    let distances = distances::add(scene, run, clearance_in_space_over_time);
    let end_s = scene.end_s;
    let tracking_max_m = run.scenario.limits().tracking_max_m;
    scene.series.push(Series::limit("tracking_m", "limit", tracking_max_m, "m", end_s));
    let count = flight.vehicles.len();
    for (index, (log, vehicle)) in flight.vehicles.iter().zip(&run.scenario.vehicles).enumerate() {
        scene.channels.push(channels(run.scenario, vehicle, log, colours::vehicle(index, count), flight.plan_end_s));
        add_limits(scene, run.scenario, vehicle);
    }
    add_plots(scene, run.scenario, flight, &distances);
}

fn channels<'a>(
    scenario: &Scenario,
    vehicle: &Vehicle,
    log: &'a VehicleLog,
    colour: [u8; 3],
    plan_end_s: f64,
) -> Channels<'a> {
    let samples = log.samples.as_slice();
    let plot = |group, name: String, until_s| Plot { group, name, colour, width: 1.2, max_points: MAX_POINTS, until_s };
    let always = f64::INFINITY;
    let mut channels = vec![
        Channel::number("tracking_error_m", |step| tracking_error_m(&samples[step])).plotted(plot(
            "tracking_m",
            log.vehicle.clone(),
            plan_end_s,
        )),
        Channel::number("airspeed_mps", |step| norm(samples[step].air_velocity_mps())).plotted(plot(
            "airspeed_mps",
            log.vehicle.clone(),
            always,
        )),
        Channel::number("altitude_m", |step| samples[step].position_m[2]),
    ];
    let has_rotors = has_rotors(scenario, vehicle);
    if has_rotors {
        const THRUSTS: [&str; 4] = ["thrust_1_n", "thrust_2_n", "thrust_3_n", "thrust_4_n"];
        channels.extend(THRUSTS.into_iter().enumerate().map(|(rotor, field)| {
            let plot = plot(THRUST, format!("{} F_{}", log.vehicle, rotor + 1), always);
            Channel::number(field, move |step| thrust_n(&samples[step], rotor)).plotted(plot)
        }));
    } else {
        let plot = plot(ACCELERATION, log.vehicle.clone(), always);
        channels.push(Channel::number("acceleration_mps2", |step| acceleration_mps2(&samples[step])).plotted(plot));
    }
    channels.push(Channel::flag("is_saturated", |step| samples[step].is_saturated()));
    let message = if has_rotors { "Multirotor" } else { "PointMass" };
    Channels { vehicle: &log.vehicle, message, samples, channels }
}

fn add_limits(scene: &mut Scene<'_>, scenario: &Scenario, vehicle: &Vehicle) {
    let (model, end_s) = (scenario.multirotor_model(vehicle), scene.end_s);
    let mut limit = |group, name: &str, value, unit| {
        let limit = Series::limit(group, name, value, unit, end_s);
        if !scene.series.contains(&limit) {
            scene.series.push(limit);
        }
    };
    let is_alone = scenario.vehicles.iter().all(|other| other.model == vehicle.model);
    let named = |bound: &str| if is_alone { bound.to_owned() } else { format!("{bound} of {}", vehicle.model) };
    limit("airspeed_mps", &named("highest"), model.limits.speed_mps, "m/s");
    match &model.airframe {
        Some(airframe) if has_rotors(scenario, vehicle) => {
            limit(THRUST, &named("lowest"), airframe.thrust_n.min, "N");
            limit(THRUST, &named("highest"), airframe.thrust_n.max, "N");
        }
        _ => limit(ACCELERATION, &named("highest"), model.limits.acceleration_mps2, "m/s²"),
    }
}

/// Is it simulated with its four rotors, not as a point mass?
fn has_rotors(scenario: &Scenario, vehicle: &Vehicle) -> bool {
    let model = scenario.multirotor_model(vehicle);
    model.airframe.is_some() && model.plant == Plant::Quadrotor
}

fn tracking_error_m(sample: &Sample) -> f64 {
    distance_m(sample.position_m, sample.reference_position_m)
}

fn acceleration_mps2(sample: &Sample) -> f64 {
    match &sample.actuation {
        Actuation::Acceleration(acceleration) => norm(acceleration.control),
        _ => f64::NAN,
    }
}

fn thrust_n(sample: &Sample, rotor: usize) -> f64 {
    match &sample.actuation {
        Actuation::Thrusts(thrusts) => thrusts.control.thrust_n[rotor],
        _ => f64::NAN,
    }
}

fn add_plots(scene: &mut Scene<'_>, scenario: &Scenario, flight: &Flight, distances: &distances::Distances) {
    scene.verdict_plots.extend(distances::separation_plot(scenario, distances));
    if let Some(curve) = &distances.clearance {
        let plot = PlotView::new("clearance_m", "Smallest clearance to an obstacle [m]", 1.0);
        scene.verdict_plots.push(plot.zoomed(curve, CLEARANCE_WINDOW_M));
    }
    let has_legend = scenario.vehicles.len() <= MAX_ENTRIES_OF_LOW_PLOT;
    let tracking = PlotView::new("tracking_m", "Tracking error: distance from the plan [m]", 1.0);
    let errors_m = flight.vehicles.iter().flat_map(|log| &log.samples).map(tracking_error_m);
    let tracking = tracking.spanning(errors_m.chain([scenario.limits().tracking_max_m]));
    scene.verdict_plots.push(PlotView { has_legend, ..tracking });
    let mut motion = vec![PlotView::new("airspeed_mps", "Speed through the air [m/s]", 1.0)];
    let has = |rotors: bool| scenario.vehicles.iter().any(|vehicle| has_rotors(scenario, vehicle) == rotors);
    motion.extend(has(false).then(|| PlotView::new(ACCELERATION, "Acceleration [m/s²]", 1.0)));
    motion.extend(has(true).then(|| PlotView::new(THRUST, "Thrust of each rotor [N]", 1.0)));
    scene.tabs.push(Tab { name: "Motion", plots: motion });
    if flight.planning.is_some() {
        let planning = vec![
            PlotView::new("planning_time_ms", "Wall time of each answer on this machine [ms]", 1.0),
            PlotView::new("delay_ms", "Time from observation to effect, in the simulation [ms]", 1.0),
        ];
        scene.tabs.push(Tab { name: "Planning", plots: planning });
    }
}

fn legend(_: &JudgedRun<'_>) -> Vec<String> {
    let lines = [
        "- everything is to scale; unbounded obstacles are drawn from the floor to the ceiling of the map",
        "- obstacles: red once a vehicle knows of them, pale violet until they are sensed; orange: moving",
        "- sphere around a vehicle: its body; large ring: its sensor range",
        "- thin lines: the edges of the cost map; dim ones: the best candidates of the last replan",
        "- thick line ahead of a vehicle: its horizon; those of earlier replans fade behind it",
        "- bright line: flown; line with a label: closest approach to an obstacle, green if the limit was kept",
    ];
    lines.map(str::to_owned).to_vec()
}
