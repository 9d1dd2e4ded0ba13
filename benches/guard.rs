//! Time of the guard for a candidate of 5 s among 50 prisms: over many different candidates, the median, the 99.9 % and the
//! longest, of all calls and of each candidate's fastest call, which other work on the machine does not disturb.
//! `cargo bench --bench guard`

#[path = "../tests/guard/candidates.rs"]
mod candidates;

use std::time::{Duration, Instant};

use harness::guard::{Guard, Knot};
use harness::verdict::Status;

/// Number of different candidates, and of rounds through them.
const CANDIDATES: u64 = 2000;
const ROUNDS: usize = 10;

fn main() {
    let scenario = candidates::scenario();
    let mut guard = Guard::new(&scenario, &scenario.vehicles[0].name).expect("a guard");
    let candidates: Vec<Vec<Knot>> = (0..CANDIDATES).map(candidates::candidate).collect();
    let passed = candidates.iter().filter(|knots| guard.judge(knots, None).status == Status::Pass).count();
    println!(
        "guard: {ROUNDS} x {CANDIDATES} calls, {} knots, {} prisms; {:.0} % pass",
        candidates[0].len(),
        scenario.world.prisms.len(),
        100.0 * passed as f64 / candidates.len() as f64
    );
    let mut all: Vec<Duration> = Vec::with_capacity(candidates.len() * ROUNDS);
    let mut fastest = vec![Duration::MAX; candidates.len()];
    for _ in 0..ROUNDS {
        for (knots, fastest) in candidates.iter().zip(&mut fastest) {
            let began = Instant::now();
            std::hint::black_box(guard.judge(knots, Some(&knots[0])));
            let time = began.elapsed();
            all.push(time);
            *fastest = time.min(*fastest);
        }
    }
    print("all calls", all);
    print("fastest of each", fastest);
}

fn print(what: &str, mut times: Vec<Duration>) {
    times.sort_unstable();
    let at = |fraction: f64| times[((times.len() - 1) as f64 * fraction) as usize].as_secs_f64() * 1e6;
    let [median, tail, longest] = [0.5, 0.999, 1.0].map(at);
    println!("{what:<16} median {median:7.1} µs   99.9 % {tail:7.1} µs   longest {longest:7.1} µs");
}
