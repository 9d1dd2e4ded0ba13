//! From a scenario to the planner's problem.

use scenarios::slung_load::{Cable, Limits as ScenarioLimits, Model, State};
use scenarios::{Collocation, Family, Formulation, Objective, Range, Scenario, Shape, Window};

use super::optimise::Options;
use super::polygon::Polygon;
use super::problem::{Body, GRAVITY, Gate, Limits, Mode, Problem, Rest, Stage, Weights};
use crate::pseudospectral::{Duration, Tolerances};

/// Distance r' that the paper keeps from obstacles, m.
const PAPER_CLEARANCE_M: f64 = 0.05;

/// Mean speed, m/s, for which the time is chosen where neither scenario nor objective says.
const USUAL_SPEED_MPS: f64 = 1.0;

/// Shortest phase, s.
const SHORTEST_S: f64 = 0.02;

/// The floor gives way by so little that a load may leave it and still have an interior to be in, m.
const GROUND_GIVES_M: f64 = 1e-4;

/// A load this much above the ground rests on it, m.
const TOUCH_M: f64 = 1e-3;

/// Why this planner cannot handle a scenario, if it cannot.
pub fn refuses(scenario: &Scenario) -> Option<String> {
    let [vehicle] = scenario.vehicles.as_slice() else {
        return Some("it plans for one vehicle".into());
    };
    if scenario.family() != Family::SlungLoad {
        return Some(format!("vehicle `{}` is not a quadrotor with a slung load", vehicle.name));
    }
    let settings = scenario.planner.collocation.clone().unwrap_or_default();
    let phases = cable(scenario, &settings);
    let start = rest(scenario);
    let complaint = if !scenario.world.cylinders.is_empty() {
        "it avoids obstacles with flat faces only, not cylinders"
    } else if settings.shape == Some(Shape::Parts) {
        "it keeps the envelope circle clear, not body, cable and load each by itself"
    } else if vehicle.start.speed_mps != 0.0 || vehicle.goal.speed_mps != 0.0 {
        "it plans from rest to rest"
    } else if vehicle.goal.load.is_some() {
        "at the goal the load hangs straight down"
    } else if is_complementary(&settings) && !scenario.world.gates.is_empty() {
        "a gate is passed between two phases, and under complementarity there is but one"
    } else if is_complementary(&settings) && rests_on_ground(scenario) {
        "the load begins on the ground, which complementarity knows nothing of"
    } else if alike(&phases).count() != scenario.world.gates.len() {
        "a gate is passed where two phases of the cable in a row are alike, and there are not as many such as gates"
    } else if gates(scenario).any(|gate| gate.quadrotor_m.iter().chain(&gate.load_m).any(|[low, high]| low >= high)) {
        "a gate's window is narrower than twice the margin"
    } else if phases.last() == Some(&Cable::Slack) {
        "the cable is taut at the goal, so the last phase must be taut"
    } else if start.cable[0].abs().max(start.cable[1].abs()) > 1.4 {
        "the load begins beside or above the quadrotor"
    } else if !is_complementary(&settings) && first_mode(scenario) == Mode::Taut && is_slack(scenario, &start) {
        "the cable is slack at the start, so the first phase must be slack"
    } else {
        return None;
    };
    Some(complaint.to_owned())
}

/// The problem that a scenario poses.
pub fn problem(scenario: &Scenario) -> Problem {
    let vehicle = &scenario.vehicles[0];
    let model = scenario.slung_load_model(vehicle);
    let settings = scenario.planner.collocation.clone().unwrap_or_default();
    let world = &scenario.world;
    Problem {
        body: body(model),
        limits: Limits {
            clearance_m: scenario.planner.margin_m.unwrap_or(PAPER_CLEARANCE_M),
            floor_m: world.ground_m.map(|ground_m| ground_m + model.load_radius_m - GROUND_GIVES_M),
            position_m: world.map.axes().map(ends),
            ..limits(&model.planning_limits)
        },
        weights: match settings.objective.unwrap_or(Objective::Effort) {
            Objective::Effort => Weights::effort(),
            Objective::Time => Weights::time(),
        },
        obstacle_names: world.flat_obstacles().into_iter().map(|prism| prism.name).collect(),
        obstacles: world.flat_obstacles().into_iter().map(|prism| Polygon::new(prism.corners_m)).collect(),
        start: rest(scenario),
        goal_m: vehicle.goal.position_m(),
        stages: stages(scenario, &settings),
    }
}

