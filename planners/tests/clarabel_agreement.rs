//! The subproblems of the shipped scenarios, solved a second time by Clarabel: the objectives must agree.

use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

use planners::convex::{self, InteriorPoint, Program, STAGE_LEN, Settings, Solution, Status};
use planners::scp::{fleet, parallel};
use scenarios::Scenario;

/// Largest relative difference of the objectives (step length plus penalties, s).
const AGREEMENT: f64 = 1e-6;

/// Largest fraction of subproblems on which Clarabel may stall.
const MAX_STALLED_FRACTION: f64 = 0.02;

/// The same with rows of weights up to 1e6.
const MAX_STALLED_FRACTION_WEIGHTED: f64 = 0.2;

/// Largest number of vehicles for which every subproblem is compared. Larger fleets have hundreds of subproblems per
/// iteration; a sample of those of `fleet-scp` is compared.
const SMALL_FLEET: usize = 15;

#[test]
fn block_and_clarabel_agree_on_every_subproblem_of_the_shipped_scenarios() {
    let mut count = 0;
    for scenario in windless_scenarios().filter(|scenario| scenario.vehicles.len() <= SMALL_FLEET) {
        compare_all(&scenario);
        count += 1;
    }
    assert!(count >= 15, "only {count} scenarios found");
}

fn compare_all(scenario: &Scenario) {
    let agreement = Agreement::default();
    let plan = parallel::plan_and_inspect(scenario, 0, &mut |_| {}, &|program, block| {
        agreement.compare(program, block);
    });
    assert!(plan.history.len() > 1);
    agreement.assert_of(scenario, plan.history.len() * scenario.vehicles.len(), MAX_STALLED_FRACTION_WEIGHTED);
}

#[test]
fn block_and_clarabel_agree_on_subproblems_of_the_fleet_planner() {
    for scenario in windless_scenarios().filter(|scenario| scenario.vehicles.len() <= 100) {
        let (agreement, seen) = (Agreement::default(), AtomicUsize::new(0));
        let stride = scenario.vehicles.len().div_ceil(SMALL_FLEET);
        fleet::plan_and_inspect(&scenario, 0, &mut |_| {}, &|programs, _| {
            for program in programs.iter().step_by(stride) {
                // the planner itself uses a looser tolerance in the search phase
                let block = InteriorPoint::new(Settings::default()).solve(program);
                agreement.compare(program, &block);
                seen.fetch_add(1, Ordering::Relaxed);
            }
        });
        let seen = seen.into_inner();
        assert!(seen > 1);
        agreement.assert_of(&scenario, seen, MAX_STALLED_FRACTION);
    }
}

/// The shipped scenarios without wind. Planners do not know the wind, so the others have the same subproblems.
fn windless_scenarios() -> impl Iterator<Item = Scenario> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/fixed-wing");
    let paths = scenarios::find(&[folder]).expect("shipped scenarios");
    let all = paths.into_iter().map(|path| scenarios::load(&path).expect("shipped scenario"));
    all.filter(|scenario| scenario.simulation.wind.is_none())
}

/// Results of the comparisons so far.
#[derive(Default)]
struct Agreement {
    disagreements: Mutex<Vec<String>>,
    stalls: AtomicUsize,
}

impl Agreement {
    fn compare(&self, program: &Program, block: &Solution) {
        let clarabel = convex::solve_with_clarabel(program, 1e-8);
        let stalled = clarabel.status != Status::Solved;
        self.stalls.fetch_add(usize::from(stalled), Ordering::Relaxed);
        // Where Clarabel stalls, its objective is no bound, but its variables are still a candidate. Its objective is too
        // small by its residuals times the weights; with large ones only the candidate bounds the optimum from above.
        let candidate = program.objective(&clarabel.z);
        let is_weighted = program.row_units != [1.0; STAGE_LEN];
        let upper = if stalled || is_weighted { candidate } else { clarabel.objective };
        let scale = upper.abs().max(1.0);
        let is_as_good = block.objective - upper <= AGREEMENT * scale;
        let is_possible = stalled || block.objective - clarabel.objective >= -AGREEMENT * scale;
        if block.status != Status::Solved || !(is_as_good && is_possible) {
            let other = format!("{:?} {} ({candidate})", clarabel.status, clarabel.objective);
            let line = format!("{:?} {} against {other}", block.status, block.objective);
            self.disagreements.lock().expect("no panic while it was held").push(line);
        }
    }

    fn assert_of(self, scenario: &Scenario, subproblems: usize, max_stalled_fraction: f64) {
        let disagreements = self.disagreements.into_inner().expect("no panic while it was held");
        assert!(disagreements.is_empty(), "{}: {disagreements:#?}", scenario.name);
        let stalls = self.stalls.into_inner();
        assert!(
            stalls as f64 <= max_stalled_fraction * subproblems as f64,
            "{}: Clarabel stalled on {stalls} of {subproblems}",
            scenario.name
        );
    }
}
