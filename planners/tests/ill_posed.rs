//! Subproblems that no planner should pose: the interior-point method ends, says what happened, and does not panic.

use nalgebra::{SMatrix, SVector};
use planners::convex::{
    InteriorPoint, LINK, Link, Pin, Plane, Program, STAGE, Settings, Solution, Status, solve_with_clarabel,
};
use rand::{Rng, RngExt};

const INTERVALS: usize = 8;

/// A random programme around a point that satisfies its links.
fn program(rng: &mut impl Rng) -> Program {
    let mut uniform = || rng.random_range(-1.0..1.0);
    let links = (0..INTERVALS).map(|_| Link {
        left: SMatrix::from_fn(|i, j| 0.3 * uniform() - if i == j { 1.0 } else { 0.0 }),
        right: SMatrix::from_fn(|i, j| {
            if i == j {
                1.0
            } else if j < LINK {
                0.0
            } else {
                0.2 * uniform()
            }
        }),
        theta: SVector::from_fn(|_, _| uniform()),
        rhs: SVector::from_fn(|_, _| 0.1 * uniform()),
    });
    let links: Vec<Link> = links.collect();
    let n = STAGE * (INTERVALS + 1) + 1;
    let pins = (0..LINK).map(|index| Pin { index, value: 0.1 * uniform() }).collect();
    let mut planes = Vec::new();
    for stage in 0..=INTERVALS {
        planes.push(Plane { stage, here: [uniform(), uniform()], next: [0.0; 2], bound: 0.3 * uniform() });
        if stage < INTERVALS {
            let (here, next) = ([uniform(), uniform()], [uniform(), uniform()]);
            planes.push(Plane { stage, here, next, bound: 0.3 * uniform() });
        }
    }
    Program {
        theta_cost: 1.0,
        offset: 0.0,
        penalty: 100.0,
        links,
        pins,
        planes,
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
    let (ours, theirs) = (solve(program), solve_with_clarabel(program, 1e-8));
    assert_eq!(ours.status, Status::Solved, "{what}: {ours:?}");
    let difference = (ours.objective - theirs.objective).abs() / theirs.objective.abs().max(1.0);
    assert!(difference < 1e-6, "{what}: {} against {}", ours.objective, theirs.objective);
}

#[test]
fn random_programmes_agree_with_clarabel() {
    for seed in 0..40 {
        assert_agrees_with_clarabel(&program(&mut scenarios::stream(seed, "programme")), &format!("seed {seed}"));
    }
}

#[test]
fn contradicting_rows_are_absorbed_by_the_slacks() {
    let mut program = program(&mut scenarios::stream(1, "contradiction"));
    let first = program.pins[0];
    program.pins.push(Pin { value: first.value + 0.5, ..first });
    program.planes.push(Plane { stage: INTERVALS, here: [1.0, 0.0], next: [0.0; 2], bound: -0.8 });
    program.planes.push(Plane { stage: INTERVALS, here: [-1.0, 0.0], next: [0.0; 2], bound: -0.8 });
    assert_agrees_with_clarabel(&program, "contradiction");
    assert!(solve(&program).objective > 0.5 * program.penalty);
}

#[test]
fn duplicate_rows_do_not_matter() {
    let mut program = program(&mut scenarios::stream(2, "duplicates"));
    program.pins.extend(program.pins.clone());
    program.planes = program.planes.iter().flat_map(|plane| [*plane; 3]).collect();
    assert_agrees_with_clarabel(&program, "duplicates");
}

#[test]
fn tiny_trust_region_is_solved() {
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
    let spoil: [fn(&mut Program); 5] = [
        |program| program.box_upper[3] = program.box_lower[3],
        |program| program.links[2].left[(1, 1)] = f64::NAN,
        |program| program.links[0].rhs[0] = f64::INFINITY,
        |program| program.planes[0].bound = f64::NAN,
        |program| program.soft_lower[7] = f64::NEG_INFINITY,
    ];
    for (i, spoil) in spoil.into_iter().enumerate() {
        let mut bad = good.clone();
        spoil(&mut bad);
        assert_eq!(solve(&bad).status, Status::Refused, "case {i}");
    }
}

#[test]
fn scales_far_apart_end_with_an_honest_status() {
    for (exponent, seed) in [(-9, 5), (-5, 6), (5, 7), (9, 8)] {
        let mut program = program(&mut scenarios::stream(seed, "scales"));
        for link in &mut program.links {
            link.left *= 10_f64.powi(exponent);
            link.right *= 10_f64.powi(exponent);
        }
        let solution = solve(&program);
        assert_ne!(solution.status, Status::Refused);
        if solution.status == Status::Solved {
            assert!(solution.gap <= 2e-8, "{solution:?}");
        }
        assert!(solution.z.iter().all(|z| z.is_finite()));
    }
}
