//! Translation of a scenario to a [`Problem`] and its [`Options`].

use scenarios::slung_load::{Cable, Limits as ScenarioLimits, Model, State};
use scenarios::{Collocation, Family, Formulation, GRAVITY_MPS2, Objective, Range, Scenario, Shape, Torques, Window};

use super::optimise::Options;
use super::polygon::Polygon;
use super::problem::{
    Avoidance, CableMode, Gate, InitialCondition, Limits, Phase, Problem, TorqueModel, VehicleParameters, Weights,
};
use crate::planner::{ignored_geofence, ignored_solid, ignored_via_point};
use crate::pseudospectral::{Duration, Tolerances};

/// The paper's safety distance r', m.
const PAPER_CLEARANCE_M: f64 = 0.05;

/// Mean speed that determines the flight time if the scenario does not, m/s, and the minimum flight time, s.
const DEFAULT_SPEED_MPS: f64 = 1.0;
const MIN_DEFAULT_TIME_S: f64 = 2.0;

/// Minimum duration of a phase, s.
const MIN_PHASE_S: f64 = 0.02;

/// Offset of the floor below the ground, m, so that a load that leaves the ground has a feasible interior.
const FLOOR_OFFSET_M: f64 = 1e-4;

/// Tolerance within which a load is on the ground, or a cable is taut, m.
const CONTACT_TOLERANCE_M: f64 = 1e-3;

/// Maximum initial |α| and |β|, rad: the coordinates are singular at a right angle.
const MAX_INITIAL_ANGLE_RAD: f64 = 1.4;

/// Guessed duration of a slack phase in mid-flight, s, and minimum of a fall through the slack on the ground, s.
const SLACK_GUESS_S: f64 = 0.2;
const MIN_FALL_S: f64 = 0.1;

/// Maximum duration of a phase of a minimum-time problem, as a multiple of the guessed flight time.
const MAX_TIME_RATIO: f64 = 4.0;

/// An interval without ends.
const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

/// Why this planner cannot handle a scenario; none if it can.
pub fn unsupported_reason(scenario: &Scenario) -> Option<String> {
    let [vehicle] = scenario.vehicles.as_slice() else {
        return Some("it plans for one vehicle".into());
    };
    if scenario.family() != Family::SlungLoad {
        return Some(format!("vehicle `{}` is not a quadrotor with a slung load", vehicle.name));
    }
    if let Some(reason) =
        ignored_geofence(scenario).or_else(|| ignored_solid(scenario)).or_else(|| ignored_via_point(scenario))
    {
        return Some(reason);
    }
    let settings = scenario.planner.collocation.clone().unwrap_or_default();
    let cable = cable_phases(scenario, &settings);
    let start = initial_condition(scenario);
    let reason = if !scenario.world.cylinders.is_empty() {
        "it avoids obstacles with flat faces only, not cylinders"
    } else if vehicle.start.speed_mps != 0.0 || vehicle.goal.speed_mps != 0.0 {
        "it plans from rest to rest"
    } else if vehicle.goal.load.is_some() {
        "at the goal the load hangs straight down"
    } else if is_complementary(&settings) && !scenario.world.gates.is_empty() {
        "a gate is passed between two phases, and the complementarity formulation has only one"
    } else if is_complementary(&settings) && is_on_ground(scenario) {
        "the load starts on the ground, which the complementarity formulation does not model"
    } else if repeated_phases(&cable) != scenario.world.gates.len() {
        "each gate needs two consecutive cable phases of the same kind, and their number differs from that of the gates"
    } else if gates(scenario).any(|gate| gate.quadrotor_m.iter().chain(&gate.load_m).any(|[low, high]| low >= high)) {
        "a gate's window is narrower than twice the margin"
    } else if cable.last() == Some(&Cable::Slack) {
        "the cable is taut at the goal, so the last phase must be taut"
    } else if start.cable[0].abs().max(start.cable[1].abs()) > MAX_INITIAL_ANGLE_RAD {
        "the load starts beside or above the quadrotor"
    } else if !is_complementary(&settings) && first_mode(scenario) == CableMode::Taut && is_slack(scenario, &start) {
        "the cable is slack at the start, so the first phase must be slack"
    } else {
        return None;
    };
    Some(reason.to_owned())
}

