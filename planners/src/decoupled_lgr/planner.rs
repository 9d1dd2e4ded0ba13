//! Planner `decoupled-lgr`: one aircraft after the other by collocation, against those planned before.

use std::time::Instant;

use rayon::prelude::*;
use scenarios::fixed_wing::{Control, State, Trajectory};
use scenarios::{Interpolation, Iteration, Plan, PlanStatus, PlanTimings, Scenario};

use super::guess::Guess;
use super::node_vector::{STATES, VELOCITY};
use super::problem::{Problem, TOLERANCE};
use super::solve::{Options, Sample, Solved, solve};
use super::units::{LENGTH_M, SPEED_MPS, TIME_S};
use crate::nlp::Settings;
use crate::planner::{Planner, PlanningMode, Progress};
use crate::pseudospectral::{Duration, Tolerances};
use crate::scp;

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Legendre-Gauss-Radau collocation, one aircraft after the other: the decoupled pseudospectral baseline of Wang, Xu, Long (2020)",
    handles: "fixed-wing fleets of up to 20 among cylinders",
    unsupported_reason,
    mode: PlanningMode::BeforeFlight(plan),
};

const NAME: &str = "decoupled-lgr";

/// Largest fleet: all others are avoided at every node.
const MAX_VEHICLES: usize = 20;

/// Default first mesh: as many nodes as the papers' planners have.
const SEGMENTS: usize = 10;
const POINTS: usize = 4;

/// Default tolerance of the states, relative to 1 + their size in units of the program: 1e-5 of some 10 km, 0.1 m.
const MESH_TOLERANCE: f64 = 1e-5;

/// Tolerance of the load factors between the nodes.
const OVERSHOOT: f64 = 0.02;

/// Highest order of a segment, and number of meshes.
const MAX_ORDER: usize = 8;
const MAX_MESHES: usize = 10;

/// Largest time between two rows of the plan, s: the controls are linear between them.
const MAX_SAMPLE_S: f64 = 0.1;
/// Largest error of the motion that the load factors alone lead to, as a fraction of the limit of the verdict.
const MAX_ROLLOUT: f64 = 0.9;
/// Time in which the controls of the plan change where those of the optimum jump, s.
const JUMP_S: f64 = 1e-3;

/// Excess of the first common flight time over that of the slowest aircraft alone, as a fraction; it doubles from one round to
/// the next. In its own shortest time an aircraft has no choice left.
const EXCESS: f64 = 0.005;
/// Largest number of rounds.
const ROUNDS: i32 = 8;

/// Bounds of a free flight time, as multiples of the guess.
const TIME_RATIO: [f64; 2] = [0.3, 4.0];

/// Bows of the guesses of a free flight time, as fractions of the chord.
const BOWS: [f64; 2] = [0.25, -0.25];

fn unsupported_reason(scenario: &Scenario) -> Option<String> {
    scp::unsupported_reason(scenario).or_else(|| {
        let count = scenario.vehicles.len();
        (count > MAX_VEHICLES).then(|| format!("it plans for up to {MAX_VEHICLES} aircraft, not {count}"))
    })
}

/// A fleet with the options of its scenario.
struct Fleet<'a> {
    scenario: &'a Scenario,
    options: Options,
}

fn plan(scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
    let begin = Instant::now();
    let fleet = Fleet { scenario, options: options(scenario) };
    let alone: Vec<Option<Solved>> = (0..scenario.vehicles.len()).into_par_iter().map(|i| fleet.alone(i)).collect();
    let Some(alone) = alone.into_iter().collect::<Option<Vec<Solved>>>() else {
        return Plan::no_plan(&scenario.name, NAME, seed, "an aircraft has no guess");
    };
    let mut history = vec![iteration(&alone, begin)];
    progress(&history[0]);
    let slowest = alone.iter().map(Solved::duration).fold(0.0, f64::max);
    let mut order: Vec<usize> = (0..alone.len()).collect();
    order.sort_by(|&i, &j| alone[j].duration().total_cmp(&alone[i].duration()).then(i.cmp(&j)));
    let is_together = scenario.fleet.simultaneous_arrival && alone.len() > 1;
    let mut best = alone;
    for round in 0..ROUNDS {
        let started = Instant::now();
        let common = is_together.then(|| slowest * (1.0 + EXCESS * 2f64.powi(round)));
        best = fleet.round(&order, common, &best);
        history.push(iteration(&best, started));
        progress(&history[history.len() - 1]);
        if best.iter().all(|solved| solved.is_solved) || common.is_none() {
            break;
        }
    }
    assemble(scenario, seed, &best, history, begin)
}

fn options(scenario: &Scenario) -> Options {
    let collocation = scenario.planner.collocation.clone().unwrap_or_default();
    let error = collocation.mesh_tolerance.unwrap_or(MESH_TOLERANCE);
    let tolerances = Tolerances { error, violation: TOLERANCE, overshoot: OVERSHOOT, max_order: MAX_ORDER };
    let defaults = Settings::default();
    let max_iterations = scenario.planner.max_iterations.unwrap_or(defaults.max_iterations);
    Options {
        mesh: (collocation.segments.unwrap_or(SEGMENTS), collocation.points.unwrap_or(POINTS)),
        tolerances: (error > 0.0).then_some(tolerances),
        max_meshes: MAX_MESHES,
        solver: Settings { tolerance: 1e-6, max_iterations, ..defaults },
        step: MAX_SAMPLE_S / TIME_S,
        jump: JUMP_S / TIME_S,
    }
}

