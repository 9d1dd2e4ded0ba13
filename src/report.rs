//! `report.json`: everything that is known about one job, as data.

use scenarios::in_loop::ReplanStatus;
use scenarios::{Alternative, PlanStatus, PlannedEvent};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::{Flight, PlanningLog, Replan, StateHash};

use crate::campaign::margin_budget::MarginBudget;
use crate::metrics::Metrics;
use crate::plan_source::plan_import::CompletedPlan;
use crate::statistics;
use crate::verdict::{Check, CurveAsCubics, Integration, Outcome, Reconstruction, RoundedRows, Verdict};

/// Version of the format of `report.json` and `summary.json`.
pub const SCHEMA: u32 = 1;

/// `report.json`: everything that was measured for one scenario and one planner.
///
/// Equal scenario, planner and seed give an equal report on any number of threads, except for `timings` and the fields
/// `wall_s` and `distributed_s`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Report {
    /// Version of this format: 1.
    pub schema: u32,
    /// Version of the harness that wrote it.
    pub harness: String,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the planner.
    pub planner: String,
    /// Seed of planning and flight.
    pub seed: u64,
    /// The outcome of the verdict.
    pub verdict: Outcome,
    /// Was the flight flown elsewhere and judged by its log? Then `plan` describes the log.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub recorded: bool,
    /// Does the planner call its plan solved although a check of the group `plan` failed?
    pub overclaimed: bool,
    /// Every check, in the order nodes, plan, flight.
    pub checks: Vec<Check>,
    /// Estimate of the integration error; absent without a flight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub integration: Option<Integration>,
    /// Margin budgets, if they were asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub waterfall: Vec<MarginBudget>,
    /// Hashes of the flight, equal for flights that are equal to the last bit; absent without a flight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub state_hash: Option<StateHashes>,
    /// The plan, as the planner describes it.
    pub plan: PlanSummary,
    /// Figures without a limit.
    pub metrics: Metrics,
    /// Wall time of each stage.
    pub timings: Timings,
}

/// Running hashes of the flight log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StateHashes {
    /// Time between two hashes, s.
    pub every_s: f64,
    /// Hash of the log up to each of these times, 16 hexadecimal digits; the last one is that of the whole flight.
    pub running: Vec<String>,
}

impl StateHashes {
    /// Time between two hashes, s.
    const EVERY_S: f64 = 10.0;

    /// The hashes of a flight.
    pub fn of(flight: &Flight) -> Self {
        let running = flight.running_hash(Self::EVERY_S).iter().map(StateHash::digits).collect();
        Self { every_s: Self::EVERY_S, running }
    }
}

/// A plan without its trajectories.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PlanSummary {
    /// Status that the planner gives: `solved`, `not-converged`, `no-plan`, or `unstated`. It does not influence the verdict.
    #[schemars(with = "String")]
    pub status: PlanStatus,
    /// Why the status is not `solved`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// Iterations of the planner.
    pub iterations: usize,
    /// Time that planning took on this machine, s.
    pub wall_s: f64,
    /// Time that planning would take if every vehicle had its own computer, s.
    pub distributed_s: f64,
    /// Time at which the last vehicle reaches the end of its trajectory, s.
    pub flight_time_s: Option<f64>,
    /// Value of the planner's objective, in the planner's unit (for time-optimal planners s).
    pub objective: Option<f64>,
    /// What the plan lacked and was reconstructed, with the error of the reconstruction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reconstruction: Option<Reconstruction>,
    /// Rows of the plan's file that were left out because differences of their rounded numbers are noise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rounded: Option<RoundedRows>,
    /// Polynomial pieces that are judged as cubics.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<CurveAsCubics>,
    /// How the plan file was read, where a user should know.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<String>,
    /// Events of the plan, in the order of time.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<EventSummary>,
    /// Alternatives that the planner discarded.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alternatives: Vec<AlternativeSummary>,
}

/// An event of a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EventSummary {
    /// Time, s.
    pub at_s: f64,
    /// Description.
    pub what: String,
}

