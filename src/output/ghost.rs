//! The flight of an earlier run, to be shown beside a new one. It is read from that run's `scene.json`.

use std::fs;
use std::path::Path;

use serde::Deserialize;

use super::files::SCENE_FILE;
use crate::error::Error;

/// The flight of an earlier run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ghost {
    /// Every vehicle, in the order of the scenario.
    pub vehicles: Vec<GhostVehicle>,
}

/// One vehicle of an earlier run.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct GhostVehicle {
    /// Its name.
    #[serde(rename = "frame")]
    pub name: String,
    /// Times, s, increasing.
    pub times_s: Vec<f64>,
    /// Its position at each time, m.
    pub positions_m: Vec<[f64; 3]>,
    kind: String,
}

#[derive(Deserialize)]
struct SceneFile {
    bodies: Vec<GhostVehicle>,
}

impl Ghost {
    /// Reads the flight of a job.
    ///
    /// - `results`: a result folder, or the folder of a single job in one
    /// - `job`: the folder of the job in a result folder, `<scenario>/<planner>`
    ///
    /// Returns `None` if there is no scene.
    ///
    /// # Errors
    ///
    /// [`Error::Results`] if `scene.json` is there and is not one of this version.
    pub fn read(results: &Path, job: &Path) -> Result<Option<Self>, Error> {
        let files = [results.to_owned(), results.join(job)].map(|folder| folder.join(SCENE_FILE));
        let Some(path) = files.into_iter().find(|file| file.is_file()) else { return Ok(None) };
        let text = fs::read_to_string(&path).map_err(|reason| Error::results(&path, reason.to_string()))?;
        let scene: SceneFile = serde_json::from_str(&text)
            .map_err(|reason| Error::results(&path, format!("not a scene of this version: {reason}")))?;
        let mut vehicles = scene.bodies;
        vehicles.retain(|body| body.kind == "vehicle" && body.times_s.len() == body.positions_m.len());
        Ok((!vehicles.is_empty()).then_some(Self { vehicles }))
    }
}
