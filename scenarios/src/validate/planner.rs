//! Options of a planner, as far as they can be checked without knowing the planner.

use super::identifier::entity_name;
use super::quantity::{above_up_to, not_negative, positive, positive_if_given};
use crate::{
    Collocation, Convergence, Coordination, Formulation, Horizon, Issue, Objective, PlannerSettings, Scenario, Solver,
    SolverStart, Swarm, TrustRegion,
};

/// Allowed number of intervals between the nodes.
const INTERVALS: std::ops::RangeInclusive<usize> = 2..=1000;

/// Allowed number of segments of a mesh, collocation points of a segment, and phases of the cable.
const SEGMENTS: std::ops::RangeInclusive<usize> = 1..=1000;
const POINTS: std::ops::RangeInclusive<usize> = 2..=20;
const PHASES: std::ops::RangeInclusive<usize> = 1..=10;

/// Allowed number of steps of a horizon, particles, and iterations of a search.
const STEPS: std::ops::RangeInclusive<usize> = 1..=100;
const PARTICLES: std::ops::RangeInclusive<usize> = 4..=10_000;
const ITERATIONS: std::ops::RangeInclusive<usize> = 1..=10_000;

/// Largest number of steps in one search: some seconds of computing.
const MAX_SEARCH_STEPS: usize = 100_000_000;

/// Default numbers of steps, particles and iterations.
const DEFAULT_SEARCH: [usize; 3] = [12, 40, 60];

/// Default inertia weights of a swarm.
const MAX_INERTIA: f64 = 0.9;
const MIN_INERTIA: f64 = 0.4;

/// A prescribed flight time that the simulation does not allow.
pub(super) fn flight_time(scenario: &Scenario) -> Option<Issue> {
    let flight_time_s = scenario.planner.collocation.as_ref()?.flight_time_s.filter(|time_s| *time_s > 0.0)?;
    let (step_s, max_s) = (scenario.simulation.step_s, scenario.simulation.max_duration_s);
    (!(step_s..=max_s).contains(&flight_time_s)).then(|| {
        let expected = format!("from {step_s} s, the time step, to {max_s} s, simulation.max_duration_s");
        Issue::new("planner.collocation.flight_time_s", format!("{flight_time_s} s"), expected)
    })
}

pub(super) fn issues(settings: &PlannerSettings) -> Vec<Issue> {
    let mut issues = command_issues(settings);
    if let Some(intervals) = settings.intervals.filter(|intervals| !INTERVALS.contains(intervals)) {
        let expected = format!("a whole number from {} to {}", INTERVALS.start(), INTERVALS.end());
        issues.push(Issue::new("planner.intervals", intervals.to_string(), expected));
    }
    if settings.max_iterations == Some(0) {
        issues.push(Issue::new("planner.max_iterations", "0", "1 or more"));
    }
    issues.extend(settings.margin_m.and_then(|margin_m| not_negative("planner.margin_m", margin_m)));
    issues.extend(positive_if_given("planner.penalty", settings.penalty));
    issues.extend(solver_start(settings));
    issues.extend(settings.time_bound_release.and_then(time_bound_release));
    issues.extend(settings.trust_region.iter().flat_map(trust_region));
    issues.extend(settings.convergence.iter().flat_map(convergence));
    issues.extend(settings.coordination.iter().flat_map(coordination));
    issues.extend(settings.collocation.iter().flat_map(collocation));
    issues.extend(settings.horizon.iter().flat_map(horizon));
    issues
}

/// Options that require a command, and options that a command requires.
fn command_issues(settings: &PlannerSettings) -> Vec<Issue> {
    let Some(command) = &settings.command else {
        let options = [
            ("time_limit_s", settings.time_limit_s.is_some()),
            ("in_loop", settings.in_loop),
            ("options", !settings.options.is_empty()),
        ];
        let without = |(key, _): (&str, bool)| {
            let found = "an option of external planners";
            let issue = Issue::new(format!("planner.{key}"), found, "this key only together with `planner.command`");
            issue.remedy("`harness schema scenario` shows the options of the built-in planners")
        };
        return options.into_iter().filter(|(_, is_given)| *is_given).map(without).collect();
    };
    let mut issues: Vec<Issue> = entity_name("planner.name", &settings.name).into_iter().collect();
    if command.first().is_none_or(String::is_empty) {
        issues.push(Issue::new(
            "planner.command",
            "no program",
            "a program and its arguments, such as [\"python3\", \"planner.py\"]",
        ));
    }
    issues.extend(positive_if_given("planner.time_limit_s", settings.time_limit_s));
    issues
}

