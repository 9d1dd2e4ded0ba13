//! The scene as data, `scene.json`: what the report page draws, and what a later recording shows as a ghost.
//!
//! Numbers have six significant digits, and everything is as coarse as a picture of a thousand pixels allows: the exact
//! figures are in `report.json`.

mod compact;

use std::error::Error;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use rayon::prelude::*;
use serde::Serialize;

use super::{Recorder, Run};
use crate::output::files::SCENE_FILE;
use crate::output::scene::events::Event;
use crate::output::scene::{
    Animation, Body, BodyKind, Changes, Curve, Extent, Item, Part, PlotView, Scene, SeriesKind, StateSeries, builder,
};

/// Version of the format.
const SCHEMA: u32 = 1;
/// Largest number of poses of all bodies together, and of one of them.
const MAX_POSES: f64 = 40_000.0;
const MAX_POSES_OF_BODY: f64 = 900.0;
/// Largest number of points of all curves together, and of one of them.
const MAX_CURVE_POINTS: usize = 120_000;
const MAX_POINTS_OF_CURVE: usize = 700;
/// Largest number of points of a shape that is replaced or deformed over time, over all times.
const MAX_POINTS_OF_CHANGES: usize = 30_000;
/// Kinds of items that a picture can do without: the trail follows from the poses, the page has the ghost
/// from its own scene, the others hide what matters.
const LEFT_OUT: [&str; 4] = ["trail", "candidates", "cost_map", "ghost"];

/// Writes `scene.json`.
#[derive(Clone, Copy, Debug, Default)]
pub struct SceneJson;

impl Recorder for SceneJson {
    fn file_name(&self) -> &'static str {
        SCENE_FILE
    }

    fn write(&self, run: &Run<'_>, path: &Path) -> Result<(), Box<dyn Error + Send + Sync>> {
        let scene = builder::build(&run.judged());
        let mut writer = BufWriter::new(File::create(path)?);
        SceneFile::new(run, &scene).serialize(&mut compact::serializer(&mut writer))?;
        Ok(writer.flush()?)
    }
}

/// The content of the file.
#[derive(Serialize)]
struct SceneFile<'a> {
    schema: u32,
    scenario: &'a str,
    description: &'a str,
    planner: &'a str,
    end_s: f64,
    focus_s: f64,
    decisive_check: Option<&'a str>,
    action: Option<Extent>,
    items: Vec<&'a Item>,
    changes: Vec<Changes>,
    animations: Vec<Animation>,
    bodies: Vec<BodyData<'a>>,
    plots: Vec<PlotData<'a>>,
    states: &'a [StateSeries],
    events: &'a [Event],
    legend: &'a [String],
}

/// A body with its poses in columns.
#[derive(Serialize)]
struct BodyData<'a> {
    frame: &'a str,
    path: &'a [String],
    kind: BodyKind,
    parts: &'a [Part],
    times_s: Vec<f64>,
    positions_m: Vec<[f64; 3]>,
    /// Quaternions (x, y, z, w); empty if no part rotates.
    attitudes: Vec<[f64; 4]>,
}

/// A plot with its series.
#[derive(Serialize)]
struct PlotData<'a> {
    tab: &'a str,
    group: &'a str,
    title: &'a str,
    range: Option<[f64; 2]>,
    series: Vec<SeriesData>,
}

#[derive(Serialize)]
struct SeriesData {
    name: String,
    title: String,
    kind: SeriesKind,
    colour: [u8; 3],
    is_stepped: bool,
    times_s: Vec<f64>,
    values: Vec<f64>,
}

impl<'a> SceneFile<'a> {
    fn new(run: &Run<'a>, scene: &'a Scene<'_>) -> Self {
        let is_drawn = |path: &[String]| path.first().is_none_or(|kind| !LEFT_OUT.contains(&kind.as_str()));
        Self {
            schema: SCHEMA,
            scenario: &run.scenario.name,
            description: &run.scenario.description,
            planner: &run.plan.planner,
            end_s: scene.end_s,
            focus_s: scene.focus_s,
            decisive_check: scene.decisive_check.as_deref(),
            action: scene.action,
            items: scene.items.iter().filter(|item| is_drawn(&item.path)).collect(),
            changes: scene.changes.iter().filter(|it| is_drawn(&it.path)).map(thinned_changes).collect(),
            animations: scene.animations.iter().filter(|it| is_drawn(&it.path)).map(thinned_animation).collect(),
            bodies: bodies(scene),
            plots: plots(scene),
            states: &scene.states,
            events: &scene.events,
            legend: &scene.legend,
        }
    }
}

