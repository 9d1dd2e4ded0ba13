//! `summary.md`: the run as a page, for a pull request or a build log.

use super::{Summary, SummaryRun};
use crate::notation::quantity;

/// The whole page.
pub(super) fn page(summary: &Summary) -> String {
    let mut lines = vec![format!("# {}", summary.counts_line()), String::new()];
    if !summary.runs.is_empty() {
        lines.push("| verdict | scenario | planner | seed | flight time | why |".into());
        lines.push("|---|---|---|---:|---:|---|".into());
        lines.extend(summary.runs.iter().map(row));
        lines.push(String::new());
    }
    if !summary.refused.is_empty() {
        lines.push("## Refused as bad input".into());
        lines.push(String::new());
        let faults = summary.refused.iter().flat_map(|refused| &refused.faults);
        lines.extend(faults.map(|fault| format!("- `{}`", fault.replace('`', "'"))));
        lines.push(String::new());
    }
    lines.join("\n")
}

fn row(run: &SummaryRun) -> String {
    let flight_time = run.flight_time_s.map_or_else(String::new, |time_s| quantity(time_s, "s"));
    let claim = if run.overclaimed { " (the planner calls this plan solved)" } else { "" };
    let SummaryRun { verdict, scenario, planner, seed, folder, .. } = run;
    let why = cell(&format!("{}{claim}", run.reason));
    format!("| {verdict} | [{scenario}]({folder}/report.json) | {planner} | {seed} | {flight_time} | {why} |")
}

/// Text that stays in its cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}
