//! What the viewer opens with: the world at the left with the events below it, verdict and plots at the right.

use rerun::RecordingStream;
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EyeControls3D, LineGrid3D, PlotLegend, TextLogColumns,
};
use rerun::external::re_sdk_types::blueprint::components::{BackgroundKind, Corner2D, TextLogColumn, TimelineColumn};
use rerun::external::re_sdk_types::blueprint::datatypes::{self, TextLogColumnKind};
use scenarios::{Family, Map, Scenario};
use sim::Flight;

use super::blueprint::{Blueprint, Part, ViewClass};
use super::decimation::Curve;
use super::distances::Distances;
use super::multirotor;
use super::quantity::Quantity;
use super::series::end_s;
use super::{Logged, Run, SIM_TIME, convergence, palette, slung_load, to_f32};

type Error = Box<dyn std::error::Error + Send + Sync>;

/// A fleet larger than this would fill a plot with its legend.
const MOST_LEGEND_ENTRIES: usize = 10;

/// Room for the legend at the right of a plot, as a share of the flight's duration.
const ROOM_FOR_LEGEND: f64 = 0.25;
/// Clearance up to which multirotors are shown, m: farther away from everything nothing happens.
const NEAR_M: f64 = 2.5;
/// Time in which a whole flight is played, s.
const PLAYBACK_S: f64 = 20.0;

/// Sends the layout; only views that have something to show are part of it.
pub fn send(stream: &RecordingStream, run: &Run<'_>, distances: &Distances) -> Logged {
    let layout = Blueprint::new()?;
    let left = layout.rows("", &[(world(&layout, run.scenario)?, 3.4), (events(&layout)?, 1.0)])?;
    let mut tabs = vec![verdict(&layout, run, distances)?];
    if !run.waterfall.is_empty() {
        tabs.push(layout.view(ViewClass::Spatial2D, "Margins", "/margins", &["$origin/**".to_owned()])?);
    }
    if let Some(flight) = run.flight {
        use Quantity::{Airspeed, Altitude, Nx, Ny, Nz};
        match run.scenario.family() {
            Family::FixedWing => {
                tabs.push(quantities(&layout, run.scenario, flight, "Load factors", &[Nx, Ny, Nz])?);
                tabs.push(quantities(&layout, run.scenario, flight, "Speed and altitude", &[Airspeed, Altitude])?);
            }
            Family::SlungLoad => tabs.push(slung_load::forces(&layout, flight)?),
            Family::Multirotor => tabs.extend(multirotor::tabs(&layout, flight)?),
        }
    }
    if !run.plan.history.is_empty() {
        let content = ["/convergence".to_owned()];
        tabs.push(layout.view(ViewClass::TextDocument, "Planner", "/convergence", &content)?);
        tabs.push(planner_curves(&layout)?);
    }
    let right = layout.tabs("", &tabs)?;
    let root = layout.columns("", &[(left, 1.45), (right, 1.0)])?;
    let playback_speed = run.flight.map_or(1.0, |flight| (end_s(flight) / PLAYBACK_S).max(1.0));
    layout.send(&root, playback_speed, stream)
}

fn world(layout: &Blueprint, scenario: &Scenario) -> Result<Part, Error> {
    let view = layout.view(ViewClass::Spatial3D, "World", "/world", &["$origin/**".to_owned()])?;
    layout.property(&view, "EyeControls3D", &camera(&scenario.world.map))?;
    layout.property(&view, "LineGrid3D", &LineGrid3D::new().with_visible(false))?; // the map has a grid of its own
    let background = Background::new(BackgroundKind::SolidColor).with_color(palette::opaque(palette::SKY));
    layout.property(&view, "Background", &background)?;
    Ok(view)
}

