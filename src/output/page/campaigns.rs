//! The results of campaigns in a result folder: sweeps with their samples, stress tests and other JSON reports.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::Value;

use super::json_file::read_if_there;
use crate::error::Error;

/// The files of campaigns, by the beginning of their names, and their kinds.
const KINDS: [(&str, &str); 4] =
    [("sweep", "sweep"), ("stress-", "stress"), ("falsify", "falsify"), ("probability", "probability")];

/// The result of one campaign.
#[derive(Serialize)]
pub struct Campaign {
    /// Folder of its results, relative to the result folder.
    pub folder: String,
    /// `sweep`, `stress`, ...
    kind: &'static str,
    /// Its file.
    file: String,
    /// The content of its file.
    result: Value,
    /// The samples of a sweep.
    samples: Option<Samples>,
}

/// The samples of a sweep in columns: what was drawn, the margins.
#[derive(Serialize)]
pub struct Samples {
    /// Number and seed of each sample.
    number: Vec<usize>,
    seed: Vec<u64>,
    verdict: Vec<String>,
    failed: Vec<Vec<String>>,
    /// Names with units, and values of what was drawn.
    drawn: Vec<(String, Vec<f64>)>,
    /// Names of checks with the units of their margins, and the margins; null where there is none.
    margins: Vec<(String, String, Vec<Option<f64>>)>,
}

/// Every campaign in a result folder: directly in it (as `harness merge` leaves it) or below `<scenario>/<planner>`.
pub fn read(out: &Path) -> Result<Vec<Campaign>, Error> {
    let mut campaigns = Vec::new();
    for folder in folders(out) {
        let mut names: Vec<String> = fs::read_dir(&folder)
            .into_iter()
            .flatten()
            .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
            .filter(|name| name.ends_with(".json"))
            .collect();
        names.sort();
        for name in names {
            let Some((_, kind)) = KINDS.iter().find(|(prefix, _)| name.starts_with(prefix)) else { continue };
            let Some(result) = read_if_there(&folder.join(&name))? else { continue };
            let samples = if *kind == "sweep" { samples(&folder.join("sweep.parquet"))? } else { None };
            let relative = folder.strip_prefix(out).unwrap_or(&folder).to_string_lossy().replace('\\', "/");
            campaigns.push(Campaign { folder: relative, kind, file: name, result, samples });
        }
    }
    Ok(campaigns)
}

/// The folder itself, and all folders two levels below it, in the order of their names.
fn folders(out: &Path) -> Vec<PathBuf> {
    let below = |folder: &Path| -> Vec<PathBuf> {
        let entries = fs::read_dir(folder).into_iter().flatten();
        let mut paths: Vec<PathBuf> =
            entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| path.is_dir()).collect();
        paths.sort();
        paths
    };
    let planners = below(out).into_iter().flat_map(|scenario| below(&scenario));
    [out.to_owned()].into_iter().chain(planners).collect()
}

#[cfg(feature = "parquet")]
fn samples(path: &Path) -> Result<Option<Samples>, Error> {
    use crate::campaign::monte_carlo::{Sample, table};

    if !path.is_file() {
        return Ok(None);
    }
    let (sweep, samples) = table::read(path)?;
    let drawn = |name: &str, value: fn(&Sample) -> f64| (name.to_owned(), samples.iter().map(value).collect());
    let margin = |index: usize| samples.iter().map(move |it| it.margins[index]).map(|it| it.is_finite().then_some(it));
    let margins = sweep.checks.iter().enumerate();
    Ok(Some(Samples {
        number: samples.iter().map(|sample| sample.number).collect(),
        seed: samples.iter().map(|sample| sample.perturbation.seed).collect(),
        verdict: samples.iter().map(|sample| sample.verdict.to_string()).collect(),
        failed: samples.iter().map(|sample| sample.failed_checks.clone()).collect(),
        drawn: vec![
            drawn("wind [m/s]", |it| it.perturbation.wind_mps[0].hypot(it.perturbation.wind_mps[1])),
            drawn("wind towards east [m/s]", |it| it.perturbation.wind_mps[0]),
            drawn("wind towards north [m/s]", |it| it.perturbation.wind_mps[1]),
            drawn("mass, true over nominal [-]", |it| it.perturbation.mass_ratios[0]),
            drawn("load's mass, true over nominal [-]", |it| it.perturbation.mass_ratios[1]),
            drawn("standard deviation of the measured position [m]", |it| it.perturbation.noise_m),
            drawn("distance from the start [m]", |it| it.perturbation.start_m),
        ],
        margins: margins.map(|(index, (name, unit))| (name.clone(), unit.clone(), margin(index).collect())).collect(),
    }))
}

#[cfg(not(feature = "parquet"))]
fn samples(_: &Path) -> Result<Option<Samples>, Error> {
    Ok(None)
}
