//! What a result folder holds, for the page.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::GzEncoder;
use rayon::prelude::*;
use serde::Serialize;
use serde_json::Value;

use super::campaigns::{self, Campaign};
use super::json_file::read_if_there;
use crate::error::Error;
use crate::output::files::SCENE_FILE;
use crate::output::report::Summary;

/// Files of a job that the page links to, if they are there.
const LINKED: [&str; 8] = [
    "flight.rrd",
    "flight.mcap",
    "flight.parquet",
    "report.json",
    "plan.json",
    "plan.csv",
    "planner.log",
    "scene.json",
];
/// Fields of a report that are of no use on a page.
const LEFT_OUT: [&str; 1] = ["state_hash"];

/// Everything but the scenes.
#[derive(Serialize)]
pub struct Results {
    /// Version of the harness that wrote the page.
    harness: &'static str,
    /// `summary.json`; `None` if only campaigns were run.
    summary: Option<Summary>,
    /// The counts in words: `1 failed, 3 passed`.
    counts: Option<String>,
    jobs: Vec<Job>,
    /// `comparison.json`.
    comparison: Option<Value>,
    campaigns: Vec<Campaign>,
    /// `figures/*.svg`, by name.
    figures: Vec<Figure>,
}

/// One scenario and planner.
#[derive(Serialize)]
struct Job {
    folder: String,
    report: Value,
    /// Id of the element that holds its scene.
    scene: Option<String>,
    files: Vec<String>,
    /// The result that it is compared with.
    old: Option<OldJob>,
}

#[derive(Serialize)]
struct OldJob {
    report: Value,
    scene: Option<String>,
}

/// A figure of `harness figures`.
#[derive(Serialize)]
struct Figure {
    name: String,
    svg: String,
}

/// A compressed scene.
pub struct Scene {
    /// Id of its element.
    pub id: String,
    /// `scene.json`, by gzip, in base 64.
    pub base64: String,
}

impl Results {
    /// Reads a result folder, with the scenes.
    pub fn read(out: &Path) -> Result<(Self, Vec<Scene>), Error> {
        let summary: Option<Summary> = read_if_there(&out.join("summary.json"))?;
        let comparison: Option<Value> = read_if_there(&out.join(super::COMPARISON))?;
        let old = comparison.as_ref().and_then(|it| it["old"].as_str()).map(PathBuf::from);
        let folders = summary.iter().flat_map(|summary| &summary.runs).map(|run| run.folder.clone());
        let mut scenes = Vec::new();
        let jobs = folders.map(|folder| Job::read(out, folder, old.as_deref(), &mut scenes));
        let jobs = jobs.collect::<Result<Vec<Job>, Error>>()?;
        let campaigns = campaigns::read(out)?;
        let figures = figures(&out.join("figures"))?;
        if summary.is_none() && campaigns.is_empty() && figures.is_empty() {
            let reason = "found neither summary.json nor the results of a sweep or stress test in it".to_owned();
            return Err(Error::results(out, reason));
        }
        let scenes = scenes.into_par_iter().map(compressed).collect::<Result<Vec<Scene>, Error>>()?;
        let counts = summary.as_ref().map(Summary::counts_line);
        let harness = env!("CARGO_PKG_VERSION");
        Ok((Self { harness, summary, counts, jobs, comparison, campaigns, figures }, scenes))
    }

    /// Title of the page.
    pub fn title(&self) -> String {
        let what = match (self.jobs.as_slice(), self.campaigns.as_slice()) {
            ([job], _) => job.folder.replace('/', " · "),
            ([], [first, ..]) => first.folder.replace('/', " · "),
            _ => "results".to_owned(),
        };
        match &self.counts {
            Some(counts) => format!("{counts}: {what}"),
            None => what,
        }
    }
}

impl Job {
    fn read(
        out: &Path,
        folder: String,
        old: Option<&Path>,
        scenes: &mut Vec<(String, PathBuf)>,
    ) -> Result<Self, Error> {
        let path = out.join(&folder);
        let report = report(&path)?;
        let files = LINKED.iter().filter(|name| path.join(name).is_file()).map(|name| (*name).to_owned()).collect();
        let scene = scene_of(&path, scenes);
        let old = old.map(|old| old.join(&folder)).filter(|old| old.join("report.json").is_file());
        let old = old.map(|old| -> Result<OldJob, Error> {
            Ok(OldJob { report: self::report(&old)?, scene: scene_of(&old, scenes) })
        });
        Ok(Self { folder, report, scene, files, old: old.transpose()? })
    }
}

fn report(folder: &Path) -> Result<Value, Error> {
    let path = folder.join("report.json");
    let mut report: Value =
        read_if_there(&path)?.ok_or_else(|| Error::results(&path, "named in summary.json, but missing".to_owned()))?;
    if let Value::Object(fields) = &mut report {
        LEFT_OUT.iter().for_each(|name| drop(fields.remove(*name)));
    }
    Ok(report)
}

/// The id under which the scene of a folder will be in the page.
fn scene_of(folder: &Path, scenes: &mut Vec<(String, PathBuf)>) -> Option<String> {
    let path = folder.join(SCENE_FILE);
    path.is_file().then(|| {
        let id = format!("scene-{}", scenes.len() + 1);
        scenes.push((id.clone(), path));
        id
    })
}

fn compressed((id, path): (String, PathBuf)) -> Result<Scene, Error> {
    let compress = || {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(&fs::read(&path)?)?;
        encoder.finish()
    };
    let gzip = compress().map_err(|reason: std::io::Error| Error::results(&path, reason.to_string()))?;
    Ok(Scene { id, base64: STANDARD.encode(gzip) })
}

fn figures(folder: &Path) -> Result<Vec<Figure>, Error> {
    let Ok(entries) = fs::read_dir(folder) else { return Ok(Vec::new()) };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|it| it == "svg")).collect();
    paths.sort();
    let figure = |path: PathBuf| {
        let svg = fs::read_to_string(&path).map_err(|reason| Error::results(&path, reason.to_string()))?;
        Ok(Figure { name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(), svg })
    };
    paths.into_iter().map(figure).collect()
}