/// An alternative that the planner discarded, without its path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct AlternativeSummary {
    /// Its name.
    pub name: String,
    /// Status that the planner gives.
    #[schemars(with = "String")]
    pub status: PlanStatus,
    /// Value of the planner's objective.
    pub objective: Option<f64>,
}

/// Wall time of the stages, s.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Timings {
    /// Planning.
    pub planning_s: f64,
    /// Simulation.
    pub flying_s: f64,
    /// Judging.
    pub judging_s: f64,
    /// Writing the recordings.
    pub recording_s: f64,
    /// Wall times of the replans of an in-loop planner.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub replans: Option<ReplanTimes>,
}

/// Wall times of the replans of an in-loop planner on this machine.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ReplanTimes {
    /// Mean, s.
    pub mean_s: f64,
    /// Shortest, s.
    pub min_s: f64,
    /// Median, s.
    pub median_s: f64,
    /// Longest, s.
    pub max_s: f64,
    /// Number of replies that were flown in time although they took longer on this machine than the scenario's deadline:
    /// with `--planner-clock measured` they are late.
    #[serde(default)]
    pub over_deadline: usize,
}

impl ReplanTimes {
    /// Of all replans of a flight; `None` if there were none.
    pub fn of(log: &PlanningLog, deadline_s: f64) -> Option<Self> {
        let mut walls_s: Vec<f64> = log.replans.iter().map(|replan| replan.wall_s).collect();
        walls_s.sort_by(f64::total_cmp);
        let (min_s, max_s) = (*walls_s.first()?, *walls_s.last()?);
        let mean_s = statistics::mean(walls_s.iter().copied())?;
        let is_over_deadline = |replan: &&Replan| replan.outcome == ReplanStatus::InTime && replan.wall_s > deadline_s;
        let over_deadline = log.replans.iter().filter(is_over_deadline).count();
        Some(Self { mean_s, min_s, median_s: statistics::median(&walls_s)?, max_s, over_deadline })
    }
}

impl Timings {
    /// Sum of all stages, s.
    pub fn total_s(&self) -> f64 {
        self.planning_s + self.flying_s + self.judging_s + self.recording_s
    }
}

impl Report {
    /// The report on a judged plan.
    pub fn new(
        answer: &CompletedPlan,
        flight: Option<&Flight>,
        verdict: Verdict,
        metrics: Metrics,
        timings: Timings,
    ) -> Self {
        let plan = &answer.plan;
        Self {
            schema: SCHEMA,
            harness: env!("CARGO_PKG_VERSION").to_owned(),
            scenario: plan.scenario.clone(),
            planner: plan.planner.clone(),
            seed: plan.seed,
            verdict: verdict.outcome,
            recorded: false,
            overclaimed: verdict.overclaimed,
            checks: verdict.checks,
            integration: verdict.integration,
            waterfall: Vec::new(),
            state_hash: flight.map(StateHashes::of),
            plan: PlanSummary::new(answer),
            metrics,
            timings,
        }
    }
}

impl PlanSummary {
    fn new(answer: &CompletedPlan) -> Self {
        let plan = &answer.plan;
        Self {
            status: plan.status,
            reason: plan.reason.clone(),
            iterations: plan.history.len(),
            wall_s: plan.timings.wall_s,
            distributed_s: plan.timings.distributed_s,
            flight_time_s: plan.flight_time_s(),
            objective: plan.objective,
            events: plan.diagnostics.events.iter().map(EventSummary::new).collect(),
            alternatives: plan.diagnostics.alternatives.iter().map(AlternativeSummary::new).collect(),
            reconstruction: answer.provenance.reconstruction,
            rounded: answer.provenance.rounded,
            curve: answer.provenance.curve,
            remarks: answer.provenance.remarks.clone(),
        }
    }
}

impl EventSummary {
    fn new(event: &PlannedEvent) -> Self {
        Self { at_s: event.at_s, what: event.what.clone() }
    }
}

impl AlternativeSummary {
    fn new(alternative: &Alternative) -> Self {
        let Alternative { name, status, objective, .. } = alternative;
        Self { name: name.clone(), status: *status, objective: *objective }
    }
}