fn assemble(scenario: &Scenario, seed: u64, best: &[Solved], history: Vec<Iteration>, begin: Instant) -> Plan {
    let reason = shortcoming(scenario, best);
    let status = if reason.is_none() { PlanStatus::Solved } else { PlanStatus::NotConverged };
    let wall_s = begin.elapsed().as_secs_f64();
    let named = scenario.vehicles.iter().zip(best);
    Plan {
        status,
        reason,
        objective: Some(TIME_S * best.iter().map(Solved::duration).fold(0.0, f64::max)),
        history,
        timings: PlanTimings { wall_s, distributed_s: wall_s },
        ..Plan::new(
            &scenario.name,
            NAME,
            seed,
            named.map(|(vehicle, solved)| trajectory(&vehicle.name, &solved.samples).into()).collect(),
        )
    }
}

/// Why the plan is not solved: its programs, or that its load factors do not lead along it.
fn shortcoming(scenario: &Scenario, best: &[Solved]) -> Option<String> {
    let unsolved = best.iter().filter(|solved| !solved.is_solved).count();
    if unsolved > 0 {
        return Some(format!("the programs of {unsolved} aircraft were not solved to their tolerances"));
    }
    let errors_m = best.iter().map(|solved| LENGTH_M * solved.rollout_error);
    let (index, error_m) = errors_m.enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let limit_m = MAX_ROLLOUT * scenario.limits().rollout_m;
    (error_m > limit_m).then(|| {
        let name = &scenario.vehicles[index].name;
        format!(
            "the load factors of {name} alone lead {error_m:.1} m away from its motion, of {limit_m:.1} m: they jump"
        )
    })
}

impl Fleet<'_> {
    /// The fastest flight of a vehicle without the others.
    fn alone(&self, vehicle: usize) -> Option<Solved> {
        self.fastest(Problem::new(self.scenario, vehicle, Duration::Fixed(1.0)))
    }

    /// The fastest flight of a problem, whatever its duration.
    fn fastest(&self, problem: Problem) -> Option<Solved> {
        let guess_s = Guess::straight(&problem).duration;
        let [min_s, max_s] = TIME_RATIO.map(|ratio| ratio * guess_s);
        let problem = Problem { duration: Duration::Free { min_s, guess_s, max_s }, ..problem };
        let bows = BOWS.map(|bow| Guess::bowed(&problem, bow));
        let guesses = [Guess::straight(&problem), bows[0], bows[1]];
        solve(&problem, &guesses, self.options)
    }

    /// All vehicles in turn, each against those before it.
    fn round(&self, order: &[usize], common: Option<f64>, last: &[Solved]) -> Vec<Solved> {
        let mut planned = last.to_vec();
        let mut neighbours = Vec::with_capacity(order.len());
        for &i in order {
            let duration = Duration::Fixed(common.unwrap_or(1.0));
            let problem = Problem { neighbours: neighbours.clone(), ..Problem::new(self.scenario, i, duration) };
            let solved = match common {
                None => self.fastest(problem),
                Some(time) => {
                    let [left, right] = Guess::lasting(&problem, time);
                    let guesses = [left, right, Guess::straight(&problem).lasting_for(time)];
                    solve(&problem, &guesses, self.options)
                }
            };
            if let Some(solved) = solved {
                planned[i] = solved;
            }
            neighbours.push(planned[i].as_neighbour());
        }
        planned
    }
}

/// One entry of the history.
fn iteration(solved: &[Solved], started: Instant) -> Iteration {
    let slowest_s = TIME_S * solved.iter().map(Solved::duration).fold(0.0, f64::max);
    let wall_s = started.elapsed().as_secs_f64();
    Iteration {
        objective: slowest_s,
        dt_s: MAX_SAMPLE_S,
        defect_m: LENGTH_M * solved.iter().map(|solved| solved.violation).fold(0.0, f64::max),
        slack: solved.iter().map(|solved| solved.violation).fold(0.0, f64::max),
        separation_m: None,
        clearance_m: None,
        change_m: 0.0,
        trust_region_m: 0.0,
        solver_iterations: solved.iter().map(|solved| solved.iterations).sum(),
        unsolved: solved.iter().filter(|solved| !solved.is_solved).count(),
        wall_s,
        distributed_s: wall_s,
    }
}

/// The samples as a trajectory, with a continuous heading.
fn trajectory(vehicle: &str, samples: &[Sample]) -> Trajectory {
    let mut trajectory = Trajectory {
        vehicle: vehicle.to_owned(),
        interpolation: Interpolation::FirstOrderHold,
        times_s: Vec::new(),
        states: Vec::new(),
        controls: Vec::new(),
    };
    let mut heading_rad = f64::NAN;
    for (time, node) in samples {
        let [x, y, z] = std::array::from_fn(|k| SPEED_MPS * node[VELOCITY + k]);
        let wrapped_rad = y.atan2(x);
        let turns = ((wrapped_rad - heading_rad) / std::f64::consts::TAU).round();
        heading_rad = wrapped_rad - if turns.is_finite() { turns * std::f64::consts::TAU } else { 0.0 };
        let level_mps = x.hypot(y);
        let state = [
            LENGTH_M * node[0],
            LENGTH_M * node[1],
            LENGTH_M * node[2],
            level_mps.hypot(z),
            heading_rad,
            z.atan2(level_mps),
        ];
        trajectory.times_s.push(TIME_S * time);
        trajectory.states.push(State::from_array(state));
        trajectory.controls.push(Control::from_array([node[STATES], node[STATES + 1], node[STATES + 2]]));
    }
    trajectory
}