/// How it is to be solved.
pub fn options(scenario: &Scenario) -> Options {
    let settings = scenario.planner.collocation.clone().unwrap_or_default();
    let usual = Options::default();
    let tolerances = match settings.mesh_tolerance {
        Some(tolerance) if tolerance <= 0.0 => None,
        Some(error) => usual.tolerances.map(|tolerances| Tolerances { error, ..tolerances }),
        None => usual.tolerances,
    };
    let mut options = Options {
        segments: settings.segments.unwrap_or(usual.segments),
        points: settings.points.unwrap_or(usual.points),
        is_graded: settings.segments.is_none(),
        tolerances,
        ..usual
    };
    if let Some(most) = scenario.planner.max_iterations {
        options.solver.max_iterations = most;
    }
    options
}

fn body(model: &Model) -> Body {
    Body {
        quadrotor_kg: model.mass_kg,
        load_kg: model.load_mass_kg,
        cable_m: model.cable_length_m,
        arm_m: model.arm_m,
        yaw_m: model.torque_per_thrust_m,
        inertia_kgm2: model.inertia_kgm2,
        radius_m: model.body_radius_m(),
    }
}

fn limits(limits: &ScenarioLimits) -> Limits {
    let radians = |range: Range| ends(range).map(f64::to_radians);
    Limits {
        thrust_n: ends(limits.thrust_n),
        euler_rad: radians(limits.attitude_deg),
        cable_rad: radians(limits.cable_deg),
        tension_n: limits.tension_n,
        position_m: [[f64::NEG_INFINITY, f64::INFINITY]; 3],
        clearance_m: 0.0,
        floor_m: None,
    }
}

fn ends(range: Range) -> [f64; 2] {
    [range.min, range.max]
}

/// The start in the planner's coordinates.
fn rest(scenario: &Scenario) -> Rest {
    let vehicle = &scenario.vehicles[0];
    let model = scenario.slung_load_model(vehicle);
    let state = State::at(&vehicle.start, model.cable_length_m);
    let length_m = state.cable_length_m();
    let [x, y, z] = state.cable_m().map(|component| component / length_m);
    Rest { position_m: state.position_m, cable: [y.asin(), (-x).atan2(-z), length_m] }
}

fn is_slack(scenario: &Scenario, start: &Rest) -> bool {
    let model = scenario.slung_load_model(&scenario.vehicles[0]);
    start.cable[2] < model.cable_length_m - TOUCH_M
}

fn rests_on_ground(scenario: &Scenario) -> bool {
    let vehicle = &scenario.vehicles[0];
    let model = scenario.slung_load_model(vehicle);
    let load_m = State::at(&vehicle.start, model.cable_length_m).load_position_m[2] - model.load_radius_m;
    scenario.world.ground_m.is_some_and(|ground_m| load_m <= ground_m + TOUCH_M)
}

fn first_mode(scenario: &Scenario) -> Mode {
    let settings = scenario.planner.collocation.clone().unwrap_or_default();
    match settings.cable.unwrap_or_default().first() {
        Some(Cable::Slack) if rests_on_ground(scenario) => Mode::Parked,
        Some(Cable::Slack) => Mode::Slack,
        Some(Cable::Taut) | None => Mode::Taut,
    }
}

/// What the cable does, phase after phase; where nothing is said, it is taut from gate to gate.
fn cable(scenario: &Scenario, settings: &Collocation) -> Vec<Cable> {
    let taut = || vec![Cable::Taut; scenario.world.gates.len() + 1];
    settings.cable.clone().filter(|phases| !phases.is_empty()).unwrap_or_else(taut)
}

fn is_complementary(settings: &Collocation) -> bool {
    settings.formulation == Some(Formulation::Complementarity)
}

