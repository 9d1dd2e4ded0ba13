//! The layout that the viewer opens with: the world with the events below it at the left, verdict and plots at the right.

use rerun::RecordingStream;
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EyeControls3D, LineGrid3D, PlotLegend, TextLogColumns,
};
use rerun::external::re_sdk_types::blueprint::components::{BackgroundKind, Corner2D, TextLogColumn, TimelineColumn};
use rerun::external::re_sdk_types::blueprint::datatypes::{self, TextLogColumnKind};
use scenarios::{Map, Scenario};

use super::blueprint::{Blueprint, Part, Playback, ViewClass};
use super::shapes::color;
use super::{Logged, SIM_TIME, convergence, to_f32};
use crate::output::recording::Run;
use crate::output::scene::{Extent, Paint, PlotView, Scene, colours};
use crate::verdict::Outcome;

type Error = Box<dyn std::error::Error + Send + Sync>;

/// Space for the legend at the right of a plot, as a fraction of the flight's duration.
const LEGEND_SPACE: f64 = 0.25;
/// Time in which a whole flight is played, s.
const PLAYBACK_S: f64 = 20.0;
/// Part of a failed flight that is repeated, before and after the failure, as a fraction of the flight.
const BEFORE: f64 = 0.15;
const AFTER: f64 = 0.05;
/// Smallest width of what the camera shows, m, and its smallest depth as a fraction of the width.
const MIN_WIDTH_M: f64 = 2.0;
const MIN_DEPTH: f64 = 0.35;
/// Height of the verdict relative to that of a plot below it.
const DOCUMENT_HEIGHT: f32 = 2.2;

/// Sends the layout. Views that would be empty are left out.
pub fn send(stream: &RecordingStream, run: &Run<'_>, scene: &Scene<'_>) -> Logged {
    let layout = Blueprint::new()?;
    let left = layout.rows("", &[(world(&layout, run.scenario, scene)?, 3.4), (events(&layout)?, 1.0)])?;
    let mut tabs = vec![verdict(&layout, scene)?];
    if !run.waterfall.is_empty() {
        tabs.push(layout.view(ViewClass::Spatial2D, "Margins", "/margins", &["$origin/**".to_owned()])?);
    }
    for tab in &scene.tabs {
        tabs.push(layout.rows(tab.name, &plots(&layout, &tab.plots, scene.end_s)?)?);
    }
    if !run.plan.history.is_empty() {
        let content = ["/convergence".to_owned()];
        tabs.push(layout.view(ViewClass::TextDocument, "Planner", "/convergence", &content)?);
        tabs.push(planner_curves(&layout)?);
    }
    let right = layout.tabs("", &tabs)?;
    let root = layout.columns("", &[(left, 1.45), (right, 1.0)])?;
    layout.send(&root, &playback(run, scene), stream)
}

/// A flight that passed is repeated as a whole, the others around the failure, once they have come to it: a layout cannot
/// set the time at which the viewer opens a file.
fn playback(run: &Run<'_>, scene: &Scene<'_>) -> Playback {
    let (end_s, focus_s) = (scene.end_s, scene.focus_s);
    let is_whole = run.verdict.outcome == Outcome::Pass || end_s <= 0.0;
    let window_s = [(focus_s - BEFORE * end_s).max(0.0), (focus_s + AFTER * end_s).min(end_s)];
    Playback { speed: (end_s / PLAYBACK_S).max(1.0), window_s: (!is_whole).then_some(window_s) }
}

fn world(layout: &Blueprint, scenario: &Scenario, scene: &Scene<'_>) -> Result<Part, Error> {
    // The graph of a cost map would hide the paths; the viewer's list of entities switches it on.
    let contents = ["$origin/**", "- $origin/cost_map/**"].map(str::to_owned);
    let view = layout.view(ViewClass::Spatial3D, "World", "/world", &contents)?;
    layout.property(&view, "EyeControls3D", &camera(&scenario.world.map, scene.action))?;
    layout.property(&view, "LineGrid3D", &LineGrid3D::new().with_visible(false))?; // the map has its own grid
    let background = Background::new(BackgroundKind::SolidColor).with_color(color(Paint::opaque(colours::SKY)));
    layout.property(&view, "Background", &background)?;
    Ok(view)
}

