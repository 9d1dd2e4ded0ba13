//! The transcription of every kind of phase: products against differences, the Riccati recursion against the products.

use super::derivative_tests::{noise, problems};
use super::polygon::Polygon;
use super::problem::Problem;
use super::system::{LENGTH, SlungLoadSystem};
use crate::nlp::Program;
use crate::pseudospectral::{Mesh, Segment, Transcription};

fn mesh(phases: usize) -> Mesh {
    let segment = |fraction: f64, order: usize| Segment { fraction, order };
    Mesh { phases: vec![vec![segment(0.3, 2), segment(0.5, 4), segment(0.2, 1)]; phases] }
}

struct Point {
    x: Vec<f64>,
    y: Vec<f64>,
    v: Vec<f64>,
}

fn point(program: &Transcription, system: &SlungLoadSystem) -> Point {
    let sizes = program.sizes();
    let mut seed = 0;
    let x = program.variables_from(&|phase, fraction, node| {
        let k = (7.0 * fraction) as usize + 10 * phase;
        for (i, node) in node.iter_mut().enumerate() {
            *node = 0.3 * noise(k, i);
        }
        node[0] -= 2.0;
        node[1] -= 1.5;
        if system.coordinates > LENGTH {
            node[LENGTH] += 0.5;
        }
        node[2 * system.coordinates..].iter_mut().for_each(|thrust| *thrust += 3.0);
    });
    let mut some = |count: usize| {
        seed += 1;
        (0..count).map(|i| noise(seed, i)).collect::<Vec<f64>>()
    };
    Point { x, y: some(sizes.equalities), v: some(sizes.inequalities) }
}

fn max_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// f, and c and d.
fn evaluate(program: &mut Transcription, x: &[f64]) -> (f64, Vec<f64>) {
    let sizes = program.sizes();
    let (mut c, mut d) = (vec![0.0; sizes.equalities], vec![0.0; sizes.inequalities]);
    let f = program.evaluate(x, &mut c, &mut d);
    (f, [c, d].concat())
}

/// Gradients of f and of the Lagrangian.
fn gradients(program: &mut Transcription, x: &[f64], y: &[f64], v: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let mut gradient = vec![0.0; x.len()];
    program.linearise(x, y, v, &mut gradient);
    let objective = gradient.clone();
    program.add_jacobian_transposed(y, v, &mut gradient);
    (objective, gradient)
}

#[test]
fn products_agree_with_differences() {
    for problem in problems() {
        let system = SlungLoadSystem::new(&problem);
        let mut program = Transcription::new(&system, mesh(problem.phases.len()));
        let sizes = program.sizes();
        let Point { x, y, v } = point(&program, &system);
        let direction: Vec<f64> = (0..sizes.variables).map(|i| noise(77, i)).collect();
        let h = 1e-6;
        let [ahead, behind] = [h, -h].map(|h| x.iter().zip(&direction).map(|(x, d)| x + h * d).collect::<Vec<f64>>());
        let difference = |ahead: &[f64], behind: &[f64]| -> Vec<f64> {
            ahead.iter().zip(behind).map(|(a, b)| (a - b) / (2.0 * h)).collect()
        };

        let [(f_ahead, cd_ahead), (f_behind, cd_behind)] = [&ahead, &behind].map(|x| evaluate(&mut program, x));
        let [(_, l_ahead), (_, l_behind)] = [&ahead, &behind].map(|x| gradients(&mut program, x, &y, &v));
        let (objective, _) = gradients(&mut program, &x, &y, &v);
        let slope = dot(&objective, &direction);
        assert!((slope - (f_ahead - f_behind) / (2.0 * h)).abs() < 1e-5 * slope.abs().max(1.0));

        let (mut c, mut d) = (vec![0.0; sizes.equalities], vec![0.0; sizes.inequalities]);
        program.jacobian_times(&direction, &mut c, &mut d);
        assert!(max_difference(&[c.clone(), d.clone()].concat(), &difference(&cd_ahead, &cd_behind)) < 1e-5);

        let mut transposed = vec![0.0; sizes.variables];
        program.add_jacobian_transposed(&y, &v, &mut transposed);
        let (one, other) = (dot(&transposed, &direction), dot(&y, &c) - dot(&v, &d));
        assert!((one - other).abs() < 1e-9 * one.abs().max(1.0), "the transposed product is the transpose");

        program.factor(&vec![0.0; sizes.variables], &vec![0.0; sizes.inequalities]);
        let mut hessian = vec![0.0; sizes.variables];
        program.hessian_times(&direction, &mut hessian);
        let error = max_difference(&hessian, &difference(&l_ahead, &l_behind));
        assert!(error < 1e-4, "{error}");
    }
}

/// The recursion solves the Newton system whose products are tested above.
#[test]
fn the_recursion_solves_the_newton_system() {
    for problem in problems() {
        let system = SlungLoadSystem::new(&problem);
        let mut program = Transcription::new(&system, mesh(problem.phases.len()));
        let sizes = program.sizes();
        let Point { x, y, v } = point(&program, &system);
        let mut gradient = vec![0.0; sizes.variables];
        program.linearise(&x, &y, &v, &mut gradient);
        let weights: Vec<f64> = (0..sizes.inequalities).map(|i| 1.0 + noise(3, i)).collect();
        assert!(!program.factor(&vec![-1e3; sizes.variables], &weights), "negative curvature is detected");
        assert!(program.factor(&vec![30.0; sizes.variables], &weights));
        let right_x: Vec<f64> = (0..sizes.variables).map(|i| noise(5, i)).collect();
        let right_y: Vec<f64> = (0..sizes.equalities).map(|i| noise(6, i)).collect();
        let (mut dx, mut dy) = (vec![0.0; sizes.variables], vec![0.0; sizes.equalities]);
        let mut residual = f64::INFINITY;
        // terminal equalities hold after iterative refinement only
        for _ in 0..4 {
            let (mut r_x, mut r_y) = (vec![0.0; sizes.variables], vec![0.0; sizes.equalities]);
            let mut rows = vec![0.0; sizes.inequalities];
            program.hessian_times(&dx, &mut r_x);
            program.add_jacobian_transposed(&dy, &[], &mut r_x);
            program.jacobian_times(&dx, &mut r_y, &mut rows);
            residual = max_difference(&right_x, &r_x).max(max_difference(&right_y, &r_y));
            r_x.iter_mut().zip(&right_x).for_each(|(r, right)| *r = right - *r);
            r_y.iter_mut().zip(&right_y).for_each(|(r, right)| *r = right - *r);
            program.solve(&mut r_x, &mut r_y);
            dx.iter_mut().zip(&r_x).for_each(|(dx, r)| *dx += r);
            dy.iter_mut().zip(&r_y).for_each(|(dy, r)| *dy += r);
        }
        assert!(residual < 1e-8, "{residual}");
    }
}

/// The work arrays have no limit on the number of path constraints.
#[test]
fn many_obstacles_are_transcribed() {
    let obstacle = |k: usize| Polygon::rectangle([2.0 * k as f64, 5.0], [1.0, 1.0], 0.0);
    let obstacles = (0..30).map(obstacle).collect();
    let problem = Problem { obstacles, ..Problem::paper() };
    let system = SlungLoadSystem::new(&problem);
    let mut program = Transcription::new(&system, mesh(1));
    let Point { x, y, v } = point(&program, &system);
    let (_, constraints) = evaluate(&mut program, &x);
    let (_, gradient) = gradients(&mut program, &x, &y, &v);
    assert!(constraints.iter().chain(&gradient).all(|value| value.is_finite()));
}
