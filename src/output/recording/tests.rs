//! Recordings are written atomically.

use std::error::Error;
use std::fs;
use std::path::Path;

use scenarios::{
    FleetRules, Map, Models, Plan, PlanStatus, PlannerSettings, Range, Scenario, Simulation, VerdictLimits, World,
};

use super::{Recorder, Run, record};
use crate::verdict::{Outcome, Verdict};

/// Writes a line, then fails if `fails`.
struct LineRecorder {
    fails: bool,
}

impl Recorder for LineRecorder {
    fn file_name(&self) -> &'static str {
        "flight.txt"
    }

    fn write(&self, run: &Run<'_>, path: &Path) -> Result<(), Box<dyn Error + Send + Sync>> {
        fs::write(path, &run.scenario.name)?;
        if self.fails { Err("disk full".into()) } else { Ok(()) }
    }
}

/// Calls `test` with an empty run.
fn with_run(test: impl FnOnce(&Run<'_>)) {
    let axis = Range::new(0.0, 1.0);
    let scenario = Scenario {
        name: "nothing".to_owned(),
        description: String::new(),
        tags: Vec::new(),
        world: World::empty(Map { x_m: axis, y_m: axis, z_m: axis }),
        models: Models::default(),
        vehicles: Vec::new(),
        fleet: FleetRules::default(),
        planner: PlannerSettings::default(),
        simulation: Simulation::default(),
        verdict: VerdictLimits::default(),
        requirements: Vec::new(),
    };
    let plan = Plan { status: PlanStatus::NoPlan, ..Plan::new(&scenario.name, "", 0, Vec::new()) };
    let verdict = Verdict { outcome: Outcome::NoPlan, overclaimed: false, checks: Vec::new(), integration: None };
    test(&Run { scenario: &scenario, plan: &plan, flight: None, verdict: &verdict, waterfall: &[], ghost: None });
}

#[test]
fn a_failed_recorder_leaves_the_old_recording_and_no_temporary_file() {
    let folder = tempfile::tempdir().unwrap();
    with_run(|run| {
        fs::write(folder.path().join("flight.txt"), "old").unwrap();
        let error = record(&LineRecorder { fails: true }, run, folder.path()).unwrap_err();
        assert!(error.to_string().contains("flight.txt") && error.to_string().contains("disk full"), "{error}");
        assert_eq!(fs::read_to_string(folder.path().join("flight.txt")).unwrap(), "old");
        record(&LineRecorder { fails: false }, run, folder.path()).unwrap();
        assert_eq!(fs::read_to_string(folder.path().join("flight.txt")).unwrap(), "nothing");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    });
}

#[test]
fn the_error_of_a_missing_folder_names_the_file() {
    let folder = tempfile::tempdir().unwrap();
    with_run(|run| {
        let error = record(&LineRecorder { fails: false }, run, &folder.path().join("missing")).unwrap_err();
        assert!(error.to_string().contains("missing/flight.txt"), "{error}");
        #[cfg(feature = "rrd")]
        assert!(record(&super::rrd::Rrd, run, &folder.path().join("missing")).is_err());
    });
}
