//! Fixed-wing aircraft: airframe with name and safety volume, load factors, speed, altitude.

mod airframe;
mod open_loop;
mod quantity;

use scenarios::{Scenario, Separation, SeparationMeasure};
use sim::{Flight, VehicleLog};

use self::quantity::Quantity;
use super::body::spaced;
use super::{
    Body, BodyKind, Channel, Channels, Cylinder, Cylinders, FamilyScene, Paint, Part, Plot, PlotView, Points, Pose,
    Scene, Series, TRAIL_S, Tab, colours, distances, item_path,
};
use crate::metrics::over_time::clearance_over_time;
use crate::number_format::given;
use crate::output::run::JudgedRun;

/// Shortest time between two poses, s.
const POSE_INTERVAL_S: f64 = 0.1;
/// Largest number of poses of a whole fleet; the poses of a large fleet are farther apart.
const MAX_POSES: f64 = 60_000.0;
/// Wing span of a drawn aircraft as a fraction of the map's larger side.
const SPAN_OF_MAP: f64 = 0.028;
/// In larger fleets a name is shown only when its aircraft is pointed at.
const MAX_NAMES: usize = 20;
/// In larger fleets plots have no legend.
const MAX_LEGEND_ENTRIES: usize = 10;
/// The same for the plots below the verdict, which are lower.
const MAX_ENTRIES_OF_LOW_PLOT: usize = 3;
/// Largest number of points of one series.
const MAX_POINTS: usize = 2000;
/// Largest number of points of all series of the fleet together.
const MAX_POINTS_OF_FLEET: usize = 240_000;

/// What fixed wings add to a scene.
pub const SCENE: FamilyScene = FamilyScene { add, legend, end_of_plan: "the plan ends, the vehicles fly straight on" };

fn add<'a>(scene: &mut Scene<'a>, run: &JudgedRun<'a>, flight: &'a Flight) {
    add_bodies(scene, run.scenario, flight);
    open_loop::add(scene, run);
    let distances = distances::add(scene, run, clearance_over_time);
    for quantity in Quantity::ALL {
        for (name, value) in quantity.limits(run.scenario) {
            scene.series.push(Series::limit(quantity.group(), &name, value, quantity.unit(), scene.end_s));
        }
    }
    let count = flight.vehicles.len();
    let max_points = (MAX_POINTS_OF_FLEET / (count.max(1) * Quantity::ALL.len())).clamp(200, MAX_POINTS);
    for (index, log) in flight.vehicles.iter().enumerate() {
        scene.channels.push(channels(log, colours::vehicle(index, count), max_points, flight.plan_end_s));
    }
    add_plots(scene, run.scenario, flight, &distances);
}

fn channels(log: &VehicleLog, colour: [u8; 3], max_points: usize, plan_end_s: f64) -> Channels<'_> {
    let samples = log.samples.as_slice();
    let plotted = |quantity: Quantity| {
        let until_s = if quantity == Quantity::Tracking { plan_end_s } else { f64::INFINITY };
        let plot = Plot { group: quantity.group(), name: log.vehicle.clone(), colour, width: 1.2, max_points, until_s };
        Channel::number(quantity.field(), move |step| quantity.of(&samples[step])).plotted(plot)
    };
    let mut channels: Vec<Channel<'_>> = Quantity::ALL.into_iter().map(plotted).collect();
    channels.push(Channel::flag("is_saturated", |step| samples[step].is_saturated()));
    Channels { vehicle: &log.vehicle, message: "Aircraft", samples, channels }
}

fn add_bodies<'a>(scene: &mut Scene<'a>, scenario: &Scenario, flight: &'a Flight) {
    let time_flown_s: f64 = flight.vehicles.iter().map(|log| log.samples.len() as f64 * flight.step_s).sum();
    let interval_s = POSE_INTERVAL_S.max(time_flown_s / MAX_POSES);
    for (index, log) in flight.vehicles.iter().enumerate() {
        scene.bodies.push(Body {
            frame: log.vehicle.clone(),
            path: item_path(&["vehicles", &log.vehicle]),
            kind: BodyKind::Vehicle,
            parts: parts(scenario, log, colours::vehicle(index, flight.vehicles.len())),
            interval_s,
            poses: Box::new(|interval_s| spaced(&log.samples, interval_s).iter().map(Pose::of).collect()),
        });
    }
}