/// The optimal control problem of a scenario that this planner does not refuse.
pub fn problem(scenario: &Scenario) -> Problem {
    let vehicle = &scenario.vehicles[0];
    let model = scenario.slung_load_model(vehicle);
    let settings = scenario.planner.collocation.clone().unwrap_or_default();
    let world = &scenario.world;
    let prisms = world.prism_obstacles();
    Problem {
        vehicle: vehicle_parameters(model),
        limits: Limits {
            clearance_m: scenario.planner.margin_m.unwrap_or(PAPER_CLEARANCE_M),
            floor_m: world.ground_m.map(|ground_m| ground_m + model.load_radius_m - FLOOR_OFFSET_M),
            position_m: world.map.inset(model.body_radius_m()).axes().map(interval),
            ..limits(&model.planning_limits)
        },
        weights: match settings.objective.unwrap_or(Objective::Effort) {
            Objective::Effort => Weights::effort(),
            Objective::Time => Weights::time(),
        },
        obstacle_names: prisms.iter().map(|prism| prism.name.clone()).collect(),
        obstacle_altitudes_m: prisms.iter().map(|prism| prism.z_m.map_or(UNBOUNDED, interval)).collect(),
        obstacles: prisms.into_iter().map(|prism| Polygon::new(prism.corners_m)).collect(),
        avoidance: match settings.shape.unwrap_or(Shape::Envelope) {
            Shape::Envelope => Avoidance::SmoothEnvelope,
            Shape::RFunction => Avoidance::RFunction,
            Shape::Parts => Avoidance::Parts,
        },
        torques: match settings.torques.unwrap_or(Torques::Body) {
            Torques::Body => TorqueModel::Body,
            Torques::Generalised => TorqueModel::Generalised,
        },
        start: initial_condition(scenario),
        goal_m: vehicle.goal.position_m(),
        phases: phases(scenario, &settings),
    }
}

/// The solver options of a scenario.
pub fn options(scenario: &Scenario) -> Options {
    let settings = scenario.planner.collocation.clone().unwrap_or_default();
    let defaults = Options::default();
    let tolerances = match settings.mesh_tolerance {
        Some(tolerance) if tolerance <= 0.0 => None,
        Some(error) => defaults.tolerances.map(|tolerances| Tolerances { error, ..tolerances }),
        None => defaults.tolerances,
    };
    let mut options = Options {
        segments: settings.segments.unwrap_or(defaults.segments),
        points: settings.points.unwrap_or(defaults.points),
        is_graded: settings.segments.is_none(),
        tolerances,
        ..defaults
    };
    if let Some(max_iterations) = scenario.planner.max_iterations {
        options.solver.max_iterations = max_iterations;
    }
    options
}

fn vehicle_parameters(model: &Model) -> VehicleParameters {
    VehicleParameters {
        quadrotor_kg: model.mass_kg,
        load_kg: model.load_mass_kg,
        cable_m: model.cable_length_m,
        arm_m: model.arm_m,
        yaw_m: model.torque_per_thrust_m,
        inertia_kgm2: model.inertia_kgm2,
        radius_m: model.body_radius_m(),
        load_radius_m: model.load_radius_m,
    }
}

fn limits(limits: &ScenarioLimits) -> Limits {
    let radians = |range: Range| interval(range).map(f64::to_radians);
    Limits {
        thrust_n: interval(limits.thrust_n),
        euler_rad: radians(limits.attitude_deg),
        cable_rad: radians(limits.cable_deg),
        tension_n: limits.tension_n,
        position_m: [[f64::NEG_INFINITY, f64::INFINITY]; 3],
        clearance_m: 0.0,
        floor_m: None,
    }
}

fn interval(range: Range) -> [f64; 2] {
    [range.min, range.max]
}

/// The initial condition in the planner's coordinates.
fn initial_condition(scenario: &Scenario) -> InitialCondition {
    let vehicle = &scenario.vehicles[0];
    let model = scenario.slung_load_model(vehicle);
    let state = State::at(&vehicle.start, model.cable_length_m);
    let length_m = state.cable_length_m();
    let [x, y, z] = state.cable_m().map(|component| component / length_m);
    InitialCondition { position_m: state.position_m, cable: [y.asin(), (-x).atan2(-z), length_m] }
}

/// Whether the cable is slack at the start.
fn is_slack(scenario: &Scenario, start: &InitialCondition) -> bool {
    let model = scenario.slung_load_model(&scenario.vehicles[0]);
    start.cable[2] < model.cable_length_m - CONTACT_TOLERANCE_M
}

fn is_on_ground(scenario: &Scenario) -> bool {
    let vehicle = &scenario.vehicles[0];
    let model = scenario.slung_load_model(vehicle);
    let load_m = State::at(&vehicle.start, model.cable_length_m).load_position_m[2] - model.load_radius_m;
    scenario.world.ground_m.is_some_and(|ground_m| load_m <= ground_m + CONTACT_TOLERANCE_M)
}