/// An infeasible start with a solver that has none.
fn solver_start(settings: &PlannerSettings) -> Option<Issue> {
    let has_infeasible_start = matches!(settings.solver, Some(Solver::SparseLdl | Solver::DenseReduced));
    (settings.solver_start == Some(SolverStart::Infeasible) && !has_infeasible_start).then(|| {
        let expected = "this start only with `solver = \"sparse-ldl\"` or `\"dense-reduced\"`";
        Issue::new("planner.solver_start", "infeasible", expected)
    })
}

fn time_bound_release(fraction: f64) -> Option<Issue> {
    let expected = "a fraction from 0 to below 1";
    (!(0.0..1.0).contains(&fraction) && fraction.is_finite())
        .then(|| Issue::new("planner.time_bound_release", fraction.to_string(), expected))
}

fn trust_region(region: &TrustRegion) -> Vec<Issue> {
    let half_widths = [
        positive("planner.trust_region.position_m", region.position_m),
        positive("planner.trust_region.altitude_m", region.altitude_m),
        positive("planner.trust_region.speed_mps", region.speed_mps),
        positive("planner.trust_region.heading_deg", region.heading_deg),
        positive("planner.trust_region.flight_path_deg", region.flight_path_deg),
    ];
    let shrink = above_up_to("planner.trust_region.shrink", region.shrink, 0.0, 1.0);
    half_widths.into_iter().flatten().chain(shrink).collect()
}

fn convergence(tolerances: &Convergence) -> Vec<Issue> {
    let issues = [
        positive("planner.convergence.position_m", tolerances.position_m),
        positive("planner.convergence.altitude_m", tolerances.altitude_m),
        positive("planner.convergence.speed_mps", tolerances.speed_mps),
        positive("planner.convergence.heading_deg", tolerances.heading_deg),
        positive("planner.convergence.flight_path_deg", tolerances.flight_path_deg),
    ];
    issues.into_iter().flatten().collect()
}

fn coordination(options: &Coordination) -> Vec<Issue> {
    let not_negative_if_given = |key: &str, value: Option<f64>| {
        value.and_then(|value| not_negative(&format!("planner.coordination.{key}"), value))
    };
    let thresholds = [
        not_negative_if_given("swap_threshold_s", options.swap_threshold_s),
        not_negative_if_given("damped_change_s", options.damped_change_s),
        not_negative_if_given("arrival_spread_s", options.arrival_spread_s),
    ];
    let no_round =
        (options.max_rounds == Some(0)).then(|| Issue::new("planner.coordination.max_rounds", "0", "1 or more"));
    thresholds.into_iter().flatten().chain(no_round).collect()
}

fn collocation(options: &Collocation) -> Vec<Issue> {
    let counts = [
        ("segments", options.segments, SEGMENTS),
        ("points", options.points, POINTS),
        ("cable", options.cable.as_ref().map(Vec::len), PHASES),
    ];
    let out_of_range = out_of_range("collocation", counts);
    let quantities = [
        positive_if_given("planner.collocation.flight_time_s", options.flight_time_s),
        options.mesh_tolerance.and_then(|value| not_negative("planner.collocation.mesh_tolerance", value)),
        positive_if_given("planner.collocation.impact_ns", options.impact_ns),
    ];
    let no_time = (options.objective == Some(Objective::Effort) && options.flight_time_s.is_none()).then(|| {
        Issue::new(
            "planner.collocation.flight_time_s",
            "nothing",
            "a duration: the objective `effort` does not determine it",
        )
        .remedy("add `flight_time_s`, or minimise `time`")
    });
    let is_complementary = options.formulation == Some(Formulation::Complementarity);
    let idle_phases = (is_complementary && options.cable.is_some()).then(|| {
        Issue::new("planner.collocation.cable", "phases", "none: the formulation `complementarity` has no phases")
            .remedy("omit `cable`, or set `formulation = \"phases\"`")
    });
    let quantities = quantities.into_iter().flatten();
    out_of_range.into_iter().chain(quantities).chain(no_time).chain(idle_phases).collect()
}

