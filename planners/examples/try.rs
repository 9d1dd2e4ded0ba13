//! Try.
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let mut scenario = scenarios::load(std::path::Path::new(&args[2])).unwrap();
    if let Some(n) = args.get(3) {
        let n: usize = n.parse().unwrap();
        scenario.vehicles.truncate(n);
    }
    let p = planners::find(&args[1]).unwrap();
    let mut k = 0;
    let plan = p.plan(&scenario, 0, &mut |i| {
        k += 1;
        if std::env::var("DEBUG").is_ok() {
            eprintln!(
                "{k} {:.4} rho {:.2} slack {:.2e} defect {:.2e} sep {:?} change {:.2} its {} {:.1} ms",
                i.objective,
                i.trust_region_m,
                i.slack,
                i.defect_m,
                i.separation_m,
                i.change_m,
                i.solver_iterations,
                1e3 * i.wall_s
            )
        }
    });
    println!(
        "{} {:?} {:?} T {:?} its {} wall {:.1} ms dist {:.1} ms",
        scenario.name,
        plan.status,
        plan.reason,
        plan.flight_time_s(),
        plan.history.len(),
        1e3 * plan.timings.wall_s,
        1e3 * plan.timings.distributed_s
    );
}
