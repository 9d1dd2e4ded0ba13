//! Merging result folders of several machines into one.

use std::fs;
use std::path::{Path, PathBuf};

use crate::console;
use crate::error::{Error, Exit};
use crate::output::report::{Links, Summary, junit, terminal};
use crate::output::{self, page};
use crate::report::Report;

/// Copies the results of `folders` into `out`, and writes the summaries of all of them. Returns the exit code that one run of
/// all of them would have had.
pub fn merge(folders: &[PathBuf], out: &Path, with_page: bool, is_quiet: bool) -> Result<Exit, Error> {
    let mut merged = Summary::default();
    let mut origins: Vec<(String, &Path)> = Vec::new();
    for folder in folders {
        let summary = read_summary(folder)?;
        for run in &summary.runs {
            if let Some((_, other)) = origins.iter().find(|(known, _)| *known == run.folder) {
                let reason = format!("{} is also in {}; give one of them another --out", run.folder, other.display());
                return Err(Error::results(folder, reason));
            }
            origins.push((run.folder.clone(), folder));
        }
        merged.runs.extend(summary.runs);
        merged.refused.extend(summary.refused);
        let worse = summary.worse_than_baseline.map(|worse| worse + merged.worse_than_baseline.unwrap_or(0));
        merged.worse_than_baseline = worse.or(merged.worse_than_baseline);
    }
    let mut reports = Vec::new();
    for (name, folder) in &origins {
        copy(&folder.join(name), &out.join(name))?;
        reports.push(read_report(&out.join(name).join("report.json"))?);
    }
    write(&merged, &reports, out, with_page)?;
    if !is_quiet {
        console::print(&terminal::summary(&merged, out))?;
    }
    Ok(merged.exit())
}

fn write(summary: &Summary, reports: &[Report], out: &Path, with_page: bool) -> Result<(), Error> {
    output::create_folder(out)?;
    output::write_json(&out.join("summary.json"), summary)?;
    let links = if with_page { Links::Page } else { Links::Reports };
    output::write_file(&out.join("summary.md"), |writer| write!(writer, "{}", summary.markdown(reports, links)))?;
    let xml = junit::document(reports, summary);
    output::replace_file(&out.join("junit.xml"), |partial| Ok(fs::write(partial, xml?)?))?;
    if with_page { page::write(out).map(drop) } else { output::remove_stale(&out.join(page::FILE_NAME)) }
}

fn read_summary(folder: &Path) -> Result<Summary, Error> {
    let path = folder.join("summary.json");
    let text = fs::read_to_string(&path).map_err(|reason| Error::results(&path, reason.to_string()))?;
    serde_json::from_str(&text).map_err(|reason| Error::results(&path, reason.to_string()))
}

fn read_report(path: &Path) -> Result<Report, Error> {
    let text = fs::read_to_string(path).map_err(|reason| Error::results(path, reason.to_string()))?;
    serde_json::from_str(&text).map_err(|reason| Error::results(path, reason.to_string()))
}

/// Copies the files of a job; nothing if it is there already.
fn copy(from: &Path, to: &Path) -> Result<(), Error> {
    output::create_folder(to)?;
    if from.canonicalize().ok() == to.canonicalize().ok() {
        return Ok(());
    }
    let unreadable = |reason: std::io::Error| Error::results(from, reason.to_string());
    for entry in fs::read_dir(from).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy(&entry.path(), &target)?;
        } else {
            output::replace_file(&target, |partial| Ok(fs::copy(entry.path(), partial).map(drop)?))?;
        }
    }
    Ok(())
}
