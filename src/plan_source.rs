//! Where a plan comes from: a registered planner, an external command, or an imported file.
//!
//! ```text
//! PlanSource --prepare--> Guidance (a plan, or in-loop planners) --fly--> Flown (plan and flight)
//! ```

use planners::Planner;
use scenarios::{Iteration, Scenario};

pub mod external;
mod guidance;
pub mod in_loop;
#[cfg(feature = "mcap")]
pub mod logs;
pub mod plan_import;

use self::external::ExternalPlanner;
pub use self::guidance::{Flown, Guidance};
use self::plan_import::CompletedPlan;

/// Where the plan for a scenario comes from.
#[derive(Clone)]
pub enum PlanSource {
    /// A planner of the registry.
    Registered(&'static Planner),
    /// A command.
    External(ExternalPlanner),
    /// A plan that exists already, under the name of its planner.
    Imported(Box<CompletedPlan>),
}

/// Returns what an external planner has written to its standard error. An in-loop planner is terminated first.
pub type PlannerLog = Box<dyn FnOnce() -> String>;

/// What a plan source provides for one flight.
pub struct PlannerOutput {
    /// A plan, or in-loop planners.
    pub guidance: Guidance,
    /// Standard error of an external planner; `None` for the other sources.
    pub log: Option<PlannerLog>,
}

impl PlanSource {
    /// Name under which the results go.
    pub fn name(&self) -> &str {
        match self {
            Self::Registered(planner) => planner.name,
            Self::External(planner) => &planner.name,
            Self::Imported(answer) => &answer.plan.planner,
        }
    }

    /// Whether it plans during the flight.
    pub fn plans_in_the_loop(&self) -> bool {
        match self {
            Self::Registered(planner) => planner.plans_in_the_loop(),
            Self::External(planner) => planner.in_loop,
            Self::Imported(_) => false,
        }
    }

    /// Plans, or creates the in-loop planners. Planners receive [`Scenario::planner_view`], which holds no disturbances.
    ///
    /// - `progress`: receives each iteration of a registered planner
    pub fn prepare(&self, scenario: &Scenario, seed: u64, progress: &mut dyn FnMut(&Iteration)) -> PlannerOutput {
        match self {
            Self::Registered(planner) => {
                let guidance = prepare_registered(planner, &scenario.planner_view(), seed, progress);
                PlannerOutput { guidance, log: None }
            }
            Self::External(planner) => planner.prepare(&scenario.planner_view(), seed),
            Self::Imported(answer) => PlannerOutput { guidance: Guidance::Plan(answer.clone()), log: None },
        }
    }

    /// Plans and flies once.
    pub fn fly(&self, scenario: &Scenario, seed: u64) -> Flown {
        self.prepare(scenario, seed, &mut |_| {}).guidance.fly(scenario, seed, &mut |_| {})
    }

    /// What to fly in many worlds: `answer`, which stays as it is, or this source if it plans in the loop.
    pub fn fixed_to(&self, answer: CompletedPlan) -> Self {
        if self.plans_in_the_loop() { self.clone() } else { Self::Imported(Box::new(answer)) }
    }
}

fn prepare_registered(
    planner: &Planner,
    planner_view: &Scenario,
    seed: u64,
    progress: &mut dyn FnMut(&Iteration),
) -> Guidance {
    if planner.plans_in_the_loop() {
        let vehicles = 0..planner_view.vehicles.len();
        let planners = vehicles.map(|index| planner.in_loop(planner_view, index, seed)).collect();
        Guidance::InLoop { planner: planner.name.to_owned(), planners }
    } else {
        Guidance::Plan(Box::new(CompletedPlan::whole(planner.plan(planner_view, seed, progress))))
    }
}