/// Looks at the whole map from the south and from above, a little from the west.
fn camera(map: &Map) -> EyeControls3D {
    let [x, y, z] = map.axes();
    let centre = [x, y, z].map(|axis| f64::midpoint(axis.min, axis.max));
    // Far enough for the width at the near edge, and for the depth as it is foreshortened (vertical field of view 55 deg).
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

/// The document, and below it what a verdict hangs on: separation, clearance, tracking.
fn verdict(layout: &Blueprint, run: &Run<'_>, distances: &Distances) -> Result<Part, Error> {
    let document = layout.view(ViewClass::TextDocument, "Verdict", "/verdict", &["/verdict".to_owned()])?;
    let mut rows = vec![(document, 2.2)];
    let slung_load = run.flight.filter(|_| run.scenario.family() == Family::SlungLoad);
    if let Some(flight) = slung_load {
        rows.extend(slung_load::verdict_rows(layout, flight)?);
    } else if let Some(flight) = run.flight {
        let end_s = end_s(flight);
        if let (Some(curve), Some(limit_m)) = (&distances.separation, run.scenario.fleet.separation_m) {
            let view = plot(layout, "separation", "Smallest separation of the fleet, horizontal [m]", end_s, true)?;
            zoom(layout, &view, curve, 4.0 * limit_m)?;
            rows.push((view, 1.0));
        }
        if let Some(curve) = &distances.clearance {
            let view = plot(layout, "clearance", "Smallest clearance to an obstacle [m]", end_s, true)?;
            let radii_m = run.scenario.world.cylinders.iter().map(|cylinder| cylinder.radius_m);
            let window_m =
                if run.scenario.family() == Family::Multirotor { NEAR_M } else { radii_m.fold(0.0, f64::max) };
            zoom(layout, &view, curve, window_m)?;
            rows.push((view, 1.0));
        }
        // Too low for a legend of the fleet; the colours are those of the world.
        let legend = run.scenario.vehicles.len() <= 3;
        rows.push((quantity(layout, run.scenario, flight, Quantity::Tracking, legend)?, 1.0));
    }
    layout.rows("Verdict", &rows)
}

/// Shows what matters of a distance: not all across the map, but from 0 (or the lowest value, if negative) to
/// `window`, or further if the lowest value is beyond.
fn zoom(layout: &Blueprint, view: &Part, curve: &Curve, window: f64) -> Logged {
    let (Some(lowest), Some(highest)) = (curve.min(), curve.max()) else { return Ok(()) };
    let top = highest.min(window.max(1.5 * lowest));
    values(layout, view, lowest.min(0.0), top)
}

/// Shows the values from `lowest` to `highest` with some air around them.
fn values(layout: &Blueprint, view: &Part, lowest: f64, highest: f64) -> Logged {
    let air = 0.08 * (highest - lowest);
    // The comparison is false for NaN too: then the viewer chooses.
    if air > 0.0 && air.is_finite() { layout.values(view, lowest - air, highest + air) } else { Ok(()) }
}

fn quantities(
    layout: &Blueprint,
    scenario: &Scenario,
    flight: &Flight,
    name: &str,
    members: &[Quantity],
) -> Result<Part, Error> {
    let legend = scenario.vehicles.len() <= MOST_LEGEND_ENTRIES;
    let views = members.iter().map(|member| Ok((quantity(layout, scenario, flight, *member, legend)?, 1.0)));
    layout.rows(name, &views.collect::<Result<Vec<_>, Error>>()?)
}

/// A quantity of all vehicles with its limits, both in full view.
fn quantity(
    layout: &Blueprint,
    scenario: &Scenario,
    flight: &Flight,
    quantity: Quantity,
    legend: bool,
) -> Result<Part, Error> {
    let view = plot(layout, quantity.group(), quantity.title(), end_s(flight), legend)?;
    let limits = quantity.limits(scenario).into_iter().map(|(_, value)| value);
    let shown: Curve = limits.chain(quantity.extremes(flight)).map(|value| (0.0, value)).collect();
    if let (Some(lowest), Some(highest)) = (shown.min(), shown.max()) {
        values(layout, &view, lowest, highest)?;
    }
    Ok(view)
}

/// A group of series with its limits, over the whole flight.
fn plot(layout: &Blueprint, group: &str, title: &str, end_s: f64, legend: bool) -> Result<Part, Error> {
    let contents = [format!("/plots/{group}/**"), format!("/limits/{group}/**")];
    let view = layout.view(ViewClass::TimeSeries, title, "/", &contents)?;
    let legend = PlotLegend::new().with_visible(legend).with_corner(Corner2D::RightTop);
    layout.property(&view, "PlotLegend", &legend)?;
    layout.times(&view, 0.0, (1.0 + ROOM_FOR_LEGEND) * end_s)?;
    Ok(view)
}

/// Behind everything else: empty until the viewer is switched to the planner's own timeline.
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
