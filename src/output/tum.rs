//! Planned and flown paths as TUM files, one pose per line: `timestamp tx ty tz qx qy qz qw`.
//!
//! For evo: `evo_ape tum uav-1.planned.tum uav-1.flown.tum` gives the figures that `report.json` has under `ape`.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use sim::Flight;

use crate::error::Error;
use crate::metrics::trajectory_error::{Pose, flown, planned};
use crate::output;

/// Name of the folder.
const FOLDER: &str = "tum";

/// Writes two files per vehicle into `tum/` in the result folder `folder`.
///
/// # Errors
///
/// [`Error::Write`] if the folder or a file cannot be written.
pub fn write(flight: &Flight, folder: &Path) -> Result<(), Error> {
    let folder = folder.join(FOLDER);
    output::create_folder(&folder)?;
    for log in &flight.vehicles {
        for (kind, poses) in [("planned", planned(log, flight)), ("flown", flown(log, flight))] {
            let path = folder.join(format!("{}.{kind}.tum", log.vehicle));
            output::write_file(&path, |writer| poses.iter().try_for_each(|pose| line(pose, writer)))?;
        }
    }
    Ok(())
}

/// Removes the files of an earlier run.
///
/// # Errors
///
/// [`Error::Write`] if the folder cannot be removed.
pub fn remove_stale(folder: &Path) -> Result<(), Error> {
    let path = folder.join(FOLDER);
    match fs::remove_dir_all(&path) {
        Err(reason) if reason.kind() != io::ErrorKind::NotFound => Err(Error::Write { path, reason: reason.into() }),
        _ => Ok(()),
    }
}

fn line(pose: &Pose, writer: &mut dyn Write) -> io::Result<()> {
    let Pose { t_s, position_m: [x, y, z], world_from_body: [qx, qy, qz, qw] } = pose;
    writeln!(writer, "{t_s} {x} {y} {z} {qx} {qy} {qz} {qw}")
}
