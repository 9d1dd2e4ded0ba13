//! Problems of Hock and Schittkowski, "Test Examples for Nonlinear Programming Codes" (1981), by their numbers.

use super::dense::{DenseProgram, Values};
use super::interior_point::InteriorPoint;
use super::iterate::Start;
use super::solution::{Settings, Solution, Status};

const FREE: f64 = f64::INFINITY;

fn solve(function: fn(&[f64]) -> Values, bounds: Vec<[f64; 2]>, start: Vec<f64>) -> (Solution, Vec<f64>) {
    let (lower, upper) = bounds.into_iter().map(|[lower, upper]| (lower, upper)).unzip();
    let mut program = DenseProgram::new(function, lower, upper);
    let mut method = InteriorPoint::new(&program, Settings { tolerance: 1e-8, ..Settings::default() });
    let solution = method.solve(&mut program, &Start::Cold(start));
    let x = method.x().to_vec();
    (solution, x)
}

fn assert_optimum((solution, x): &(Solution, Vec<f64>), objective: f64, optimum: &[f64]) {
    assert_eq!(solution.status, Status::Solved, "{solution:?}");
    assert!(
        (solution.objective - objective).abs() < 1e-5 * objective.abs().max(1.0),
        "{} at {x:?}",
        solution.objective
    );
    assert!(x.iter().zip(optimum).all(|(x, best)| (x - best).abs() < 1e-3), "{x:?}");
}

/// A nonlinear equality, from an infeasible start.
#[test]
fn hs6() {
    let function = |x: &[f64]| Values {
        f: ((1.0 - x[0]).powi(2), vec![-2.0 * (1.0 - x[0]), 0.0]),
        c: vec![(10.0 * (x[1] - x[0] * x[0]), vec![-20.0 * x[0], 10.0])],
        d: vec![],
    };
    let result = solve(function, vec![[-FREE, FREE]; 2], vec![-1.2, 1.0]);
    assert_optimum(&result, 0.0, &[1.0, 1.0]);
}

/// A nonconvex objective: the Hessian must be regularised.
#[test]
fn hs7() {
    let function = |x: &[f64]| {
        let a = 1.0 + x[0] * x[0];
        Values {
            f: (a.ln() - x[1], vec![2.0 * x[0] / a, -1.0]),
            c: vec![(a * a + x[1] * x[1] - 4.0, vec![4.0 * x[0] * a, 2.0 * x[1]])],
            d: vec![],
        }
    };
    let result = solve(function, vec![[-FREE, FREE]; 2], vec![2.0, 2.0]);
    assert_optimum(&result, -3.0_f64.sqrt(), &[0.0, 3.0_f64.sqrt()]);
}

/// A convex quadratic program with one inequality and bounds.
#[test]
fn hs35() {
    let function = |x: &[f64]| {
        let f = 9.0 - 8.0 * x[0] - 6.0 * x[1] - 4.0 * x[2]
            + 2.0 * x[0] * x[0]
            + 2.0 * x[1] * x[1]
            + x[2] * x[2]
            + 2.0 * x[0] * x[1]
            + 2.0 * x[0] * x[2];
        let g = vec![
            -8.0 + 4.0 * x[0] + 2.0 * x[1] + 2.0 * x[2],
            -6.0 + 4.0 * x[1] + 2.0 * x[0],
            -4.0 + 2.0 * x[2] + 2.0 * x[0],
        ];
        Values { f: (f, g), c: vec![], d: vec![(3.0 - x[0] - x[1] - 2.0 * x[2], vec![-1.0, -1.0, -2.0])] }
    };
    let result = solve(function, vec![[0.0, FREE]; 3], vec![0.5; 3]);
    assert_optimum(&result, 1.0 / 9.0, &[4.0 / 3.0, 7.0 / 9.0, 4.0 / 9.0]);
}