/// Mode of the first phase.
fn first_mode(scenario: &Scenario) -> CableMode {
    let settings = scenario.planner.collocation.clone().unwrap_or_default();
    match settings.cable.unwrap_or_default().first() {
        Some(Cable::Slack) if is_on_ground(scenario) => CableMode::OnGround,
        Some(Cable::Slack) => CableMode::Slack,
        Some(Cable::Taut) | None => CableMode::Taut,
    }
}

/// States of the cable, one per phase; by default it is taut, with a phase boundary at every gate.
fn cable_phases(scenario: &Scenario, settings: &Collocation) -> Vec<Cable> {
    let taut = || vec![Cable::Taut; scenario.world.gates.len() + 1];
    settings.cable.clone().filter(|phases| !phases.is_empty()).unwrap_or_else(taut)
}

fn is_complementary(settings: &Collocation) -> bool {
    settings.formulation == Some(Formulation::Complementarity)
}

/// Number of phases that are followed by one of the same kind.
fn repeated_phases(phases: &[Cable]) -> usize {
    phases.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

/// The gates, with windows reduced by the margin.
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

/// Maximum durations of the phases, as fractions of the flight time, which leave time for the last phase.
fn max_fractions(phases: &[Cable]) -> Vec<f64> {
    let weights = phases.iter().map(|phase| if *phase == Cable::Taut { 3.0 } else { 1.0 });
    let sum: f64 = weights.clone().take(phases.len() - 1).sum();
    weights.map(|weight| 0.9 * weight / sum.max(1.0)).collect()
}

/// The phases with their durations; where the flight time is fixed, the last phase takes the remainder.
fn phases(scenario: &Scenario, settings: &Collocation) -> Vec<Phase> {
    let cable = cable_phases(scenario, settings);
    let mut gates = gates(scenario);
    let total_s = settings.flight_time_s.unwrap_or_else(|| default_time_s(scenario));
    let is_min_time = settings.objective == Some(Objective::Time);
    let last = cable.len() - 1;
    let taut_count = cable.iter().filter(|phase| **phase == Cable::Taut).count();
    let max_fractions = max_fractions(&cable);
    let mut elapsed_s = 0.0;
    let mut phases = Vec::with_capacity(cable.len());
    for (index, phase) in cable.iter().enumerate() {
        let mode = match phase {
            _ if is_complementary(settings) => CableMode::COMPLEMENTARITY,
            Cable::Taut => CableMode::Taut,
            Cable::Slack if cable[..index].iter().all(|phase| *phase == Cable::Slack) => first_mode(scenario),
            Cable::Slack => CableMode::Slack,
        };
        let guess_s =
            if index == last { total_s - elapsed_s } else { phase_guess_s(scenario, mode, total_s, taut_count) };
        elapsed_s += guess_s;
        let max_s = if is_min_time { MAX_TIME_RATIO * total_s } else { max_fractions[index] * total_s };
        let duration = if index < last || is_min_time {
            Duration::Free { min_s: MIN_PHASE_S, guess_s, max_s }
        } else if last == 0 {
            Duration::Fixed(total_s)
        } else {
            Duration::Remainder(total_s)
        };
        let is_gate = cable.get(index + 1) == Some(phase);
        let gate = if is_gate { gates.next() } else { None };
        phases.push(Phase { mode, duration, max_impulse_ns: settings.impact_ns, gate });
    }
    phases
}

/// Guessed duration of a phase before the last one, s: a free fall through the slack, or an equal part of the flight
/// time.
fn phase_guess_s(scenario: &Scenario, mode: CableMode, total_s: f64, taut_count: usize) -> f64 {
    let model = scenario.slung_load_model(&scenario.vehicles[0]);
    let slack_m = (model.cable_length_m - initial_condition(scenario).cable[2]).max(0.0);
    let fall_s = (2.0 * slack_m / GRAVITY_MPS2).sqrt();
    match mode {
        CableMode::OnGround => 2.0 * fall_s.max(MIN_FALL_S),
        CableMode::Slack if slack_m > CONTACT_TOLERANCE_M => fall_s,
        CableMode::Slack => SLACK_GUESS_S,
        CableMode::Taut | CableMode::Complementarity { .. } => total_s / taut_count as f64,
    }
}

/// Flight time at the default mean speed, s.
fn default_time_s(scenario: &Scenario) -> f64 {
    let vehicle = &scenario.vehicles[0];
    let [from, to] = [vehicle.start.position_m(), vehicle.goal.position_m()];
    let distance_m = from.iter().zip(to).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    (distance_m / DEFAULT_SPEED_MPS).max(MIN_DEFAULT_TIME_S)
}
