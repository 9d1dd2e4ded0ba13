//! Time per subproblem: our backends and Clarabel, on subproblems of a real run. `cargo bench --bench ipm`

use std::fmt;
use std::path::Path;
use std::sync::LazyLock;

use divan::Bencher;
use harness::campaign::bench::ipm::TOLERANCE;
use harness::campaign::bench::subproblems::{self, Subproblem};
use planners::convex::{self, Backend, BatchSolver, InteriorPoint, Settings};

fn main() {
    divan::main();
}

/// A subproblem under its name.
#[derive(Clone, Copy)]
struct Named(&'static Subproblem);

impl fmt::Display for Named {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}", self.0.name)
    }
}

static FULL_SIZE: LazyLock<Vec<Subproblem>> = LazyLock::new(|| of_rendezvous(40));
static SMALL: LazyLock<Vec<Subproblem>> = LazyLock::new(|| of_rendezvous(4));

fn of_rendezvous(intervals: usize) -> Vec<Subproblem> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/fixed-wing/rendezvous-7.toml");
    subproblems::from_run(&scenarios::load(&path).expect("shipped scenario"), intervals)
}

fn full_size() -> impl Iterator<Item = Named> {
    FULL_SIZE.iter().map(Named)
}

fn small() -> impl Iterator<Item = Named> {
    SMALL.iter().map(Named)
}

fn solve(bencher: Bencher, Named(subproblem): Named, backend: Backend) {
    let program = &subproblem.program;
    let settings = Settings { tolerance: TOLERANCE, ..Settings::default() };
    let mut solver = InteriorPoint::with_backend(settings, backend);
    bencher.bench_local(|| solver.solve(program));
}

#[divan::bench(args = full_size())]
fn clarabel(bencher: Bencher, Named(subproblem): Named) {
    bencher.bench_local(|| convex::solve_with_clarabel(&subproblem.program, TOLERANCE));
}

#[divan::bench(args = full_size())]
fn block(bencher: Bencher, subproblem: Named) {
    solve(bencher, subproblem, Backend::Block);
}

/// Four subproblems in one pass: divide by four.
#[divan::bench(args = full_size())]
fn block_x4(bencher: Bencher, Named(subproblem): Named) {
    let solvers = BatchSolver::new(Settings { tolerance: TOLERANCE, ..Settings::default() });
    bencher.bench_local(|| solvers.solve_all(&subproblem.batch));
}

#[divan::bench(args = full_size())]
fn sparse_ldl(bencher: Bencher, subproblem: Named) {
    solve(bencher, subproblem, Backend::SparseLdl);
}

#[divan::bench(args = small())]
fn dense_reduced(bencher: Bencher, subproblem: Named) {
    solve(bencher, subproblem, Backend::DenseReduced);
}

#[divan::bench(args = small(), sample_count = 5)]
fn dense_kkt(bencher: Bencher, subproblem: Named) {
    solve(bencher, subproblem, Backend::DenseKkt);
}
