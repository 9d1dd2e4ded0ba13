//! The results as a table on the terminal and as a page in Markdown.

use super::{Failure, Results, Row, RunOutcome};
use crate::output::report::table;

const HEADER: [&str; 15] = [
    "kind",
    "size",
    "density",
    "runs",
    "pass",
    "no plan",
    "fail",
    "overclaimed",
    "timed out",
    "planning s: 50 %",
    "90 %",
    "max",
    "flight / bound: 50 %",
    "max",
    "planner",
];

const COLUMNS: usize = HEADER.len();

/// Columns of numbers.
const NUMBERS: [usize; 13] = [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13];

/// Failures that are listed on the terminal.
const LISTED: usize = 20;

/// The table on the terminal, with notes and the first failures.
pub fn text(results: &Results) -> String {
    let mut table = table::with_header(&HEADER, &NUMBERS);
    for row in &results.rows {
        table.add_row(cells(row));
    }
    table.add_row(total(results));
    let failures: Vec<String> = results.failures.iter().take(LISTED).map(line).collect();
    let more = match results.failures.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!("\n... and {more} more in suite.json"),
    };
    let failures = if failures.is_empty() { String::new() } else { format!("\n\n{}{more}", failures.join("\n")) };
    format!("{}\n\n{}{failures}", table.trim_fmt(), notes(results).join("\n"))
}

/// The same as a page in Markdown.
pub fn markdown(results: &Results) -> String {
    let mut page = String::from("# Random scenarios\n\n");
    let rows = results.rows.iter().map(cells).chain([total(results)]);
    page.push_str(&table::markdown(&HEADER, &NUMBERS, rows));
    page.push('\n');
    notes(results).iter().for_each(|note| page.push_str(&format!("- {note}\n")));
    page
}

fn line(failure: &Failure) -> String {
    let Failure { scenario, planner, outcome, reason, generate, .. } = failure;
    format!("{scenario} · {planner}: {}: {reason}\n    {}\n    {generate}", outcome.name(), failure.command())
}

fn cells(row: &Row) -> [String; COLUMNS] {
    let kind = match row.variant {
        Some(variant) => format!("{} --{variant}", row.kind),
        None => row.kind.to_owned(),
    };
    let seconds =
        |index: usize| row.planning_s.map_or_else(String::new, |planning_s| format!("{:.3}", planning_s[index]));
    let ratio = |index: usize| row.over_lower_bound.map_or_else(String::new, |ratios| format!("{:.2}", ratios[index]));
    let counts = RunOutcome::ALL.map(|outcome| count(row.count(outcome), outcome));
    let [pass, no_plan, fail, overclaimed, timed_out] = counts;
    [
        kind,
        row.size.to_string(),
        row.density.to_string(),
        row.runs.to_string(),
        pass,
        no_plan,
        fail,
        overclaimed,
        timed_out,
        seconds(0),
        seconds(1),
        seconds(2),
        ratio(0),
        ratio(1),
        row.planner.clone(),
    ]
}

/// Zeros are left out, apart from that of passes.
fn count(count: usize, outcome: RunOutcome) -> String {
    if count == 0 && outcome != RunOutcome::Pass { String::new() } else { count.to_string() }
}

fn total(results: &Results) -> [String; COLUMNS] {
    let mut cells: [String; COLUMNS] = Default::default();
    cells[0] = "all".to_owned();
    cells[3] = results.rows.iter().map(|row| row.runs).sum::<usize>().to_string();
    for (column, outcome) in RunOutcome::ALL.into_iter().enumerate() {
        cells[4 + column] = results.rows.iter().map(|row| row.count(outcome)).sum::<usize>().to_string();
    }
    cells
}

fn notes(results: &Results) -> Vec<String> {
    let mut notes = vec![
        format!(
            "Seeds {} to {} of every kind and size; harness {}; {} s for planning, flight and verdict of each run; {} runs at a \
             time, {} threads.",
            results.seeds[0], results.seeds[1], results.harness, results.limit_s, results.jobs, results.threads
        ),
        "Every scenario is known to be feasible; its file says why. no plan: the planner says so. fail: a check of plan or flight \
         failed. overclaimed: the planner calls the plan solved, and a check of the plan failed."
            .to_owned(),
        "planning s: quantiles over the runs; for planners in the loop the sum over all replans of a flight.".to_owned(),
        "flight / bound: flight time of the runs that passed, over that of a straight line at the planning limits, which \
         obstacles, other vehicles and turns make unattainable. Slung loads have a given flight time."
            .to_owned(),
    ];
    if let Some(first) = results.infeasible.first() {
        notes.push(format!(
            "{} scenarios are missing: no feasible one was found for their seeds (the first: {first}).",
            results.infeasible.len()
        ));
    }
    notes
}
