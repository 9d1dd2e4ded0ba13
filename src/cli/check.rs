use std::path::PathBuf;

use clap::Args;
use scenarios::plan_input;

use super::run::plain_name;
use super::session::Session;
use crate::error::{Error, Exit};
use crate::jobs::{self, Job, Jobs};
use crate::plan_source::PlanSource;
use crate::plan_source::plan_import;

/// Judge a plan that was made elsewhere.
///
/// The plan is flown and judged as one of our own. If it gives no controls, or no velocities either, they are
/// reconstructed; how well is stated, and what cannot be told within that is undecided, which is no pass.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Check {
    /// The scenario file that the plan answers
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// The plan: .csv, .json or .parquet
    #[arg(long, value_name = "FILE")]
    plan: PathBuf,
    /// Name under which the results go [default: that of the plan's file]
    #[arg(short = 'p', long = "planner", value_name = "NAME")]
    name: Option<String>,
    /// Seed of everything random in flight, instead of the scenario's own
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    #[command(flatten)]
    session: Session,
}

const EXAMPLES: &str = "\
Examples:
  harness check scenarios/fixed-wing/rendezvous-1.toml --plan my-plan.csv
  harness check scenarios/fixed-wing/rendezvous-7.toml --plan out/rendezvous-7/parallel-scp/plan.json

Columns of CSV and Parquet, one row per vehicle and time; x east, y north, z up:
  vehicle                                     its name in the scenario; may be missing if there is only one
  t_s                                         time from 0, increasing per vehicle
  x_m, y_m, z_m                               position
  speed_mps, heading_rad, flight_path_rad     velocity: heading counterclockwise from east (or vx_mps, vy_mps, vz_mps;
                                              angles also as heading_deg, flight_path_deg); reconstructed if absent
  n_x, n_y, n_z                               load factors, linear between the rows; reconstructed if absent

The plan of a slung load has the columns of its plan.csv, all of them. Which rows are the planner's own nodes only
plan.json says: in a table all of them are, and the checks nodes.* look at each.

JSON is plan.json as `harness run` writes it, or the same with these columns as arrays in every trajectory.";

impl Check {
    /// Reads, flies and judges the plan.
    pub fn execute(&self) -> Result<Exit, Error> {
        let (source, scenario) = jobs::load_file(&self.scenario, self.seed)?;
        let (header, tracks) = plan_input::read(&self.plan, &scenario)?;
        let stem = self.plan.file_stem().unwrap_or_default().to_string_lossy();
        let name = plain_name(self.name.as_deref().unwrap_or(&stem));
        let seed = scenario.simulation.seed;
        let answer = plan_import::complete(&scenario, header, tracks, &name, seed);
        let plan_source = PlanSource::Imported(Box::new(answer));
        self.session.run(Jobs { runnable: vec![Job { scenario, source, plan_source, seed }], rejected: Vec::new() })
    }
}
