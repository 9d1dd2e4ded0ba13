//! Optima of `slung-lgr` against references from other solvers and from finer meshes.

use planners::nlp::Settings;
use planners::pseudospectral::{Duration, MultiphaseSystem, Tolerances, Transcription};
use planners::slung::{
    Avoidance, CableMode, Candidate, Gate, InitialCondition, Limits, Options, Phase, Problem, SlungLoadSystem,
    TorqueModel, Weights, candidate_routes, optimise,
};

/// An optimum: J and, for a motion with an impact, its instant and impulse.
struct Optimum {
    objective: f64,
    impact_s: f64,
    impulse_ns: f64,
}

/// The optima on the right and on the left of the obstacle.
fn solve(problem: &Problem, options: &Options) -> [Optimum; 2] {
    let routes = candidate_routes(problem);
    assert_eq!(routes.len(), 2, "one on either side");
    [true, false].map(|right| {
        let route = routes.iter().find(|route| route.on_right == [right]).expect("a route on that side");
        let candidate = optimise(problem, route, options);
        assert!(candidate.is_solved() && candidate.is_refined, "{:?}", candidate.mesh_iterations);
        optimum(problem, &candidate)
    })
}

fn optimum(problem: &Problem, candidate: &Candidate) -> Optimum {
    let system = SlungLoadSystem::new(problem);
    let program = Transcription::new(&system, candidate.mesh.clone());
    let mut node = vec![0.0; system.width()];
    program.node(&candidate.x, program.mesh_point(0, 1.0), &mut node);
    let body = &problem.vehicle;
    let reduced_kg = body.quadrotor_kg * body.load_kg / (body.quadrotor_kg + body.load_kg);
    Optimum {
        objective: candidate.last().objective,
        impact_s: program.duration_s(0, &candidate.x),
        impulse_ns: if problem.phases.len() > 1 { reduced_kg * node[system.coordinates() + 8] } else { 0.0 },
    }
}

fn objectives(problem: &Problem, options: &Options) -> [f64; 2] {
    solve(problem, options).map(|optimum| optimum.objective)
}

fn fixed(segments: usize, points: usize) -> Options {
    let solver = Settings { tolerance: 1e-8, ..Settings::default() };
    Options { segments, points, is_graded: false, tolerances: None, solver, ..Options::default() }
}

/// IPOPT 3.14 (CasADi, MUMPS) on the same transcription, exact derivatives, tolerance 1e-8.
#[test]
fn twenty_segments_of_three_points_agree_with_ipopt() {
    let [right, left] = objectives(&Problem::paper(), &fixed(20, 3));
    assert!((right - 2432.1384212).abs() < 1e-4, "{right}");
    assert!((left - 2432.4494171).abs() < 1e-4, "{left}");
}

/// The same on a finer mesh. There are several local optima within hundredths of each other, which differ in the two
/// nodes between which the corner is passed.
#[test]
fn forty_segments_of_four_points_agree_with_ipopt() {
    let [right, left] = objectives(&Problem::paper(), &fixed(40, 4));
    assert!((right - 2433.7197418).abs() < 0.03, "{right}");
    assert!((left - 2433.7981121).abs() < 0.03, "{left}");
}

/// J* = 2433.73 on the right and 2433.82 on the left, from much finer meshes.
#[test]
fn refined_meshes_reach_the_optimum_of_the_paper_case() {
    let [right, left] = objectives(&Problem::paper(), &Options::default());
    assert!((right - 2433.73).abs() < 0.05, "{right}");
    assert!((left - 2433.82).abs() < 0.05, "{left}");
}

/// The paper's R-functions describe the same circle: where they are solved, the optimum is the same.
#[test]
fn r_functions_find_the_optimum_of_the_smooth_constraints() {
    let problem = Problem { avoidance: Avoidance::RFunction, ..Problem::paper() };
    let [right, left] = objectives(&problem, &fixed(20, 3));
    assert!((right - 2432.138).abs() < 0.01, "{right}");
    assert!((left - 2432.449).abs() < 0.01, "{left}");
}

/// Body, cable and load need less room than the circle around them, and cost no more.
#[test]
fn parts_cost_no_more_than_the_envelope_circle() {
    let problem = Problem { avoidance: Avoidance::Parts, ..Problem::paper() };
    let [right, left] = objectives(&problem, &Options::default());
    assert!(right < 2433.73 + 0.05 && right > 2400.0, "{right}");
    assert!(left < 2433.82 + 0.05 && left > 2400.0, "{left}");
}

