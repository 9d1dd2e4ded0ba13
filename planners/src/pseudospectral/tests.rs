use super::mesh::Mesh;
use super::multiphase_system::{
    Duration, MultiphaseSystem, NodeDerivatives, NodeWeights, TerminalDerivatives, TerminalValues, TerminalWeights,
};
use super::refinement::{Tolerances, refine};
use super::transcription::Transcription;
use crate::nlp::{InteriorPoint, Program, Settings, Start, Status};

/// A cart on a line, `q'' = u`, from rest at 0 to rest at 1, with the cost `effort ∫ u^2 + time T`.
struct Cart {
    durations: Vec<Duration>,
    effort: f64,
    time: f64,
    bounds: Vec<[Vec<f64>; 2]>,
}

impl Cart {
    fn new(durations: Vec<Duration>, effort: f64, time: f64, controls: &[[f64; 2]]) -> Self {
        let free = f64::INFINITY;
        let bounds = controls.iter().map(|&[low, high]| [vec![-free, -free, low], vec![free, free, high]]).collect();
        Self { durations, effort, time, bounds }
    }

    fn solve(&self, mesh: Mesh) -> (crate::nlp::Solution, Vec<f64>) {
        let mut program = Transcription::new(self, mesh);
        let start = program.variables_from(&|_, fraction, node| {
            node.fill(0.0);
            node[0] = fraction;
        });
        let mut method = InteriorPoint::new(&program, Settings { tolerance: 1e-9, ..Settings::default() });
        let solution = method.solve(&mut program, &Start::Cold(start));
        let x = method.x().to_vec();
        (solution, x)
    }
}

impl MultiphaseSystem for Cart {
    fn coordinates(&self) -> usize {
        1
    }
    fn ignorable(&self) -> usize {
        1
    }
    fn controls(&self) -> usize {
        1
    }
    fn durations(&self) -> &[Duration] {
        &self.durations
    }
    fn time_cost(&self) -> f64 {
        self.time
    }
    fn initial_state(&self) -> &[f64] {
        &[0.0, 0.0]
    }
    fn bounds(&self, phase: usize) -> (&[f64], &[f64]) {
        let [lower, upper] = &self.bounds[phase];
        (lower, upper)
    }
    fn path_constraint_count(&self, _: usize) -> usize {
        0
    }
    fn terminal_constraint_counts(&self, phase: usize) -> (usize, usize) {
        (if phase + 1 == self.durations.len() { 2 } else { 0 }, 0)
    }
    fn evaluate(&self, _: usize, node: &[f64], acceleration: &mut [f64], _: &mut [f64]) -> f64 {
        acceleration[0] = node[2];
        self.effort * node[2] * node[2]
    }
    fn differentiate(&self, _: usize, node: &[f64], weights: NodeWeights, derivatives: NodeDerivatives) {
        derivatives.acceleration[2] = 1.0;
        derivatives.cost[2] = 2.0 * self.effort * node[2];
        derivatives.hessian[8] = 2.0 * self.effort * weights.cost;
    }
    fn evaluate_terminal(&self, phase: usize, state: &[f64], values: &mut TerminalValues) {
        if phase + 1 == self.durations.len() {
            (values.equalities[0], values.equalities[1]) = (state[0] - 1.0, state[1]);
        } else {
            values.next_state.copy_from_slice(state);
        }
    }
    fn differentiate_terminal(&self, phase: usize, _: &[f64], _: TerminalWeights, derivatives: TerminalDerivatives) {
        let identity = if phase + 1 == self.durations.len() { derivatives.equalities } else { derivatives.next_state };
        identity.copy_from_slice(&[1.0, 0.0, 0.0, 1.0]);
    }
}

/// `∫ u^2 = 12/T^3` for a unit distance in T, with `u = 6/T^2 (1 - 2 t/T)`: a polynomial, for which every mesh is
/// exact.
#[test]
fn minimum_effort_is_exact_on_any_mesh() {
    let cart = Cart::new(vec![Duration::Fixed(2.0)], 1.0, 0.0, &[[-9.0, 9.0]]);
    for mesh in [Mesh::uniform(&[(1, 4)]), Mesh::uniform(&[(5, 3)]), Mesh::graded(&[(4, 5)])] {
        let (solution, _) = cart.solve(mesh);
        assert_eq!(solution.status, Status::Solved);
        assert!((solution.objective - 1.5).abs() < 1e-6, "{}", solution.objective);
    }
}

