//! The transcription of all phases: products against differences, the sweep against the products.

use super::model::Model;
use super::tests::{noise, problems};
use crate::nlp::Program;
use crate::pseudospectral::{Mesh, Segment, Transcription};

fn mesh(phases: usize) -> Mesh {
    let segment = |share: f64, order: usize| Segment { share, order };
    Mesh { phases: vec![vec![segment(0.3, 2), segment(0.5, 4), segment(0.2, 1)]; phases] }
}

struct Point {
    x: Vec<f64>,
    y: Vec<f64>,
    v: Vec<f64>,
}

fn point(programme: &Transcription, model: &Model) -> Point {
    use crate::pseudospectral::Motion;
    let sizes = programme.sizes();
    let mut seed = 0;
    let x = programme.guess(&|phase, share, node| {
        let k = (7.0 * share) as usize + 10 * phase;
        for (i, node) in node.iter_mut().enumerate() {
            *node = 0.3 * noise(k, i);
        }
        node[0] -= 2.0;
        node[1] -= 1.5;
        if model.coordinates() > 8 {
            node[8] += 0.5;
        }
        node[2 * model.coordinates()..].iter_mut().for_each(|thrust| *thrust += 3.0);
    });
    let mut some = |count: usize| {
        seed += 1;
        (0..count).map(|i| noise(seed, i)).collect::<Vec<f64>>()
    };
    Point { x, y: some(sizes.equalities), v: some(sizes.inequalities) }
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn products_agree_with_differences() {
    for problem in problems() {
        let model = Model::new(&problem);
        let mut programme = Transcription::new(&model, mesh(problem.stages.len()));
        let sizes = programme.sizes();
        let Point { x, y, v } = point(&programme, &model);
        let direction: Vec<f64> = (0..sizes.variables).map(|i| noise(77, i)).collect();
        let h = 1e-6;
        let moved = |sign: f64| -> Vec<f64> { x.iter().zip(&direction).map(|(x, d)| x + sign * h * d).collect() };
        let rows = |programme: &mut Transcription, x: &[f64]| {
            let (mut c, mut d) = (vec![0.0; sizes.equalities], vec![0.0; sizes.inequalities]);
            let f = programme.values(x, &mut c, &mut d);
            (f, [c, d].concat())
        };
        let ((f_ahead, ahead), (f_behind, behind)) =
            (rows(&mut programme, &moved(1.0)), rows(&mut programme, &moved(-1.0)));
        let gradient = |programme: &mut Transcription, x: &[f64]| {
            let mut gradient = vec![0.0; sizes.variables];
            programme.linearise(x, &y, &v, &mut gradient);
            let objective = gradient.clone();
            programme.add_transposed(&y, &v, &mut gradient);
            (objective, gradient)
        };
        let (lagrangian_ahead, lagrangian_behind) =
            (gradient(&mut programme, &moved(1.0)).1, gradient(&mut programme, &moved(-1.0)).1);
        let (objective, _) = gradient(&mut programme, &x);

        let slope: f64 = objective.iter().zip(&direction).map(|(g, d)| g * d).sum();
        assert!((slope - (f_ahead - f_behind) / (2.0 * h)).abs() < 1e-5 * slope.abs().max(1.0));
        let (mut c, mut d) = (vec![0.0; sizes.equalities], vec![0.0; sizes.inequalities]);
        programme.rows_times(&direction, &mut c, &mut d);
        let difference: Vec<f64> = ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * h)).collect();
        assert!(largest_difference(&[c.clone(), d.clone()].concat(), &difference) < 1e-5);
        // the transposed product is the transpose
        let mut transposed = vec![0.0; sizes.variables];
        programme.add_transposed(&y, &v, &mut transposed);
        let one: f64 = transposed.iter().zip(&direction).map(|(a, b)| a * b).sum();
        let other: f64 =
            y.iter().zip(&c).map(|(a, b)| a * b).sum::<f64>() - v.iter().zip(&d).map(|(a, b)| a * b).sum::<f64>();
        assert!((one - other).abs() < 1e-9 * one.abs().max(1.0));
        // the Hessian alone
        programme.factor(&vec![0.0; sizes.variables], &vec![0.0; sizes.inequalities]);
        let mut hessian = vec![0.0; sizes.variables];
        programme.hessian_times(&direction, &mut hessian);
        let difference: Vec<f64> =
            lagrangian_ahead.iter().zip(&lagrangian_behind).map(|(a, b)| (a - b) / (2.0 * h)).collect();
        assert!(largest_difference(&hessian, &difference) < 1e-4, "{}", largest_difference(&hessian, &difference));
    }
}

/// The condensed sweep solves the Newton system whose products are tested above.
#[test]
fn sweep_solves_the_newton_system() {
    for problem in problems() {
        let model = Model::new(&problem);
        let mut programme = Transcription::new(&model, mesh(problem.stages.len()));
        let sizes = programme.sizes();
        let Point { x, y, v } = point(&programme, &model);
        let mut gradient = vec![0.0; sizes.variables];
        programme.linearise(&x, &y, &v, &mut gradient);
        let weights: Vec<f64> = (0..sizes.inequalities).map(|i| 1.0 + noise(3, i)).collect();
        assert!(!programme.factor(&vec![-1e3; sizes.variables], &weights), "negative curvature is noticed");
        assert!(programme.factor(&vec![30.0; sizes.variables], &weights));
        let right_x: Vec<f64> = (0..sizes.variables).map(|i| noise(5, i)).collect();
        let right_y: Vec<f64> = (0..sizes.equalities).map(|i| noise(6, i)).collect();
        let (mut dx, mut dy) = (vec![0.0; sizes.variables], vec![0.0; sizes.equalities]);
        let mut residual = f64::INFINITY;
        // events hold after refinement only
        for _ in 0..4 {
            let (mut r_x, mut r_y) = (vec![0.0; sizes.variables], vec![0.0; sizes.equalities]);
            let mut rows = vec![0.0; sizes.inequalities];
            programme.hessian_times(&dx, &mut r_x);
            programme.add_transposed(&dy, &[], &mut r_x);
            programme.rows_times(&dx, &mut r_y, &mut rows);
            residual = largest_difference(&right_x, &r_x).max(largest_difference(&right_y, &r_y));
            r_x.iter_mut().zip(&right_x).for_each(|(r, right)| *r = right - *r);
            r_y.iter_mut().zip(&right_y).for_each(|(r, right)| *r = right - *r);
            programme.solve(&mut r_x, &mut r_y);
            dx.iter_mut().zip(&r_x).for_each(|(dx, r)| *dx += r);
            dy.iter_mut().zip(&r_y).for_each(|(dy, r)| *dy += r);
        }
        assert!(residual < 1e-8, "{residual}");
    }
}
