//! Programs that no planner should pose: the interior-point method terminates with the right status and does not panic.

use nalgebra::{SMatrix, SVector};
use planners::convex::{
    DYNAMICS_ROWS, DynamicsConstraint, FixedVariable, HalfspaceConstraint, InteriorPoint, Program, STAGE_LEN, Settings,
    Solution, Status, solve_with_clarabel,
};
use rand::{Rng, RngExt};

const INTERVALS: usize = 8;

/// A random program around a point that satisfies its dynamics constraints.
fn program(rng: &mut impl Rng) -> Program {
    let mut uniform = || rng.random_range(-1.0..1.0);
    let dynamics = (0..INTERVALS).map(|_| DynamicsConstraint {
        left: SMatrix::from_fn(|i, j| 0.3 * uniform() - if i == j { 1.0 } else { 0.0 }),
        right: SMatrix::from_fn(|i, j| {
            if i == j {
                1.0
            } else if j < DYNAMICS_ROWS {
                0.0
            } else {
                0.2 * uniform()
            }
        }),
        theta: SVector::from_fn(|_, _| uniform()),
        rhs: SVector::from_fn(|_, _| 0.1 * uniform()),
    });
    let dynamics: Vec<DynamicsConstraint> = dynamics.collect();
    let n = STAGE_LEN * (INTERVALS + 1) + 1;
    let fixed_variables = (0..DYNAMICS_ROWS).map(|index| FixedVariable { index, value: 0.1 * uniform() }).collect();
    let mut halfspaces = Vec::new();
    for stage in 0..=INTERVALS {
        halfspaces.push(HalfspaceConstraint {
            stage,
            current: [uniform(), uniform()],
            next: [0.0; 2],
            bound: 0.3 * uniform(),
        });
        if stage < INTERVALS {
            let (current, next) = ([uniform(), uniform()], [uniform(), uniform()]);
            halfspaces.push(HalfspaceConstraint { stage, current, next, bound: 0.3 * uniform() });
        }
    }
    Program {
        theta_cost: 1.0,
        offset: 0.0,
        penalty: 100.0,
        row_units: [1.0; STAGE_LEN],
        dynamics,
        fixed_variables,
        halfspaces,
        box_lower: vec![-2.0; n],
        box_upper: vec![2.0; n],
        soft_lower: vec![-1.0; n],
        soft_upper: vec![1.0; n],
    }
}

fn solve(program: &Program) -> Solution {
    InteriorPoint::new(Settings::default()).solve(program)
}

fn assert_agrees_with_clarabel(program: &Program, what: &str) {
    let (block, clarabel) = (solve(program), solve_with_clarabel(program, 1e-8));
    assert_eq!(block.status, Status::Solved, "{what}: {block:?}");
    // Clarabel's own objective is too small by its residuals times the weights; with large ones only its variables, a
    // candidate, bound the optimum from above.
    let is_weighted = program.row_units != [1.0; STAGE_LEN];
    let upper = if is_weighted { program.objective(&clarabel.z) } else { clarabel.objective };
    let tolerance = 1e-6 * upper.abs().max(1.0);
    assert!(block.objective - upper < tolerance, "{what}: {} against {upper}", block.objective);
    assert!(
        block.objective - clarabel.objective > -tolerance,
        "{what}: {} below {}",
        block.objective,
        clarabel.objective
    );
}

#[test]
fn random_programmes_agree_with_clarabel() {
    for seed in 0..40 {
        assert_agrees_with_clarabel(&program(&mut scenarios::stream(seed, "programme")), &format!("seed {seed}"));
    }
}

/// Weights of 100 to 1e6 in one program, as violations in SI units have them.
#[test]
fn random_programmes_with_large_weights_agree_with_clarabel() {
    for seed in 0..40 {
        let mut program = program(&mut scenarios::stream(seed, "large weights"));
        program.penalty = 1000.0;
        program.row_units = [1000.0, 1000.0, 100.0, 10.0, 1.0, 0.1, 0.1, 0.1, 0.1];
        assert_agrees_with_clarabel(&program, &format!("seed {seed}"));
    }
}

#[test]
fn contradicting_rows_are_absorbed_by_the_slacks() {
    let mut program = program(&mut scenarios::stream(1, "contradiction"));
    let first = program.fixed_variables[0];
    program.fixed_variables.push(FixedVariable { value: first.value + 0.5, ..first });
    program.halfspaces.push(HalfspaceConstraint { stage: INTERVALS, current: [1.0, 0.0], next: [0.0; 2], bound: -0.8 });
    program.halfspaces.push(HalfspaceConstraint {
        stage: INTERVALS,
        current: [-1.0, 0.0],
        next: [0.0; 2],
        bound: -0.8,
    });
    assert_agrees_with_clarabel(&program, "contradiction");
    assert!(solve(&program).objective > 0.5 * program.penalty);
}

#[test]
fn duplicate_rows_have_no_effect() {
    let mut program = program(&mut scenarios::stream(2, "duplicates"));
    program.fixed_variables.extend(program.fixed_variables.clone());
    program.halfspaces = program.halfspaces.iter().flat_map(|halfspace| [*halfspace; 3]).collect();
    assert_agrees_with_clarabel(&program, "duplicates");
}

#[test]
fn tiny_trust_region_is_respected() {
    let mut program = program(&mut scenarios::stream(3, "tiny"));
    program.box_lower.fill(-1e-7);
    program.box_upper.fill(1e-7);
    let solution = solve(&program);
    assert!(matches!(solution.status, Status::Solved | Status::Stalled), "{solution:?}");
    assert!(solution.z.iter().all(|z| z.abs() <= 1e-7));
}

#[test]
fn empty_box_and_nan_are_refused() {
    let good = program(&mut scenarios::stream(4, "refused"));
    let mutations: [fn(&mut Program); 5] = [
        |program| program.box_upper[3] = program.box_lower[3],
        |program| program.dynamics[2].left[(1, 1)] = f64::NAN,
        |program| program.dynamics[0].rhs[0] = f64::INFINITY,
        |program| program.halfspaces[0].bound = f64::NAN,
        |program| program.soft_lower[7] = f64::NEG_INFINITY,
    ];
    for (i, mutate) in mutations.into_iter().enumerate() {
        let mut mutated = good.clone();
        mutate(&mut mutated);
        assert_eq!(solve(&mutated).status, Status::Refused, "case {i}");
    }
}

#[test]
fn scales_far_apart_end_with_a_correct_status() {
    for (exponent, seed) in [(-9, 5), (-5, 6), (5, 7), (9, 8)] {
        let mut program = program(&mut scenarios::stream(seed, "scales"));
        for constraint in &mut program.dynamics {
            constraint.left *= 10_f64.powi(exponent);
            constraint.right *= 10_f64.powi(exponent);
        }
        let solution = solve(&program);
        assert_ne!(solution.status, Status::Refused);
        if solution.status == Status::Solved {
            assert!(solution.gap <= 2e-8, "{solution:?}");
        }
        assert!(solution.z.iter().all(|z| z.is_finite()));
    }
}