/// Phases after which one of the same kind follows.
fn alike(phases: &[Cable]) -> impl Iterator<Item = usize> {
    phases.windows(2).enumerate().filter(|(_, pair)| pair[0] == pair[1]).map(|(phase, _)| phase)
}

/// The gates, their windows narrower by the margin.
fn gates(scenario: &Scenario) -> impl Iterator<Item = Gate> {
    let margin_m = scenario.planner.margin_m.unwrap_or(PAPER_CLEARANCE_M);
    let faces = move |range: Option<Range>| match range {
        Some(Range { min, max }) => [min + margin_m, max - margin_m],
        None => [f64::NEG_INFINITY, f64::INFINITY],
    };
    let window = move |window: &Window| window.axes().map(faces);
    scenario
        .world
        .gates
        .iter()
        .map(move |gate| Gate { quadrotor_m: window(&gate.quadrotor), load_m: window(&gate.load) })
}

/// The longest that each phase may take, as shares of the flight time, so that something is left for the last one.
fn shares(phases: &[Cable]) -> Vec<f64> {
    let weights = phases.iter().map(|phase| if *phase == Cable::Taut { 3.0 } else { 1.0 });
    let sum: f64 = weights.clone().take(phases.len() - 1).sum();
    weights.map(|weight| 0.9 * weight / sum.max(1.0)).collect()
}

/// The phases with their durations: the last one takes what is left of the flight time, if there is one.
fn stages(scenario: &Scenario, settings: &Collocation) -> Vec<Stage> {
    let phases = cable(scenario, settings);
    let mut gates = gates(scenario);
    let total_s = settings.flight_time_s.unwrap_or_else(|| usual_time_s(scenario));
    let is_open = settings.objective == Some(Objective::Time);
    let last = phases.len() - 1;
    let taut_count = phases.iter().filter(|phase| **phase == Cable::Taut).count();
    let shares = shares(&phases);
    let mut so_far_s = 0.0;
    let mut stages = Vec::with_capacity(phases.len());
    for (index, phase) in phases.iter().enumerate() {
        let mode = match phase {
            _ if is_complementary(settings) => Mode::COMPLEMENTARITY,
            Cable::Taut => Mode::Taut,
            Cable::Slack if phases[..index].iter().all(|phase| *phase == Cable::Slack) => first_mode(scenario),
            Cable::Slack => Mode::Slack,
        };
        let guess_s =
            if index == last { total_s - so_far_s } else { phase_guess_s(scenario, mode, total_s, taut_count) };
        so_far_s += guess_s;
        let most_s = if is_open { 4.0 * total_s } else { shares[index] * total_s };
        let duration = if index < last || is_open {
            Duration::Free { least_s: SHORTEST_S, guess_s, most_s }
        } else if last == 0 {
            Duration::Fixed(total_s)
        } else {
            Duration::RestOf(total_s)
        };
        let is_gate = phases.get(index + 1) == Some(phase);
        let gate = if is_gate { gates.next() } else { None };
        stages.push(Stage { mode, duration, impulse_ns: settings.impact_ns, gate });
    }
    stages
}

/// About how long a phase before the last one takes: a fall through the slack, or an equal share.
fn phase_guess_s(scenario: &Scenario, mode: Mode, total_s: f64, taut_count: usize) -> f64 {
    let model = scenario.slung_load_model(&scenario.vehicles[0]);
    let slack_m = (model.cable_length_m - rest(scenario).cable[2]).max(0.0);
    let fall_s = (2.0 * slack_m / GRAVITY).sqrt();
    match mode {
        Mode::Parked => 2.0 * fall_s.max(0.1),
        Mode::Slack if slack_m > TOUCH_M => fall_s,
        Mode::Slack => 0.2,
        Mode::Taut | Mode::Either { .. } => total_s / taut_count as f64,
    }
}

fn usual_time_s(scenario: &Scenario) -> f64 {
    let vehicle = &scenario.vehicles[0];
    let [from, to] = [vehicle.start.position_m(), vehicle.goal.position_m()];
    let distance_m = from.iter().zip(to).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    (distance_m / USUAL_SPEED_MPS).max(2.0)
}