fn bodies<'a>(scene: &'a Scene<'_>) -> Vec<BodyData<'a>> {
    let count = scene.bodies.len().max(1) as f64;
    let interval_s = scene.end_s / (MAX_POSES / count).min(MAX_POSES_OF_BODY);
    let drawn = scene.bodies.iter().filter(|body| body.kind != BodyKind::Ghost);
    drawn.map(|body| body_data(body, interval_s.max(body.interval_s))).collect()
}

fn body_data<'a>(body: &'a Body<'_>, interval_s: f64) -> BodyData<'a> {
    let poses = (body.poses)(interval_s);
    let rotates = body.parts.iter().any(|part| part.rotates);
    BodyData {
        frame: &body.frame,
        path: &body.path,
        kind: body.kind,
        parts: &body.parts,
        times_s: poses.iter().map(|pose| pose.t_s).collect(),
        positions_m: poses.iter().map(|pose| pose.position_m).collect(),
        attitudes: poses.iter().filter(|_| rotates).map(|pose| pose.world_from_body).collect(),
    }
}

/// Every plot that a viewer shows, in its order.
fn plots<'a>(scene: &'a Scene<'_>) -> Vec<PlotData<'a>> {
    let verdict = scene.verdict_plots.iter().map(|plot| ("Verdict", plot));
    let tabs = scene.tabs.iter().flat_map(|tab| tab.plots.iter().map(|plot| (tab.name, plot)));
    let channels = scene.channels.iter().flat_map(|channels| &channels.channels);
    let count = channels.filter(|channel| channel.plot.is_some()).count() + scene.series.len();
    let max_points = (MAX_CURVE_POINTS / count.max(1)).clamp(100, MAX_POINTS_OF_CURVE);
    verdict.chain(tabs).map(|(tab, plot)| plot_data(scene, tab, plot, max_points)).collect()
}

fn plot_data<'a>(scene: &Scene<'_>, tab: &'a str, view: &'a PlotView, max_points: usize) -> PlotData<'a> {
    let plotted: Vec<_> = scene
        .channels
        .iter()
        .flat_map(|vehicle| vehicle.channels.iter().map(|channel| (vehicle.samples, channel)))
        .filter_map(|(samples, channel)| Some((samples, channel, channel.plot.as_ref()?)))
        .filter(|(_, _, plot)| plot.group == view.group)
        .collect();
    let of_channels = plotted.into_par_iter().map(|(samples, channel, plot)| {
        let curve = channel.curve(samples, plot).decimated(max_points);
        series_data(&plot.name, &plot.name, SeriesKind::Quantity, plot.colour, false, curve)
    });
    let others = scene.series.iter().filter(|series| series.group == view.group).map(|series| {
        let curve = series.curve.clone().decimated(max_points);
        series_data(&series.name, &series.title, series.kind, series.colour, series.is_stepped, curve)
    });
    let series = of_channels.collect::<Vec<_>>().into_iter().chain(others).collect();
    PlotData { tab, group: view.group, title: &view.title, range: view.range, series }
}

fn series_data(
    name: &str,
    title: &str,
    kind: SeriesKind,
    colour: [u8; 3],
    is_stepped: bool,
    curve: Curve,
) -> SeriesData {
    let Curve { times_s, values } = curve;
    SeriesData { name: name.to_owned(), title: title.to_owned(), kind, colour, is_stepped, times_s, values }
}

/// Every n-th of the shapes, so that all of them together stay small; the first and the last are kept.
fn thinned_changes(changes: &Changes) -> Changes {
    let points = changes.shapes.iter().map(|(_, shape)| shape.point_count()).sum();
    Changes { path: changes.path.clone(), shapes: every_nth(&changes.shapes, points) }
}

fn thinned_animation(animation: &Animation) -> Animation {
    let points = animation.strips.iter().map(Vec::len).sum();
    let paints = match animation.paints.as_slice() {
        [paint] => vec![*paint],
        paints => every_nth(paints, points),
    };
    Animation {
        path: animation.path.clone(),
        times_s: every_nth(&animation.times_s, points),
        strips: every_nth(&animation.strips, points),
        paints,
        radius: animation.radius,
    }
}

fn every_nth<T: Clone>(all: &[T], points: usize) -> Vec<T> {
    let stride = points.div_ceil(MAX_POINTS_OF_CHANGES).max(1);
    let is_kept = |index: usize| index.is_multiple_of(stride) || index + 1 == all.len();
    all.iter().enumerate().filter(|(index, _)| is_kept(*index)).map(|(_, item)| item.clone()).collect()
}
