use planners::nlp::{InteriorPoint, Settings, Start};
use planners::pseudospectral::{Mesh, Transcription};
use planners::slung::{Model, Problem};
use std::time::Instant;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let get = |i: usize, d: usize| args.get(i).and_then(|a| a.parse().ok()).unwrap_or(d);
    let (s, n, reps) = (get(1, 20), get(2, 3), get(3, 1));
    let problem = Problem::paper();
    let model = Model::new(&problem);
    for side in [-1.0, 1.0] {
        let mut best = f64::MAX;
        for rep in 0..reps {
            let t0 = Instant::now();
            let mut nlp = Transcription::new(&model, Mesh::uniform(&[(s, n)]));
            let c = [side * -0.4536, side * 2.268];
            let pts = [[-2.0, 0.0], c, [2.0, 0.0]];
            let hover = problem.hover_n();
            let x = nlp.guess(&|_, t, w| {
                w.fill(0.0);
                let z = t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
                let l1 = f64::hypot(pts[1][0] - pts[0][0], pts[1][1] - pts[0][1]);
                let l2 = f64::hypot(pts[2][0] - pts[1][0], pts[2][1] - pts[1][1]);
                let d = z * (l1 + l2);
                let (a, b, f) = if d < l1 { (pts[0], pts[1], d / l1) } else { (pts[1], pts[2], (d - l1) / l2) };
                w[0] = a[0] + f * (b[0] - a[0]);
                w[1] = a[1] + f * (b[1] - a[1]);
                w[2] = 1.3 + 0.2 * z;
                w[16..].fill(hover);
            });
            let mut ip = InteriorPoint::new(&nlp, Settings::default());
            let sol = ip.solve(&mut nlp, &Start::Cold(x));
            best = best.min(t0.elapsed().as_secs_f64());
            if rep == 0 {
                for (i, r) in sol.history.iter().enumerate() {
                    println!("{i:3} f {:12.5} viol {:.2e} err {:.2e} mu {:.1e} delta {:.1e} a {:.2e}", r.objective, r.violation, r.error, r.barrier, r.regularisation, r.step);
                }
                println!("side {side}: {:?} {} in {} its", sol.status, sol.objective, sol.iterations);
            }
        }
        println!("time {:.2} ms", best * 1e3);
    }
}