fn horizon(options: &Horizon) -> Vec<Issue> {
    let counts = [
        ("steps", options.steps, STEPS),
        ("particles", options.particles, PARTICLES),
        ("iterations", options.iterations, ITERATIONS),
        ("stall_iterations", options.stall_iterations, ITERATIONS),
    ];
    let field = options.field.clone().unwrap_or_default();
    let quantities = [
        positive_if_given("planner.horizon.step_s", options.step_s),
        field.attraction.and_then(|value| not_negative("planner.horizon.field.attraction", value)),
        field.gain.and_then(|value| not_negative("planner.horizon.field.gain", value)),
        positive_if_given("planner.horizon.field.reach_m", field.reach_m),
    ];
    let weights = options.violation_weights.clone().unwrap_or_default();
    let not_negative_if_given = |key: &str, value: Option<f64>| value.and_then(|value| not_negative(key, value));
    let weights = [
        not_negative_if_given("planner.horizon.stage_weight", options.stage_weight),
        positive_if_given("planner.horizon.violation_weights.distance", weights.distance),
        positive_if_given("planner.horizon.violation_weights.speed", weights.speed),
        positive_if_given("planner.horizon.violation_weights.acceleration", weights.acceleration),
    ];
    let quantities = quantities.into_iter().chain(weights).flatten();
    let swarm = options.swarm.iter().flat_map(swarm);
    let too_large = search_size(options);
    out_of_range("horizon", counts).into_iter().chain(quantities).chain(swarm).chain(too_large).collect()
}

/// A search that would not end in a reasonable time, though each of its numbers is allowed.
fn search_size(options: &Horizon) -> Option<Issue> {
    let given = [options.steps, options.particles, options.iterations];
    let max = [*STEPS.end(), *PARTICLES.end(), *ITERATIONS.end()];
    // what is out of its own range is another issue
    let [steps, particles, iterations] = std::array::from_fn(|k| given[k].unwrap_or(DEFAULT_SEARCH[k]).min(max[k]));
    (steps * particles * iterations > MAX_SEARCH_STEPS).then(|| {
        let found = format!("{iterations} iterations of {particles} particles over {steps} steps");
        let expected = format!("a product of at most {MAX_SEARCH_STEPS}");
        Issue::new("planner.horizon.iterations", found, expected).remedy("reduce `iterations`, `particles` or `steps`")
    })
}

fn swarm(options: &Swarm) -> Vec<Issue> {
    let fraction = |key: &str, value: Option<f64>| value.and_then(|value| above_up_to(key, value, 0.0, 1.0));
    let not_negative_if_given = |key: &str, value: Option<f64>| value.and_then(|value| not_negative(key, value));
    let crossed = match (options.inertia_max.unwrap_or(MAX_INERTIA), options.inertia_min.unwrap_or(MIN_INERTIA)) {
        (max, min) if max < min => {
            let expected = format!("{max}, inertia_max, or less");
            Some(Issue::new("planner.horizon.swarm.inertia_min", min.to_string(), expected))
        }
        _ => None,
    };
    let issues = [
        not_negative_if_given("planner.horizon.swarm.cognitive", options.cognitive),
        not_negative_if_given("planner.horizon.swarm.social", options.social),
        not_negative_if_given("planner.horizon.swarm.inertia_max", options.inertia_max),
        not_negative_if_given("planner.horizon.swarm.inertia_min", options.inertia_min),
        fraction("planner.horizon.swarm.velocity_fraction", options.velocity_fraction),
        crossed,
    ];
    issues.into_iter().flatten().collect()
}

/// One issue for every count in `planner.TABLE` outside its range.
fn out_of_range<const N: usize>(
    table: &str,
    counts: [(&str, Option<usize>, std::ops::RangeInclusive<usize>); N],
) -> Vec<Issue> {
    let issue = |(name, count, range): (&str, Option<usize>, std::ops::RangeInclusive<usize>)| {
        let count = count.filter(|count| !range.contains(count))?;
        let expected = format!("a whole number from {} to {}", range.start(), range.end());
        Some(Issue::new(format!("planner.{table}.{name}"), count.to_string(), expected))
    };
    counts.into_iter().filter_map(issue).collect()
}
