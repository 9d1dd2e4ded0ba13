//! The scene: a description of everything there is to see of a run, independent of vehicle family and file format.
//!
//! | part | content | built in |
//! |---|---|---|
//! | [`Scene::items`] | map, obstacles, gates, starts, goals, paths, closest approaches, crashes | `map`, `obstacles`, `paths`, `closest` |
//! | [`Scene::changes`], [`Scene::animations`] | shapes that are replaced or deformed over time: sensed obstacles, horizons, trails, cables, wind | `obstacles`, `paths`, `wind`, the families |
//! | [`Scene::bodies`] | vehicles, loads and moving obstacles: poses over time and shape | `obstacles`, the families |
//! | [`Scene::channels`], [`Scene::series`], [`Scene::states`] | quantities over time with their limits | `distances`, the families |
//! | [`Scene::events`] | text log | `events` |
//! | [`Scene::focus_s`], [`Scene::action`] | the instant and the part of space that a viewer should open on | `focus` |
//! | [`Scene::tabs`], [`Scene::legend`] | what a viewer should open with, how to read the picture | the families |
//!
//! Recorders only translate: `recording/rrd`, `recording/mcap` and `recording/scene_json` (which the report page draws) take
//! every part of the scene, whatever family it is of.
//! Positions are in m in the world frame (ENU), times in s since the start of the flight. Times and values in the scene
//! are finite; NaN and infinity in a log leave gaps.

mod body;
pub mod builder;
mod channel;
mod closest;
pub mod colours;
mod curve;
mod distances;
pub mod events;
pub mod fixed_wing;
mod focus;
mod ghosts;
mod labels;
mod map;
pub mod multirotor;
mod obstacles;
mod paths;
mod requirements;
mod series;
mod shape;
pub mod slung_load;
mod solids;
mod wind;

use serde::Serialize;
use sim::Flight;

pub use body::{Body, BodyKind, Part, Pose};
pub use channel::{Channel, Channels, Plot, Value};
pub use curve::Curve;
pub use focus::Extent;
pub use paths::TRAIL_S;
pub use series::{PlotView, Series, SeriesKind, StateSeries, Tab};
pub use shape::{BoxOutline, Cylinder, Cylinders, Label, Lines, Paint, Points, Radius, Shape, Sphere, Triangles};

use super::run::JudgedRun;

/// Everything there is to see of a run.
#[derive(Default)]
pub struct Scene<'a> {
    /// Shapes that never change.
    pub items: Vec<Item>,
    /// Shapes that are replaced at certain times.
    pub changes: Vec<Changes>,
    /// Polylines that are deformed over time.
    pub animations: Vec<Animation>,
    /// Rigid bodies that move.
    pub bodies: Vec<Body<'a>>,
    /// Quantities of each vehicle, at every step of its log.
    pub channels: Vec<Channels<'a>>,
    /// Other quantities over time, and the limits of all.
    pub series: Vec<Series>,
    /// Discrete states over time.
    pub states: Vec<StateSeries>,
    /// The text log, in the order of time.
    pub events: Vec<events::Event>,
    /// Plots that belong beside the verdict.
    pub verdict_plots: Vec<PlotView>,
    /// Further groups of plots.
    pub tabs: Vec<Tab>,
    /// How to read the picture: lines of Markdown.
    pub legend: Vec<String>,
    /// Time of the last logged sample, s; 0 without a flight.
    pub end_s: f64,
    /// The instant to open on, s: the first failure, or the closest approach.
    pub focus_s: f64,
    /// The check whose worst instant that is, if it is one's.
    pub decisive_check: Option<String>,
    /// The part of space that the paths need; `None` without paths.
    pub action: Option<Extent>,
}

/// Names from the root of the world to an item: `["fleet", "uav-1"]`.
pub type ItemPath = Vec<String>;

/// A shape that never changes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Item {
    /// Unique among all items, changes, animations and bodies.
    pub path: ItemPath,
    /// In the world frame.
    pub shape: Shape,
}

/// A shape that is replaced at certain times.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Changes {
    /// As in [`Item`].
    pub path: ItemPath,
    /// The shape from each time on, s, in the order of time.
    pub shapes: Vec<(f64, Shape)>,
}

/// A polyline that is deformed over time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Animation {
    /// As in [`Item`].
    pub path: ItemPath,
    /// Times, s, increasing.
    pub times_s: Vec<f64>,
    /// The polyline at each time, m.
    pub strips: Vec<Vec<[f64; 3]>>,
    /// Its colour at each time; a single one if it does not change.
    pub paints: Vec<Paint>,
    /// Half the line's width, points on the screen.
    pub radius: f32,
}

impl Scene<'_> {
    fn add_item(&mut self, path: &[&str], shape: impl Into<Shape>) {
        self.items.push(Item { path: item_path(path), shape: shape.into() });
    }
}

/// What a vehicle family adds to a scene.
pub struct FamilyScene {
    /// Adds bodies, series and plots of a flight.
    pub add: for<'a> fn(&mut Scene<'a>, &JudgedRun<'a>, &'a Flight),
    /// How to read the picture: lines of Markdown.
    pub legend: fn(&JudgedRun<'_>) -> Vec<String>,
    /// The log line at the end of the plan.
    pub end_of_plan: &'static str,
}

fn item_path(names: &[&str]) -> ItemPath {
    names.iter().map(|name| (*name).to_owned()).collect()
}

/// Time of the last sample, s; 0 without samples.
fn end_s(flight: &Flight) -> f64 {
    let times_s = flight.vehicles.iter().filter_map(|log| log.samples.last()).map(|sample| sample.t_s);
    times_s.filter(|t_s| t_s.is_finite()).fold(0.0, f64::max)
}

fn is_finite(point: &[f64; 3]) -> bool {
    point.iter().all(|coordinate| coordinate.is_finite())
}

fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|component| component * component).sum::<f64>().sqrt()
}

fn distance_m(a: [f64; 3], b: [f64; 3]) -> f64 {
    norm(std::array::from_fn(|axis| a[axis] - b[axis]))
}

/// Points of a horizontal circle, the first again at the end, m.
fn circle([x, y, z]: [f64; 3], radius_m: f64, count: usize) -> Vec<[f64; 3]> {
    let point = |i: usize| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / count as f64).sin_cos();
        [x + radius_m * cos, y + radius_m * sin, z]
    };
    (0..=count).map(point).collect()
}
