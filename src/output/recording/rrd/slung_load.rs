//! What a quadrotor with a slung load adds to a recording, in the place of aircraft and load factors.
//!
//! | entities | what | where it is written |
//! |---|---|---|
//! | `/world/quadrotor`, `/world/load` | the moving bodies | `scene` |
//! | `/world/cable` | a straight line in the colour of its tension while taut, a grey loose one while slack | `scene` |
//! | `/world/envelope` | the envelope circle, at the quadrotor's height | `scene` |
//! | `/world/planned_load`, `/world/flown_load` | paths of the load | `scene` |
//! | `/plots/thrust`, `/plots/tension`, `/plots/tracking`, `/plots/clearance` | time series | `series` |
//! | `/plots/cable`, `/state/cable` | slack and taut, planned and flown, as steps and as states | `series` |

mod scene;
mod series;

use rerun::RecordingStream;
use rerun::external::re_sdk_types::blueprint::archetypes::PlotLegend;
use rerun::external::re_sdk_types::blueprint::components::Corner2D;
use sim::Flight;

use super::blueprint::{Blueprint, Part, ViewClass};
use super::series::end_s;
use super::{Logged, Run};

type Error = Box<dyn std::error::Error + Send + Sync>;

/// Logs everything that the flight of a slung load has of its own.
pub fn log(stream: &RecordingStream, run: &Run<'_>, flight: &Flight) -> Logged {
    for log in &flight.vehicles {
        scene::log(stream, run, log)?;
    }
    series::log(stream, run, flight)
}

/// The plots below the verdict: clearance, tracking, and what the cable does.
pub fn verdict_rows(layout: &Blueprint, flight: &Flight) -> Result<Vec<(Part, f32)>, Error> {
    Ok(vec![
        (plot(layout, flight, "clearance", "Clearance of parts and envelope [m]")?, 1.0),
        (plot(layout, flight, "tracking", "Tracking error: distance from the plan [m]")?, 1.0),
        (plot(layout, flight, "cable", "Cable: 1 taut, 0 slack")?, 0.7),
    ])
}

/// The tab of what drives the motion: thrusts and tension.
pub fn forces(layout: &Blueprint, flight: &Flight) -> Result<Part, Error> {
    let rows = [
        (plot(layout, flight, "thrust", "Thrust of each rotor [N]")?, 1.4),
        (plot(layout, flight, "tension", "Tension of the cable, mean over 20 ms [N]")?, 1.0),
        (plot(layout, flight, "swing", "Angle of the cable from straight down [deg]")?, 1.0),
    ];
    layout.rows("Forces", &rows)
}

fn plot(layout: &Blueprint, flight: &Flight, group: &str, title: &str) -> Result<Part, Error> {
    let contents = [format!("/plots/{group}/**"), format!("/limits/{group}/**")];
    let view = layout.view(ViewClass::TimeSeries, title, "/", &contents)?;
    layout.property(&view, "PlotLegend", &PlotLegend::new().with_corner(Corner2D::RightTop))?;
    layout.times(&view, 0.0, 1.25 * end_s(flight))?;
    Ok(view)
}