/// Bang-bang control with |u| <= 1: T = 2 for a unit distance, with the switch at 1; both durations are free. The
/// control can leave its bounds only after the last node of a segment, and does so less on finer meshes.
#[test]
fn minimum_time_with_a_free_switch_converges() {
    let free = Duration::Free { min_s: 0.1, guess_s: 2.0, max_s: 9.0 };
    let cart = Cart::new(vec![free, free], 0.0, 1.0, &[[-1.0, 1.0], [-1.0, 1.0]]);
    for (segments, tolerance) in [(2, 5e-3), (8, 4e-4)] {
        let (solution, x) = cart.solve(Mesh::uniform(&[(segments, 3), (segments, 3)]));
        assert_eq!(solution.status, Status::Solved);
        assert!((solution.objective - 2.0).abs() < tolerance, "{}", solution.objective);
        let switch_s = x[x.len() - 2];
        assert!((switch_s - 1.0).abs() < 0.1, "{switch_s}");
    }
}

/// The last phase takes the remainder of a fixed total.
#[test]
fn a_remainder_completes_the_total() {
    let free = Duration::Free { min_s: 0.1, guess_s: 0.5, max_s: 1.8 };
    let cart = Cart::new(vec![free, Duration::Remainder(2.0)], 1.0, 0.0, &[[0.0, 9.0], [-9.0, 0.0]]);
    let (solution, x) = cart.solve(Mesh::uniform(&[(3, 3), (3, 3)]));
    assert_eq!(solution.status, Status::Solved);
    assert!((solution.objective - 1.5).abs() < 1e-5, "{}", solution.objective);
    assert!((x[x.len() - 1] - 1.0).abs() < 5e-2, "the sign changes halfway: {}", x[x.len() - 1]);
}

/// A bang-bang control overshoots between the nodes of a coarse mesh; the mesh is refined at the switch until it does
/// not.
#[test]
fn the_mesh_is_refined_where_the_control_jumps() {
    let cart = Cart::new(vec![Duration::Fixed(2.02)], 1e-3, 0.0, &[[-1.0, 1.0]]);
    let tolerances = Tolerances { error: 1e-6, violation: 1e-6, overshoot: 0.02, max_order: 6 };
    let mut mesh = Mesh::uniform(&[(5, 3)]);
    for _ in 0..10 {
        let mut program = Transcription::new(&cart, mesh.clone());
        let start = program.variables_from(&|_, fraction, node| node.copy_from_slice(&[fraction, 0.5, 0.0]));
        let mut method = InteriorPoint::new(&program, Settings::default());
        assert_eq!(method.solve(&mut program, &Start::Cold(start)).status, Status::Solved);
        match refine(&program, method.x(), &tolerances) {
            Some(finer) => mesh = finer,
            None => break,
        }
    }
    let segments = &mesh.phases[0];
    let ends: Vec<f64> = segments
        .iter()
        .scan(0.0, |end, segment| {
            *end += segment.fraction;
            Some(*end)
        })
        .collect();
    let shortest =
        (0..ends.len()).min_by(|&a, &b| segments[a].fraction.total_cmp(&segments[b].fraction)).expect("segments");
    assert!(segments[shortest].fraction < 0.11, "{segments:?}");
    assert!((0.2..0.8).contains(&(ends[shortest] - segments[shortest].fraction)), "in the middle: {segments:?}");
    assert_eq!(
        (segments[0].fraction, segments[segments.len() - 1].fraction),
        (0.2, 0.2),
        "not at the ends: {segments:?}"
    );
}

/// A solution transferred to another mesh is almost a solution there: the warm start takes fewer iterations.
#[test]
fn transferred_solutions_save_iterations() {
    let cart = Cart::new(vec![Duration::Fixed(2.0)], 1.0, 0.0, &[[-1.2, 1.2]]);
    let mut coarse = Transcription::new(&cart, Mesh::uniform(&[(6, 3)]));
    let start = coarse.variables_from(&|_, fraction, node| node.copy_from_slice(&[fraction, 0.5, 0.0]));
    let mut method = InteriorPoint::new(&coarse, Settings::default());
    let cold = method.solve(&mut coarse, &Start::Cold(start));
    let mut fine = Transcription::new(&cart, Mesh::uniform(&[(9, 4)]));
    let warm_start = Start::Warm(coarse.transfer(&method.warm_start(), &fine));
    let mut method = InteriorPoint::new(&fine, Settings { initial_barrier: 1e-6, ..Settings::default() });
    let warm = method.solve(&mut fine, &warm_start);
    assert_eq!((cold.status, warm.status), (Status::Solved, Status::Solved));
    assert!(warm.history[0].violation < 1e-2, "{:?}", warm.history[0]);
    assert!(warm.iterations < cold.iterations, "{} after {}", warm.iterations, cold.iterations);
}

/// The initial state is an equality constraint.
#[test]
fn sizes_add_up() {
    let cart = Cart::new(vec![Duration::Fixed(2.0)], 1.0, 0.0, &[[-9.0, 9.0]]);
    let program = Transcription::new(&cart, Mesh::uniform(&[(4, 3)]));
    let sizes = program.sizes();
    assert_eq!((sizes.variables, sizes.equalities, sizes.inequalities), (12 * 3 + 2, 2 + 12 * 2 + 2, 0));
}