/// Looks at the paths, or at the whole map without any, from the south and from above, a little from the west.
fn camera(map: &Map, action: Option<Extent>) -> EyeControls3D {
    let [x, y, z] = map.axes();
    let whole = Extent { min_m: [x.min, y.min, z.min], max_m: [x.max, y.max, z.max] };
    let action = action.unwrap_or(whole);
    let [width, depth, height] = action.size_m();
    let width = width.max(MIN_WIDTH_M).max(depth);
    let depth = depth.max(MIN_DEPTH * width);
    // Far enough for the width at the near edge and for the foreshortened depth (vertical field of view 55 deg).
    let distance_m = (0.75 * width + 0.35 * depth).max(1.2 * depth).max(1.2 * height);
    let towards_eye = [-0.10, -0.64, 0.76];
    let centre = action.centre_m();
    let target = [centre[0], centre[1] - 0.07 * depth, centre[2]];
    let eye = std::array::from_fn(|i| target[i] + distance_m * towards_eye[i]);
    EyeControls3D::new().with_position(to_f32(eye)).with_look_target(to_f32(target)).with_eye_up([0.0_f32, 0.0, 1.0])
}

fn events(layout: &Blueprint) -> Result<Part, Error> {
    let view = layout.view(ViewClass::TextLog, "Events", "/events", &["$origin/**".to_owned()])?;
    let column = |kind| TextLogColumn(datatypes::TextLogColumn { visible: true.into(), kind });
    // The times are in the texts: the column of the timeline would cut them off.
    let columns = TextLogColumns::new()
        .with_timeline_columns([TimelineColumn(datatypes::TimelineColumn {
            visible: false.into(),
            timeline: SIM_TIME.into(),
        })])
        .with_text_log_columns([column(TextLogColumnKind::LogLevel), column(TextLogColumnKind::Body)]);
    layout.property(&view, "TextLogColumns", &columns)?;
    Ok(view)
}

/// The document, and below it the plots that the verdict depends on most.
fn verdict(layout: &Blueprint, scene: &Scene<'_>) -> Result<Part, Error> {
    let document = layout.view(ViewClass::TextDocument, "Verdict", "/verdict", &["/verdict".to_owned()])?;
    let mut rows = vec![(document, DOCUMENT_HEIGHT)];
    rows.extend(plots(layout, &scene.verdict_plots, scene.end_s)?);
    layout.rows("Verdict", &rows)
}

fn plots(layout: &Blueprint, plots: &[PlotView], end_s: f64) -> Result<Vec<(Part, f32)>, Error> {
    plots.iter().map(|view| Ok((plot(layout, view, end_s)?, view.height))).collect()
}

/// A group of series with its limits, over the whole flight.
fn plot(layout: &Blueprint, view: &PlotView, end_s: f64) -> Result<Part, Error> {
    let contents = [format!("/plots/{}/**", view.group), format!("/limits/{}/**", view.group)];
    let part = layout.view(ViewClass::TimeSeries, &view.title, "/", &contents)?;
    let legend = PlotLegend::new().with_visible(view.has_legend).with_corner(Corner2D::RightTop);
    layout.property(&part, "PlotLegend", &legend)?;
    layout.times(&part, 0.0, (1.0 + LEGEND_SPACE) * end_s)?;
    if let Some([min, max]) = view.range {
        layout.values(&part, min, max)?;
    }
    Ok(part)
}

/// The last tab: empty until the viewer is switched to the planner's own timeline.
fn planner_curves(layout: &Blueprint) -> Result<Part, Error> {
    let mut rows = Vec::new();
    for (group, title) in convergence::GROUPS {
        let contents = [format!("/planner/{group}/**")];
        let view = layout.view(ViewClass::TimeSeries, title, "/", &contents)?;
        layout.property(&view, "PlotLegend", &PlotLegend::new().with_corner(Corner2D::RightTop))?;
        rows.push((view, 1.0));
    }
    layout.rows("Planner's curves", &rows)
}
