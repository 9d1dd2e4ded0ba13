//! Planning in the loop: horizons, candidates, cost maps, and the time that planning took.

use scenarios::Scenario;
use scenarios::in_loop::Node;
use sim::multirotor::Reference;
use sim::{PlanningLog, Replan};

use super::super::{Changes, Curve, Lines, Paint, Scene, Series, Shape, colours, is_finite, item_path};

/// Number of horizons that are visible at a time, the current one included.
const HORIZONS: usize = 8;
/// Points of a horizon between two nodes.
const POINTS_PER_INTERVAL: usize = 4;
/// Largest number of intervals of a horizon that are drawn.
const MAX_HORIZON_POINTS: usize = 1000;
/// Largest number of edges of a cost map that are drawn.
const MAX_EDGES: usize = 4000;

/// Adds every replan of every vehicle.
pub(super) fn add(scene: &mut Scene<'_>, scenario: &Scenario, log: &PlanningLog) {
    let count = scenario.vehicles.len();
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        let colour = colours::vehicle(index, count);
        let replans: Vec<&Replan> = log.replans.iter().filter(|replan| replan.vehicle == index).collect();
        let mut change = |kind: &str, shapes: Vec<(f64, Shape)>| {
            if !shapes.is_empty() {
                scene.changes.push(Changes { path: item_path(&[kind, &vehicle.name]), shapes });
            }
        };
        change("horizon", horizons(&replans, colour));
        change("candidates", candidates(&replans, colour));
        change("route", routes(&replans));
        change("cost_map", cost_maps(&replans));
        add_times(scene, &vehicle.name, colour, &replans);
    }
}

/// The current horizon and the ones before it, which fade.
fn horizons(replans: &[&Replan], colour: [u8; 3]) -> Vec<(f64, Shape)> {
    let mut visible: Vec<Vec<[f64; 3]>> = Vec::new();
    let mut shapes = Vec::new();
    for replan in replans.iter().filter(|replan| !replan.nodes.is_empty()) {
        visible.insert(0, points_m(&replan.nodes));
        visible.truncate(HORIZONS);
        let ages = || 0..visible.len();
        let lines = Lines {
            strips: visible.clone(),
            paints: ages().map(|age| Paint::translucent(colour, 1.0 / (1.0 + age as f64))).collect(),
            radii: ages().map(|age| if age == 0 { 2.2 } else { 0.9 }).collect(),
            label: None,
        };
        shapes.push((replan.takes_effect_s, lines.into()));
    }
    shapes
}

fn candidates(replans: &[&Replan], colour: [u8; 3]) -> Vec<(f64, Shape)> {
    let shape = |replan: &&Replan| {
        let strips = replan.diagnostics.candidates.iter().map(|path| finite(path)).collect();
        (replan.asked_s, planner_lines(strips, colours::dimmed(colour), 0.5))
    };
    replans.iter().map(shape).collect()
}

fn routes(replans: &[&Replan]) -> Vec<(f64, Shape)> {
    let shape =
        |replan: &&Replan| (replan.asked_s, planner_lines(vec![finite(&replan.diagnostics.route)], colours::KEPT, 0.8));
    replans.iter().map(shape).collect()
}

/// One shape each time that the cost map was rebuilt.
fn cost_maps(replans: &[&Replan]) -> Vec<(f64, Shape)> {
    let shape = |replan: &&Replan| {
        let edges = replan.diagnostics.graph.as_ref()?.iter().take(MAX_EDGES);
        let strips = edges.map(|edge| finite(edge)).collect();
        Some((replan.asked_s, planner_lines(strips, colours::COST_MAP, 0.4)))
    };
    replans.iter().filter_map(shape).collect()
}

fn planner_lines(strips: Vec<Vec<[f64; 3]>>, colour: [u8; 3], radius: f32) -> Shape {
    Lines::new(strips, Paint::translucent(colour, 0.6), radius).into()
}

fn add_times(scene: &mut Scene<'_>, vehicle: &str, colour: [u8; 3], replans: &[&Replan]) {
    let wall_ms: Curve = replans.iter().map(|replan| (replan.asked_s, 1e3 * replan.wall_s)).collect();
    let delay_ms: Curve =
        replans.iter().map(|replan| (replan.asked_s, 1e3 * (replan.takes_effect_s - replan.asked_s))).collect();
    for (group, curve) in [("planning_time_ms", wall_ms), ("delay_ms", delay_ms)] {
        scene.series.push(Series { width: 1.2, ..Series::new(group, vehicle, colour, curve) });
    }
}

/// A horizon as it is flown: a cubic between each two nodes; of many nodes, points at equal times.
fn points_m(nodes: &[Node]) -> Vec<[f64; 3]> {
    let [first, .., last] = nodes else { return nodes.iter().map(|node| node.position_m).collect() };
    let reference = Reference::new(nodes.to_vec());
    let point_m = |t_s: f64| reference.at(t_s).position_m.into();
    if nodes.len() * POINTS_PER_INTERVAL > MAX_HORIZON_POINTS {
        let step_s = (last.t_s - first.t_s) / MAX_HORIZON_POINTS as f64;
        return (0..=MAX_HORIZON_POINTS).map(|i| point_m(first.t_s + i as f64 * step_s)).collect();
    }
    let times_s = nodes.windows(2).flat_map(|pair| {
        let (from_s, step_s) = (pair[0].t_s, (pair[1].t_s - pair[0].t_s) / POINTS_PER_INTERVAL as f64);
        (0..POINTS_PER_INTERVAL).map(move |i| from_s + i as f64 * step_s)
    });
    times_s.chain([last.t_s]).map(point_m).collect()
}

fn finite(path: &[[f64; 3]]) -> Vec<[f64; 3]> {
    path.iter().filter(|point| is_finite(point)).copied().collect()
}
