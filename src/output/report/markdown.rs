//! `summary.md`: the run as a page, for a pull request or a build log. Failures come first.

use super::{Summary, SummaryRun, headline};
use crate::number_format::{given_quantity, quantity, signed_quantity};
use crate::report::Report;
use crate::verdict::{Check, Outcome};

/// Largest number of failed jobs whose checks are listed.
const MAX_DETAILS: usize = 20;

/// What the scenarios in `summary.md` are linked to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Links {
    /// Nothing: the result folder cannot be reached from where the page is shown.
    None,
    /// `report.json`.
    Reports,
    /// The report page.
    Page,
}

/// The whole page.
///
/// - `reports`: of the jobs in the summary
/// - `links`: where the scenarios lead to
pub(super) fn page(summary: &Summary, reports: &[Report], links: Links) -> String {
    let mut lines = vec![format!("# {}", summary.counts_line()), String::new()];
    if links == Links::Page {
        lines.push("[The report page](index.html) shows the flights, every check and the series.".into());
        lines.push(String::new());
    }
    if !summary.refused.is_empty() {
        lines.push("## Refused as bad input".into());
        lines.push(String::new());
        let faults = summary.refused.iter().flat_map(|refused| &refused.faults);
        lines.extend(faults.map(|fault| format!("- `{}`", fault.replace('`', "'").replace('\n', " "))));
        lines.push(String::new());
    }
    if !summary.runs.is_empty() {
        lines.push("| verdict | scenario | planner | seed | flight time | why |".into());
        lines.push("|---|---|---|---:|---:|---|".into());
        let (good, bad): (Vec<_>, Vec<_>) = summary.runs.iter().partition(|run| run.is_good());
        lines.extend(bad.into_iter().chain(good).map(|run| row(run, links)));
        lines.push(String::new());
    }
    let failed: Vec<&Report> = reports.iter().filter(|report| report.verdict == Outcome::Fail).collect();
    lines.extend(failed.iter().take(MAX_DETAILS).flat_map(|report| details(report)));
    if failed.len() > MAX_DETAILS {
        lines.push(format!("{} more failed; their checks are in `report.json`.", failed.len() - MAX_DETAILS));
    }
    lines.join("\n")
}

/// The page truncated after a whole line to `max_bytes`, with a note if anything is missing.
pub(super) fn truncate(page: &str, max_bytes: usize) -> String {
    if page.len() <= max_bytes {
        return page.to_owned();
    }
    const NOTE: &str = "\n\nTruncated to the allowed size; the whole page is in `summary.md`.\n";
    let kept = &page[..page.floor_char_boundary(max_bytes.saturating_sub(NOTE.len()))];
    let kept = kept.rfind('\n').map_or("", |end| &kept[..end]);
    format!("{kept}{NOTE}")
}

fn row(run: &SummaryRun, links: Links) -> String {
    let flight_time = run.flight_time_s.map_or_else(String::new, |time_s| quantity(time_s, "s"));
    let claim = if run.overclaimed { " (the planner calls this plan solved)" } else { "" };
    let SummaryRun { verdict, scenario, planner, seed, folder, .. } = run;
    let losses = match run.losses.as_slice() {
        [] => String::new(),
        losses => format!("worse than the baseline: {}; ", losses.join("; ")),
    };
    let verdict = if losses.is_empty() { verdict.to_string() } else { format!("{verdict}, worse") };
    let why = cell(&format!("{losses}{}{claim}", run.reason));
    let scenario = match links {
        Links::None => scenario.clone(),
        Links::Reports => format!("[{scenario}]({folder}/report.json)"),
        Links::Page => format!("[{scenario}](index.html#{folder})"),
    };
    format!("| {verdict} | {scenario} | {planner} | {seed} | {flight_time} | {why} |")
}

/// A table of the failed checks of one job.
fn details(report: &Report) -> Vec<String> {
    let title = format!("## {} · {}", report.scenario, report.planner);
    let header =
        ["| check | measured | limit | margin | where, remarks |", "|---|---:|---:|---:|---|"].map(str::to_owned);
    let rows = headline::failed(report).map(check_row);
    let notes = headline::notes(report).into_iter().flat_map(|note| [String::new(), note]);
    [title, String::new()].into_iter().chain(header).chain(rows).chain(notes).chain([String::new()]).collect()
}

fn check_row(check: &Check) -> String {
    let shown = |value: Option<f64>, form: fn(f64, &str) -> String| {
        value.map_or_else(String::new, |value| form(value, &check.unit))
    };
    let (value, limit) = (shown(check.value, quantity), shown(check.limit, given_quantity));
    let remarks: Vec<String> = check.place().into_iter().chain(check.reason.clone()).collect();
    let margin = shown(check.margin, signed_quantity);
    format!("| `{}` | {value} | {limit} | {margin} | {} |", check.name, cell(&remarks.join("; ")))
}

/// Escapes what would end a table cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|").replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use super::truncate;

    #[test]
    fn a_page_that_is_too_long_is_truncated_after_a_whole_line_with_a_note() {
        let page = "äöü line\n".repeat(1000);
        let short = truncate(&page, 500);
        assert!(short.len() <= 500, "{} bytes", short.len());
        assert!(short.starts_with("äöü line\n") && short.contains("line\n\nTruncated"), "{short}");
        assert_eq!(truncate(&page, page.len()), page);
    }
}
