//! A quadrotor with a slung load: both bodies, cable and envelope; thrusts, tension, swing, cable states.

mod bodies;
mod series;

use sim::Flight;

use super::{FamilyScene, PlotView, Scene, Tab};
use crate::output::run::JudgedRun;

/// What a slung load adds to a scene.
pub const SCENE: FamilyScene = FamilyScene { add, legend, end_of_plan: "the plan ends, the vehicle hovers" };

fn add<'a>(scene: &mut Scene<'a>, run: &JudgedRun<'a>, flight: &'a Flight) {
    for log in &flight.vehicles {
        bodies::add(scene, run, log);
    }
    series::add(scene, run, flight);
    scene.verdict_plots = vec![
        PlotView::new("clearance_m", "Clearance of parts and envelope [m]", 1.0),
        PlotView::new("tracking_m", "Tracking error: distance from the plan [m]", 1.0),
        PlotView::new("cable", "Cable: 1 taut, 0 slack", 0.7),
    ];
    let forces = vec![
        PlotView::new("thrust_n", "Thrust of each rotor [N]", 1.4),
        PlotView::new("tension_n", "Tension of the cable, mean over 20 ms [N]", 1.0),
        PlotView::new("swing_deg", "Angle of the cable from straight down [deg]", 1.0),
    ];
    scene.tabs.push(Tab { name: "Forces", plots: forces });
}

fn legend(_: &JudgedRun<'_>) -> Vec<String> {
    let lines = [
        "- everything is to scale; unbounded obstacles are drawn from the floor to the ceiling of the map",
        "- red: obstacles, limits, violations",
        "- thin dim line: planned; bright line: flown; amber: the load",
        "- cable: straight while taut, coloured by its tension from green (none) to red (three times the load's weight); \
         grey and loose while slack",
        "- blue circle: the envelope, body or horizontal reach of the load, whichever is larger",
        "- line with a label: closest approach of a part to an obstacle, green if the limit was kept",
    ];
    lines.map(str::to_owned).to_vec()
}
