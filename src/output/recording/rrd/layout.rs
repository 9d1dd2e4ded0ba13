//! The layout that the viewer opens with: the world with the events below it at the left, verdict and plots at the right.

use rerun::RecordingStream;
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EyeControls3D, LineGrid3D, PlotLegend, TextLogColumns,
};
use rerun::external::re_sdk_types::blueprint::components::{BackgroundKind, Corner2D, TextLogColumn, TimelineColumn};
use rerun::external::re_sdk_types::blueprint::datatypes::{self, TextLogColumnKind};
use scenarios::{Map, Scenario};

use super::blueprint::{Blueprint, Part, ViewClass};
use super::shapes::color;
use super::{Logged, SIM_TIME, convergence, to_f32};
use crate::output::recording::Run;
use crate::output::scene::{Paint, PlotView, Scene, colours};

type Error = Box<dyn std::error::Error + Send + Sync>;

/// Space for the legend at the right of a plot, as a fraction of the flight's duration.
const LEGEND_SPACE: f64 = 0.25;
/// Time in which a whole flight is played, s.
const PLAYBACK_S: f64 = 20.0;
/// Height of the verdict relative to that of a plot below it.
const DOCUMENT_HEIGHT: f32 = 2.2;

/// Sends the layout. Views that would be empty are left out.
pub fn send(stream: &RecordingStream, run: &Run<'_>, scene: &Scene<'_>) -> Logged {
    let layout = Blueprint::new()?;
    let left = layout.rows("", &[(world(&layout, run.scenario)?, 3.4), (events(&layout)?, 1.0)])?;
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
    layout.send(&root, (scene.end_s / PLAYBACK_S).max(1.0), stream)
}

fn world(layout: &Blueprint, scenario: &Scenario) -> Result<Part, Error> {
    let view = layout.view(ViewClass::Spatial3D, "World", "/world", &["$origin/**".to_owned()])?;
    layout.property(&view, "EyeControls3D", &camera(&scenario.world.map))?;
    layout.property(&view, "LineGrid3D", &LineGrid3D::new().with_visible(false))?; // the map has its own grid
    let background = Background::new(BackgroundKind::SolidColor).with_color(color(Paint::opaque(colours::SKY)));
    layout.property(&view, "Background", &background)?;
    Ok(view)
}

/// Looks at the whole map from the south and from above, a little from the west.
fn camera(map: &Map) -> EyeControls3D {
    let [x, y, z] = map.axes();
    let centre = [x, y, z].map(|axis| f64::midpoint(axis.min, axis.max));
    // Far enough for the width at the near edge and for the foreshortened depth (vertical field of view 55 deg).
    let distance_m = (0.69 * x.width() + 0.32 * y.width()).max(1.11 * y.width()).max(z.width());
    let towards_eye = [-0.10, -0.64, 0.76];
    let target = [centre[0], centre[1] - 0.07 * y.width(), centre[2]];
    let eye = std::array::from_fn(|i| target[i] + distance_m * towards_eye[i]);
    EyeControls3D::new().with_position(to_f32(eye)).with_look_target(to_f32(target)).with_eye_up([0.0_f32, 0.0, 1.0])
}

fn events(layout: &Blueprint) -> Result<Part, Error> {
    let view = layout.view(ViewClass::TextLog, "Events", "/events", &["$origin/**".to_owned()])?;
    let column = |kind| TextLogColumn(datatypes::TextLogColumn { visible: true.into(), kind });
    let columns = TextLogColumns::new()
        .with_timeline_columns([TimelineColumn(datatypes::TimelineColumn {
            visible: true.into(),
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