/// A wall that ends below the quadrotor's altitude is flown over by parts, not by the circle at every altitude.
#[test]
fn parts_fly_over_a_low_obstacle() {
    let low = Problem { obstacle_altitudes_m: vec![[-1.0, 0.2]], avoidance: Avoidance::Parts, ..Problem::paper() };
    let [right, left] = objectives(&low, &Options::default());
    let straight = 2432.0;
    assert!(right < straight && left < straight, "{right} {left}");
}

/// The paper's generalised torques are the body's to first order in the angles: the optimum moves little, and does move.
#[test]
fn generalised_torques_change_the_optimum_little() {
    let problem = Problem { torques: TorqueModel::Generalised, ..Problem::paper() };
    let generalised = objectives(&problem, &Options::default());
    for (generalised, body) in generalised.into_iter().zip(objectives(&Problem::paper(), &Options::default())) {
        assert!((generalised - body).abs() > 1e-4 && (generalised - body).abs() < 1.0, "{generalised} for {body}");
    }
}

/// The paper's complementarity with a small constant ε finds the same motion: the cable stays taut.
#[test]
fn complementarity_finds_the_taut_optimum() {
    let [right, left] = objectives(&complementary(), &fixed(20, 3));
    assert!((right - 2432.138).abs() < 0.01, "{right}");
    assert!((left - 2432.449).abs() < 0.01, "{left}");
}

/// On refined meshes too. With a larger bound push the method would find a slack phase at the start.
#[test]
fn complementarity_finds_the_taut_optimum_on_refined_meshes() {
    let [right, left] = objectives(&complementary(), &Options::default());
    assert!((right - 2433.73).abs() < 0.05, "{right}");
    assert!((left - 2433.82).abs() < 0.05, "{left}");
}

fn complementary() -> Problem {
    let (mode, duration) = (CableMode::COMPLEMENTARITY, Duration::Fixed(4.0));
    let phase = Phase { mode, duration, max_impulse_ns: None, gate: None };
    Problem { phases: vec![phase], ..Problem::paper() }
}

/// Minimum times on either side, on a refined and on a fine fixed mesh.
#[test]
fn minimum_times_do_not_depend_on_the_mesh() {
    let duration = Duration::Free { min_s: 0.02, guess_s: 3.0, max_s: 12.0 };
    let phase = Phase { mode: CableMode::Taut, duration, max_impulse_ns: None, gate: None };
    let problem = Problem { phases: vec![phase], weights: Weights::time(), ..Problem::paper() };
    let seconds = |options: &Options| objectives(&problem, options).map(|cost| problem.reported(cost));
    let refined =
        Options { tolerances: Some(Tolerances { error: 1e-3, ..default_tolerances() }), ..Options::default() };
    let fine = Options { segments: 60, points: 4, tolerances: None, ..Options::default() };
    for (a, b) in seconds(&refined).into_iter().zip(seconds(&fine)) {
        assert!((a - b).abs() < 5e-3, "{a} {b}");
    }
}

fn default_tolerances() -> Tolerances {
    Options::default().tolerances.expect("meshes are refined")
}

fn with_impact(mode: CableMode, position_m: [f64; 3], guess_s: f64, max_impulse_ns: Option<f64>) -> Problem {
    let first =
        Phase { mode, duration: Duration::Free { min_s: 0.02, guess_s, max_s: 3.6 }, max_impulse_ns, gate: None };
    let second = Phase { mode: CableMode::Taut, duration: Duration::Remainder(4.0), max_impulse_ns: None, gate: None };
    let start = InitialCondition { position_m, cable: [0.0, 0.0, 0.35] };
    Problem { start, phases: vec![first, second], ..Problem::paper() }
}

/// J = 2357.9 on the right and 2369.1 on the left, with impacts of 0.26 and 0.22 N s at 0.59 and 0.52 s.
#[test]
fn a_load_on_the_ground_is_lifted_with_the_reference_impact() {
    let problem = with_impact(CableMode::OnGround, [-2.0, 0.0, 0.35], 0.5, None);
    let [right, left] = solve(&problem, &Options::default());
    assert!((right.objective - 2357.9).abs() < 0.1 && (left.objective - 2369.1).abs() < 0.1);
    assert!((right.impact_s - 0.59).abs() < 0.01 && (left.impact_s - 0.52).abs() < 0.02);
    assert!((right.impulse_ns - 0.26).abs() < 0.01 && (left.impulse_ns - 0.22).abs() < 0.01);
}

/// J = 2428.6 with an impulse of at most 1e-3 N s.
#[test]
fn a_load_on_the_ground_is_lifted_softly() {
    let problem = with_impact(CableMode::OnGround, [-2.0, 0.0, 0.35], 0.5, Some(1e-3));
    let [right, left] = objectives(&problem, &Options::default());
    assert!((right.min(left) - 2428.6).abs() < 0.1, "{right} {left}");
}

