//! Planning in the loop: horizons, candidates, cost maps, and how long it took.

use rerun::{LineStrips3D, RecordingStream};
use scenarios::Scenario;
use scenarios::in_loop::Node;
use sim::multirotor::Reference;
use sim::{PlanningLog, Replan};

use super::super::decimation::Curve;
use super::super::series::log_curve;
use super::super::world::pixels;
use super::super::{Logged, SIM_TIME, entity, palette, to_f32};

/// Horizons that are still to be seen, the last one among them.
const HORIZONS: usize = 8;
/// Points of a horizon between two nodes.
const POINTS_PER_INTERVAL: usize = 4;
/// Most edges of a cost map that are drawn.
const MOST_EDGES: usize = 4000;
/// Colour of the cost map.
const COST_MAP: [u8; 3] = [62, 84, 104];

/// Logs every replan of every vehicle.
pub fn log(stream: &RecordingStream, scenario: &Scenario, log: &PlanningLog) -> Logged {
    let count = scenario.vehicles.len();
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        let colour = palette::vehicle(index, count);
        let replans: Vec<&Replan> = log.replans.iter().filter(|replan| replan.vehicle == index).collect();
        log_space(stream, &vehicle.name, colour, &replans)?;
        log_times(stream, &vehicle.name, colour, &replans)?;
    }
    Ok(())
}

fn log_space(stream: &RecordingStream, name: &str, colour: [u8; 3], replans: &[&Replan]) -> Logged {
    let mut horizons: Vec<Vec<[f32; 3]>> = Vec::new();
    for replan in replans {
        stream.set_duration_secs(SIM_TIME, replan.takes_effect_s);
        if !replan.nodes.is_empty() {
            horizons.insert(0, points(&replan.nodes));
            horizons.truncate(HORIZONS);
            let fading = (0..horizons.len()).map(|age| palette::translucent(colour, 1.0 / (1.0 + age as f64)));
            let widths = (0..horizons.len()).map(|age| pixels(if age == 0 { 2.2 } else { 0.9 }));
            let strips = LineStrips3D::new(horizons.clone()).with_colors(fading).with_radii(widths);
            stream.log(entity("world/horizon", name), &strips)?;
        }
        stream.set_duration_secs(SIM_TIME, replan.asked_s);
        let strips = |paths: &[Vec<[f64; 3]>], colour: [u8; 3], radius: f32| {
            LineStrips3D::new(paths.iter().map(|path| finite(path)))
                .with_colors([palette::translucent(colour, 0.6)])
                .with_radii([pixels(radius)])
        };
        let diagnostics = &replan.diagnostics;
        stream.log(entity("world/candidates", name), &strips(&diagnostics.candidates, palette::dimmed(colour), 0.5))?;
        let route = std::slice::from_ref(&diagnostics.route);
        stream.log(entity("world/route", name), &strips(route, palette::KEPT, 0.8))?;
        if let Some(graph) = &diagnostics.graph {
            let edges: Vec<Vec<[f64; 3]>> = graph.iter().take(MOST_EDGES).map(|edge| edge.to_vec()).collect();
            stream.log(entity("world/cost_map", name), &strips(&edges, COST_MAP, 0.4))?;
        }
    }
    stream.reset_time();
    Ok(())
}

fn log_times(stream: &RecordingStream, name: &str, colour: [u8; 3], replans: &[&Replan]) -> Logged {
    let walls: Curve = replans.iter().map(|replan| (replan.asked_s, 1e3 * replan.wall_s)).collect();
    log_curve(stream, entity("plots/replan", name), name, palette::opaque(colour), 1.2, walls)?;
    let delays: Curve =
        replans.iter().map(|replan| (replan.asked_s, 1e3 * (replan.takes_effect_s - replan.asked_s))).collect();
    log_curve(stream, entity("plots/delay", name), name, palette::opaque(colour), 1.2, delays)
}

/// A horizon as it is flown: a cubic between each two nodes.
fn points(nodes: &[Node]) -> Vec<[f32; 3]> {
    let reference = Reference::new(nodes.to_vec());
    let times_s = nodes.windows(2).flat_map(|pair| {
        let (from_s, step_s) = (pair[0].t_s, (pair[1].t_s - pair[0].t_s) / POINTS_PER_INTERVAL as f64);
        (0..POINTS_PER_INTERVAL).map(move |i| from_s + i as f64 * step_s)
    });
    let last = nodes.last().map(|node| node.t_s);
    times_s.chain(last).map(|t_s| to_f32(reference.at(t_s).position_m.into())).collect()
}

fn finite(path: &[[f64; 3]]) -> Vec<[f32; 3]> {
    path.iter().filter(|point| point.iter().all(|x| x.is_finite())).map(|point| to_f32(*point)).collect()
}
