use std::path::PathBuf;

use clap::Args;
use scenarios::plan_input::names::ColumnMap;

use super::check::column_map;
use super::log_options::LogOptions;
use super::run::plain_name;
use super::session::Session;
use crate::console;
use crate::error::{Error, Exit};
use crate::jobs::{self, Job, Jobs};
use crate::pipeline;
use crate::plan_source::PlanSource;
use crate::plan_source::plan_import;

/// Judge a flight that was flown elsewhere: in another simulator, or by a real vehicle
///
/// Nothing is planned or simulated: the samples of the log are judged as the flight. Between two of them the vehicle may have
/// done anything that its limits allow: that uncertainty is subtracted from every margin, and a check that it does not settle is
/// undecided, which is not a pass. Checks that need more than positions, velocities and setpoints are skipped, each with its
/// reason; one that the scenario lists as `required` then fails.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct JudgeCommand {
    /// The scenario file
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// The log of the flight: a table (.csv, .tsv, .txt, .tum, .parquet), an MCAP file
    /// or ROS 2 bag (.mcap), or a log of PX4 (.ulg)
    #[arg(long, value_name = "FILE")]
    flight: PathBuf,
    /// Names of columns that are not understood: 'theirs=ours, theirs[unit]=ours'
    #[arg(long, value_name = "MAP", value_parser = column_map, default_value = "", hide_default_value = true)]
    columns: ColumnMap,
    #[command(flatten)]
    log: LogOptions,
    /// Topic of the setpoints in an MCAP or ULog file; of several vehicles VEHICLE=TOPIC, once for each
    #[arg(long, value_name = "[VEHICLE=]TOPIC")]
    setpoint_topic: Vec<String>,
    /// Name of the results, in place of a planner's [default: the name of the log]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    #[command(flatten)]
    session: Session,
}

const EXAMPLES: &str = "\
Examples:
  harness judge scenarios/multirotor/trap.toml --flight log.csv
  harness judge scenarios/multirotor/trap.toml --flight log.csv \\
      --columns 'stamp[ms]=t_s, alt=z_m'
  harness run --name rendezvous-1 --record parquet
  harness judge scenarios/fixed-wing/rendezvous-1.toml \\
      --flight out/rendezvous-1/fleet-scp/flight.parquet
  harness judge scenarios/multirotor/trap.toml --flight bag.mcap --topic /odom \\
      --setpoint-topic /setpoint
  harness judge scenarios/multirotor/trap.toml --flight log.ulg \\
      --setpoint-topic trajectory_setpoint
  harness judge scenarios/multirotor/trap.toml --flight bag.mcap --topic /state \\
      --field x=pos.east --field y=pos.north --field z=-pos.down

Columns, of fixed wings and multirotors; x points east, y north, z up:
  vehicle                          name in the scenario; optional if there is only one vehicle
  t_s                              time, from 0 at the start of the scenario, increasing for each
                                   vehicle, without gaps
  x_m, y_m, z_m                    position
  vx_mps, vy_mps, vz_mps           velocity over ground; may be absent, at the price of more that is
                                   unknown between the samples
  reference_x_m, reference_y_m, reference_z_m
                                   where the vehicle was told to be; without them tracking is not
                                   judged
Other names and units in brackets are understood as by `harness check`.

Messages of MCAP files: nav_msgs/Odometry and Path, geometry_msgs/PoseStamped,
trajectory_msgs/MultiDOFJointTrajectory, px4_msgs/VehicleLocalPosition and TrajectorySetpoint
(north, east, down is converted), any other by --field. Topics of ULog files:
vehicle_local_position (the default), trajectory_setpoint, any other by --field. Times count from
the first stamp.

What is judged: separation, clearance, crashes, map, geofences, altitude, speed, acceleration or
load factors, goal, rest, arrival, duration, tracking, and the requirements of the scenario. The
log must begin at the vehicle's start and go on until the last vehicle has arrived.
docs/flights.md has the rules.";

impl JudgeCommand {
    /// Reads and judges the log.
    pub fn execute(&self) -> Result<Exit, Error> {
        let (source, scenario) = jobs::load_file(&self.scenario, None).inspect_err(|_| self.session.retract(None))?;
        let stem = self.flight.file_stem().unwrap_or_default().to_string_lossy();
        let name = plain_name(self.name.as_deref().unwrap_or(&stem));
        if let Some(given) = self.name.as_deref().filter(|given| *given != name) {
            console::eprint(&format!(
                "note: `{given}` cannot name a folder of results, or is a planner: it is `{name}` here"
            ));
        }
        let without_effect = self.session.simulation_options();
        if !without_effect.is_empty() {
            let options = without_effect.join(", ");
            console::eprint(&format!("note: {options}: no effect on a flight that was flown elsewhere"));
        }
        let rows = self
            .log
            .read_flight(&self.flight, &scenario, &self.columns, &self.setpoint_topic)
            .inspect_err(|_| self.session.retract(Some([scenario.name.as_str(), name.as_str()])))?;
        let (log, setpoints) = plan_import::complete_flight(&scenario, rows, &name);
        let (seed, plan_source) = (scenario.simulation.seed, PlanSource::Imported(Box::new(log.clone())));
        let jobs = Jobs { runnable: vec![Job { scenario, source, plan_source, seed }], rejected: Vec::new() };
        self.session.run_by(jobs, &|job, outputs, folder, progress| {
            pipeline::judge_flight(job, (&log, &setpoints), outputs, folder, progress)
        })
    }
}