/// J = 2432.9, with an impact of 0.467 N s at 0.228 s.
#[test]
fn a_falling_load_is_caught_with_the_reference_impact() {
    let problem = with_impact(CableMode::Slack, [-2.0, 0.0, 1.3], 0.25, None);
    let optima = solve(&problem, &Options::default());
    let best = optima.iter().min_by(|a, b| a.objective.total_cmp(&b.objective)).expect("two");
    assert!((best.objective - 2432.9).abs() < 0.1, "{}", best.objective);
    assert!((best.impact_s - 0.228).abs() < 0.002, "{}", best.impact_s);
    assert!((best.impulse_ns - 0.467).abs() < 0.005, "{}", best.impulse_ns);
}

/// The paper's vehicle with wider cable angles, in free space. At the gate the load must be ahead of the quadrotor and
/// at least `height_m` above it, with the cable in `mode`.
fn gated(height_m: f64, mode: CableMode) -> Problem {
    let open = [f64::NEG_INFINITY, f64::INFINITY];
    let gate = Gate {
        quadrotor_m: [[-0.75, -0.05], open, [f64::NEG_INFINITY, 1.4]],
        load_m: [[0.05, 0.75], open, [1.4 + height_m, f64::INFINITY]],
    };
    let phase = |mode, guess_s: f64, max_s: f64, gate| Phase {
        mode,
        duration: Duration::Free { min_s: 0.02, guess_s, max_s },
        max_impulse_ns: None,
        gate,
    };
    let last = Phase { mode: CableMode::Taut, duration: Duration::Remainder(4.0), max_impulse_ns: None, gate: None };
    let phases = match mode {
        CableMode::Slack => vec![
            phase(CableMode::Taut, 2.0, 2.2, None),
            phase(mode, 0.2, 0.7, Some(gate)),
            phase(mode, 0.2, 0.7, None),
            last,
        ],
        _ => vec![phase(CableMode::Taut, 2.0, 3.6, Some(gate)), last],
    };
    let cable_rad = [-130.0_f64, 130.0].map(f64::to_radians);
    let paper = Problem::paper();
    let (obstacles, obstacle_names) = (Vec::new(), Vec::new());
    Problem { limits: Limits { cable_rad, ..paper.limits }, obstacles, obstacle_names, phases, ..paper }
}

/// A slack phase reduces the cost, the more so the higher above the quadrotor the load must pass.
#[test]
fn a_slack_phase_reduces_the_cost_of_passing_above_the_quadrotor() {
    let objective = |height_m: f64, mode: CableMode| {
        let problem = gated(height_m, mode);
        let routes = candidate_routes(&problem);
        let candidate = optimise(&problem, &routes[0], &Options::default());
        assert!(candidate.is_solved() && candidate.is_refined, "{height_m} {mode:?}: {:?}", candidate.mesh_iterations);
        candidate.last().objective
    };
    let gain = |height_m: f64| {
        let [taut, slack] = [CableMode::Taut, CableMode::Slack].map(|mode| objective(height_m, mode));
        println!("{height_m:.2} m above: {taut:.3} taut, {slack:.3} with a slack phase");
        taut - slack
    };
    let gains = [0.0, 0.05, 0.1, 0.15].map(gain);
    assert!(gains[0] > 0.0 && gains.is_sorted(), "{gains:?}");
}

/// A gate with a window for the load only, from a guess that leaves the route.
#[test]
fn a_gate_for_the_load_alone_is_passed() {
    let paper = Problem::paper();
    let open = [f64::NEG_INFINITY, f64::INFINITY];
    let gate = Gate { quadrotor_m: [open; 3], load_m: [[-0.3, 0.3], [0.5, 1.1], [1.4, 1.8]] };
    let duration = Duration::Free { min_s: 0.02, guess_s: 2.0, max_s: 3.6 };
    let phases = vec![
        Phase { mode: CableMode::Taut, duration, max_impulse_ns: None, gate: Some(gate) },
        Phase { mode: CableMode::Taut, duration: Duration::Remainder(4.0), max_impulse_ns: None, gate: None },
    ];
    let problem = Problem { obstacles: Vec::new(), obstacle_names: Vec::new(), phases, ..paper };
    let routes = candidate_routes(&problem);
    let candidate = optimise(&problem, &routes[0], &Options::default());
    assert!(candidate.is_solved() && candidate.is_refined, "{:?}", candidate.mesh_iterations);
}
