//! probe
use planners::nlp::{InteriorPoint, Settings, Start, Status};
use planners::pseudospectral::{Duration, Mesh, Tolerances, Transcription, qualities, refine};
use planners::slung::*;
use std::time::Instant;
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let get = |i: usize, d: usize| args.get(i).and_then(|a| a.parse().ok()).unwrap_or(d);
    let case = args.get(1).map(String::as_str).unwrap_or("paper");
    let (s, n, reps, rounds) = (get(2, 20), get(3, 3), get(4, 1), get(5, 0));
    let verbose = args.iter().any(|a| a == "-v");
    let paper = Problem::paper();
    let free = |guess_s: f64| Duration::Free { least_s: 0.05, guess_s, most_s: 2.0 };
    let stage = |mode, duration, impulse_ns| Stage { mode, duration, impulse_ns };
    let problem = match case {
        "lift" | "soft" => Problem {
            start: Rest { position_m: [-2.0, 0.0, 0.35], cable: [0.0, 0.0, 0.35] },
            stages: vec![
                stage(Mode::Parked, free(0.5), (case == "soft").then_some(1e-3)),
                stage(Mode::Taut, Duration::RestOf(4.0), None),
            ],
            ..paper.clone()
        },
        "drop" => Problem {
            start: Rest { position_m: [-2.0, 0.0, 1.3], cable: [0.0, 0.0, 0.35] },
            stages: vec![stage(Mode::Slack, free(0.25), None), stage(Mode::Taut, Duration::RestOf(4.0), None)],
            ..paper.clone()
        },
        "either" => {
            Problem { stages: vec![stage(Mode::Either { epsilon: 1e-6 }, Duration::Fixed(4.0), None)], ..paper.clone() }
        }
        _ => paper.clone(),
    };
    let model = Model::new(&problem);
    let graded = args.iter().any(|a| a == "-g");
    let mesh = if graded {
        if problem.stages.len() == 1 { Mesh::graded(&[(s, n)]) } else { Mesh::graded(&[(s.div_ceil(4), n), (s, n)]) }
    } else if problem.stages.len() == 1 {
        Mesh::uniform(&[(s, n)])
    } else {
        Mesh::uniform(&[(s.div_ceil(7), n), (s, n)])
    };
    let tolerances = Tolerances { error: 1e-4, violation: 5e-4, overshoot: 0.1, highest_order: get(6, 5) };
    let all =
        routes([-2.0, 0.0], [2.0, 0.0], &problem.obstacles, problem.limits.clearance_m + problem.body.radius_m, 4);
    for route in &all {
        let mut best = f64::MAX;
        for rep in 0..reps {
            let t0 = Instant::now();
            let mut nlp = Transcription::new(&model, mesh.clone());
            use planners::pseudospectral::Motion;
            let guess = Guess::new(&problem, route, model.coordinates());
            let x = nlp.guess(&|p, t, w| guess.write(p, t, w));
            let mut ip = InteriorPoint::new(&nlp, Settings::default());
            let mut sol = ip.solve(&mut nlp, &Start::Cold(x));
            let show = |sol: &planners::nlp::Solution, nlp: &Transcription, ip: &InteriorPoint| {
                if rep > 0 {
                    return;
                }
                if verbose {
                    for (i, r) in sol.history.iter().enumerate() {
                        println!(
                            "{i:3} f {:12.5} viol {:.2e} err {:.2e} mu {:.1e} delta {:.1e} a {:.2e}",
                            r.objective, r.violation, r.error, r.barrier, r.regularisation, r.step
                        );
                    }
                }
                let q = qualities(nlp, ip.x()).into_iter().flatten().reduce(|a, b| a.worse(b)).unwrap();
                println!(
                    "{:?} right {:?}: {:?} J {:.4} in {} its; segments {} nodes {} worst {:?}; T0 {:.4}",
                    case,
                    route.on_right,
                    sol.status,
                    sol.objective,
                    sol.iterations,
                    nlp.mesh().segments(),
                    nlp.mesh().nodes(),
                    q,
                    nlp.duration_s(0, ip.x())
                );
            };
            show(&sol, &nlp, &ip);
            for _ in 0..rounds {
                if sol.status != Status::Solved {
                    break;
                }
                let Some(mesh) = refine(&nlp, ip.x(), &tolerances) else { break };
                let mut finer = Transcription::new(&model, mesh);
                let start = nlp.carry_over(&ip.warm_start(), &finer);
                let mut finer_ip = InteriorPoint::new(&finer, Settings { start: 1e-3, ..Settings::default() });
                sol = finer_ip.solve(&mut finer, &start);
                show(&sol, &finer, &finer_ip);
                (nlp, ip) = (finer, finer_ip);
            }
            if verbose && rep == 0 {
                for (p, segs) in nlp.mesh().phases.iter().enumerate() {
                    let mut t = 0.0;
                    for g in segs {
                        print!("{:.3}:{} ", t, g.order);
                        t += g.share;
                    }
                    println!("phase {p}");
                }
            }
            best = best.min(t0.elapsed().as_secs_f64());
        }
        println!("time {:.2} ms", best * 1e3);
    }
}
