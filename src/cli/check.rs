use std::path::PathBuf;

use clap::Args;
use scenarios::plan_input::names::ColumnMap;

use super::log_options::LogOptions;
use super::run::plain_name;
use super::session::Session;
use crate::console;
use crate::error::{Error, Exit};
use crate::jobs::{self, Job, Jobs};
use crate::plan_source::PlanSource;
use crate::plan_source::plan_import;

/// Fly and judge an existing plan
///
/// The plan is flown and judged like that of a registered planner. Missing controls and velocities are reconstructed.
/// Between two rows the vehicle may then have done anything that its limits allow: that uncertainty is subtracted from every
/// margin, and a check that it does not settle is undecided, which is not a pass. Rows 0.2 s apart cost some centimetres, rows
/// 5 s apart tens of metres.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Check {
    /// The scenario file
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// The plan: a table (.csv, .tsv, .txt, .tum, .parquet), polynomial pieces (.csv), a .json file, or an MCAP
    /// file or ROS 2 bag (.mcap), or a log of PX4 (.ulg)
    #[arg(long, value_name = "FILE")]
    plan: PathBuf,
    /// Names of columns that are not understood: 'theirs=ours, theirs[unit]=ours'
    #[arg(long, value_name = "MAP", value_parser = column_map, default_value = "", hide_default_value = true)]
    columns: ColumnMap,
    #[command(flatten)]
    log: LogOptions,
    /// Name of the results, in place of a planner's [default: the name of the plan file]
    #[arg(short = 'p', long = "planner", value_name = "NAME")]
    name: Option<String>,
    /// Seed of all random numbers of the flight, in place of the scenario's
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    #[command(flatten)]
    session: Session,
}

const EXAMPLES: &str = "\
Examples:
  harness check scenarios/fixed-wing/rendezvous-1.toml --plan my-plan.csv
  harness check scenarios/multirotor/trap.toml --plan pieces.csv
  harness check scenarios/multirotor/trap.toml --plan log.txt --columns 'when[ms]=t_s, alt[ft]=z_m'
  harness check scenarios/multirotor/trap.toml --plan bag.mcap --topic /plan
  harness check scenarios/fixed-wing/rendezvous-7.toml \\
      --plan out/rendezvous-7/parallel-scp/plan.json

Columns of tables (CSV, Parquet) for fixed wings; x points east, y north, z up:
  vehicle                          name in the scenario; optional if there is only one vehicle
  t_s                              time, from 0, increasing for each vehicle
  x_m, y_m, z_m                    position
  speed_mps, heading_rad,          velocity, the heading counterclockwise from east;
  flight_path_rad                  alternatively vx_mps, vy_mps, vz_mps, or heading_deg and
                                   flight_path_deg; reconstructed if absent
  n_x, n_y, n_z                    load factors, linear between the rows; reconstructed if absent

Columns for multirotors:
  vehicle, t_s, x_m, y_m, z_m      as above
  vx_mps, vy_mps, vz_mps           velocity: between two rows the plan is the cubic with their
                                   positions and velocities. If absent, it is reconstructed, and
                                   between two rows the vehicle may have done anything within its
                                   acceleration limit

Columns for slung loads, all required except at_node:
  vehicle, t_s, x_m, y_m, z_m, vx_mps, vy_mps, vz_mps
  roll_rad, pitch_rad, yaw_rad, rate_x_radps, rate_y_radps, rate_z_radps
  load_x_m, load_y_m, load_z_m, load_vx_mps, load_vy_mps, load_vz_mps
  thrust_1_n, thrust_2_n, thrust_3_n, thrust_4_n
  cable                            taut or slack, from this row to the next
  at_node                          yes where the planner imposed its constraints, no in between
  plan.csv also has Euler rates and cable angles, which follow from these and are ignored.

Every row of a table counts as a node of the planner in the checks nodes.*, unless at_node says
`no`; plan.json names the planner's own nodes. Common names (t, time, px, pos_x, vel_x, ...) and
units in brackets (px[ft], time[ms]) are understood; other columns are ignored, and listed.
Separators are commas, semicolons, tabs or spaces; lines that begin with # are comments. Eight
numbers in a row without a header are the TUM format.

Polynomial pieces of multirotors and fixed wings: duration,x^0,x^1,...,y^0,...,z^0,... as written
by uav_trajectories and Crazyswarm. Bezier curves and B-splines are given in JSON.

Messages of MCAP files: see `harness judge --help`; a nav_msgs/Path with stamps, or a
trajectory_msgs/MultiDOFJointTrajectory, is a plan in one message.

A JSON file is a plan.json of `harness run`, or these columns as arrays in every trajectory.
docs/plans.md describes all formats.";

pub fn column_map(text: &str) -> Result<ColumnMap, String> {
    ColumnMap::parse(text).map_err(|issue| issue.to_string())
}

impl Check {
    /// Reads, flies and judges the plan.
    pub fn execute(&self) -> Result<Exit, Error> {
        let (source, scenario) =
            jobs::load_file(&self.scenario, self.seed).inspect_err(|_| self.session.retract(None))?;
        let stem = self.plan.file_stem().unwrap_or_default().to_string_lossy();
        let name = plain_name(self.name.as_deref().unwrap_or(&stem));
        if let Some(given) = self.name.as_deref().filter(|given| *given != name) {
            console::eprint(&format!(
                "note: `{given}` cannot name a folder of results, or is a planner: it is `{name}` here"
            ));
        }
        let (header, tracks) = self
            .log
            .read_plan(&self.plan, &scenario, &self.columns)
            .inspect_err(|_| self.session.retract(Some([scenario.name.as_str(), name.as_str()])))?;
        let seed = scenario.simulation.seed;
        let answer = plan_import::complete(&scenario, header, tracks, &name, seed);
        let plan_source = PlanSource::Imported(Box::new(answer));
        self.session.run(Jobs { runnable: vec![Job { scenario, source, plan_source, seed }], rejected: Vec::new() })
    }
}
