//! probe
fn main() {
    for path in std::env::args().skip(1) {
        let scenario = match scenarios::load(std::path::Path::new(&path)) {
            Ok(s) => s,
            Err(e) => {
                println!("{path}: {e}");
                continue;
            }
        };
        let planner = planners::find(&scenario.planner.name).unwrap();
        if let Some(reason) = (planner.refuses)(&scenario) {
            println!("{path}: refused {reason}");
            continue;
        }
        let mut rounds = Vec::new();
        let plan = planner.plan(&scenario, 1, &mut |i| rounds.push(i.clone()));
        for i in &rounds {
            println!(
                "   J {:.4} err {:.1e} its {} viol {:.1e} wall {:.1} ms",
                i.objective,
                i.defect_m,
                i.solver_iterations,
                i.slack,
                1e3 * i.wall_s
            );
        }
        println!(
            "{}: {:?} {:?} J {:?} flight {:?} wall {:.1} ms, {} samples",
            scenario.name,
            plan.status,
            plan.reason,
            plan.objective,
            plan.flight_time_s(),
            1e3 * plan.timings.wall_s,
            plan.trajectories.first().map_or(0, |t| t.times_s().len())
        );
    }
}