fn parts(scenario: &Scenario, log: &VehicleLog, colour: [u8; 3]) -> Vec<Part> {
    let are_names_shown = scenario.vehicles.len() <= MAX_NAMES;
    let name = Points::one([0.0; 3], colour, 1.5, log.vehicle.as_str(), are_names_shown);
    let safety = scenario.separation().map(|rule| safety_volume(scenario, &rule, colour));
    let airframe = Part::fixed("airframe", airframe::mesh(drawn_span_m(scenario), colour));
    [airframe, Part::upright("name", name)]
        .into_iter()
        .chain(safety.map(|safety| Part::upright("safety", safety)))
        .collect()
}

/// Upright cylinder of half the size: two of them touch when the separation is at its limit. A horizontal separation gives it
/// no height; a quarter of the map's is enough to be visible.
fn safety_volume(scenario: &Scenario, rule: &Separation, colour: [u8; 3]) -> Cylinders {
    let length_m = match rule.measure {
        SeparationMeasure::Horizontal => scenario.world.map.z_m.width() / 4.0,
        SeparationMeasure::Spatial => rule.limit_m,
        SeparationMeasure::Cylinder { height_m, .. } | SeparationMeasure::Ellipsoid { height_m, .. } => height_m,
    };
    let cylinder = Cylinder { centre_m: [0.0; 3], length_m, radius_m: rule.horizontal_m / 2.0, name: None };
    Cylinders { cylinders: vec![cylinder], paint: Paint::translucent(colour, 0.7), radius: 0.5 }
}

/// Wing span of the drawn aircraft, m: large enough to be seen on the whole map, and smaller in a large fleet so that they
/// do not hide each other.
fn drawn_span_m(scenario: &Scenario) -> f64 {
    let map = &scenario.world.map;
    let crowd = (scenario.vehicles.len() as f64 / 10.0).max(1.0).sqrt();
    SPAN_OF_MAP * map.x_m.width().max(map.y_m.width()) / crowd
}

fn add_plots(scene: &mut Scene<'_>, scenario: &Scenario, flight: &Flight, distances: &distances::Distances) {
    use Quantity::{Airspeed, Altitude, Nx, Ny, Nz, Tracking};
    scene.verdict_plots.extend(distances::separation_plot(scenario, distances));
    if let Some(curve) = &distances.clearance {
        let plot = PlotView::new("clearance_m", "Smallest clearance to an obstacle [m]", 1.0);
        let radii_m = scenario.world.cylinders.iter().map(|cylinder| cylinder.radius_m);
        scene.verdict_plots.push(plot.zoomed(curve, radii_m.fold(0.0, f64::max)));
    }
    let count = scenario.vehicles.len();
    let plot = |quantity: Quantity, max_entries| quantity.plot(scenario, flight, count <= max_entries);
    scene.verdict_plots.push(plot(Tracking, MAX_ENTRIES_OF_LOW_PLOT));
    let plots = |members: &[Quantity]| members.iter().map(|member| plot(*member, MAX_LEGEND_ENTRIES)).collect();
    scene.tabs.push(Tab { name: "Load factors", plots: plots(&[Nx, Ny, Nz]) });
    scene.tabs.push(Tab { name: "Speed and altitude", plots: plots(&[Airspeed, Altitude]) });
}

fn legend(run: &JudgedRun<'_>) -> Vec<String> {
    let scenario = run.scenario;
    let body_m = scenario.vehicles.iter().filter_map(|vehicle| scenario.models.fixed_wing.get(&vehicle.model));
    let body_m = body_m.map(|model| 2.0 * model.body_radius_m).fold(0.0, f64::max);
    let span_m = drawn_span_m(scenario);
    let safety = scenario.separation().map(|rule| {
        let radius_m = given(rule.horizontal_m / 2.0);
        format!("- cylinder around an aircraft: radius R/2 = {radius_m} m; two touch when the separation is R")
    });
    let lines = [
        "- one colour per vehicle, in space and in the plots".to_owned(),
        "- red: obstacles, limits, violations".to_owned(),
        format!("- thin dim line: planned; bright line: flown; thick line: the last {TRAIL_S} s"),
        "- dots: start (dim) and goal (bright); large red dot: crash".to_owned(),
        "- line with a label: closest approach of the fleet, green if the limit was kept".to_owned(),
        "- obstacles are unbounded; they are drawn from the floor to the ceiling of the map".to_owned(),
        format!(
            "- **not to scale: the aircraft**, {span_m:.0} m wide; their bodies of {body_m:.1} m would be too small to see"
        ),
    ];
    lines.into_iter().chain(safety).collect()
}