/// Three nonlinear inequalities.
#[test]
fn hs43() {
    let function = |x: &[f64]| {
        let squares = |w: [f64; 4]| (0..4).map(|i| w[i] * x[i] * x[i]).sum::<f64>();
        let row = |constant: f64, w: [f64; 4], l: [f64; 4]| {
            let value = constant - squares(w) - (0..4).map(|i| l[i] * x[i]).sum::<f64>();
            (value, (0..4).map(|i| -2.0 * w[i] * x[i] - l[i]).collect::<Vec<f64>>())
        };
        let f = squares([1.0, 1.0, 2.0, 1.0]) - 5.0 * x[0] - 5.0 * x[1] - 21.0 * x[2] + 7.0 * x[3];
        let g = vec![2.0 * x[0] - 5.0, 2.0 * x[1] - 5.0, 4.0 * x[2] - 21.0, 2.0 * x[3] + 7.0];
        let d = vec![
            row(8.0, [1.0; 4], [1.0, -1.0, 1.0, -1.0]),
            row(10.0, [1.0, 2.0, 1.0, 2.0], [-1.0, 0.0, 0.0, -1.0]),
            row(5.0, [2.0, 1.0, 1.0, 0.0], [2.0, -1.0, 0.0, -1.0]),
        ];
        Values { f: (f, g), c: vec![], d }
    };
    let result = solve(function, vec![[-FREE, FREE]; 4], vec![0.0; 4]);
    assert_optimum(&result, -44.0, &[0.0, 1.0, 2.0, -1.0]);
}

/// An equality, an inequality and bounds.
#[test]
fn hs71() {
    let function = |x: &[f64]| {
        let sum = x[0] + x[1] + x[2];
        let product = x[0] * x[1] * x[2] * x[3];
        Values {
            f: (x[0] * x[3] * sum + x[2], vec![x[3] * (sum + x[0]), x[0] * x[3], x[0] * x[3] + 1.0, x[0] * sum]),
            c: vec![(x.iter().map(|x| x * x).sum::<f64>() - 40.0, x.iter().map(|x| 2.0 * x).collect())],
            d: vec![(product - 25.0, x.iter().map(|x| product / x).collect())],
        }
    };
    let result = solve(function, vec![[1.0, 5.0]; 4], vec![1.0, 5.0, 5.0, 1.0]);
    assert_optimum(&result, 17.014_017_3, &[1.0, 4.742_994, 3.821_15, 1.379_408]);
}

/// Contradictory constraints.
#[test]
fn an_infeasible_program_is_not_reported_as_solved() {
    let function =
        |x: &[f64]| Values { f: (x[0], vec![1.0]), c: vec![(x[0] * x[0] + 1.0, vec![2.0 * x[0]])], d: vec![] };
    let (solution, _) = solve(function, vec![[-FREE, FREE]], vec![0.7]);
    assert_ne!(solution.status, Status::Solved, "{solution:?}");
    assert!(solution.violation > 0.9);
}

/// A function that is not a number (NaN) at the initial point.
#[test]
fn nan_is_reported_as_not_finite() {
    let function = |_: &[f64]| Values { f: (f64::NAN, vec![f64::NAN]), c: vec![], d: vec![] };
    let (solution, _) = solve(function, vec![[0.0, 1.0]], vec![0.5]);
    assert_eq!(solution.status, Status::NotFinite);
}

/// The same start gives the same iterates, to the bit.
#[test]
fn runs_are_reproducible() {
    let function = |x: &[f64]| Values {
        f: ((1.0 - x[0]).powi(2), vec![-2.0 * (1.0 - x[0]), 0.0]),
        c: vec![(x[1] - x[0] * x[0], vec![-2.0 * x[0], 1.0])],
        d: vec![],
    };
    let run = || solve(function, vec![[-FREE, 0.5], [-FREE, FREE]], vec![-1.2, 1.0]);
    assert_eq!(run(), run());
}
