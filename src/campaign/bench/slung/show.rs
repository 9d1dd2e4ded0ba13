//! The results as a table on the terminal and as a page in Markdown.

use super::{Results, RouteResult, Row};
use crate::output::report::table;

const HEADER: [&str; 12] = [
    "mesh",
    "formulation",
    "route",
    "segments",
    "variables",
    "its",
    "ms",
    "all routes ms",
    "J",
    "error",
    "clearance m",
    "remark",
];

/// Columns of numbers.
const NUMBERS: [usize; 8] = [3, 4, 5, 6, 7, 8, 9, 10];

/// The table on the terminal, with notes.
pub fn text(results: &Results) -> String {
    let mut table = table::with_header(&HEADER, &NUMBERS);
    for cells in rows(results) {
        table.add_row(cells);
    }
    format!("{}\n\n{}", table.trim_fmt(), notes(results).join("\n"))
}

/// The same as a page in Markdown.
pub fn markdown(results: &Results) -> String {
    let grid = table::markdown(&HEADER, &NUMBERS, rows(results));
    let notes: String = notes(results).iter().map(|note| format!("- {note}\n")).collect();
    format!("# Collocation of {}\n\n{grid}\n{notes}", results.scenario)
}

fn rows(results: &Results) -> impl Iterator<Item = [String; HEADER.len()]> + '_ {
    results.rows.iter().flat_map(|row| row.ways.iter().enumerate().map(move |(i, way)| cells(row, way, i == 0)))
}

fn cells(row: &Row, way: &RouteResult, is_first: bool) -> [String; HEADER.len()] {
    let once = |text: String| if is_first { text } else { String::new() };
    [
        once(row.mesh.clone()),
        once(row.formulation.to_owned()),
        way.name.clone(),
        way.segments.to_string(),
        way.variables.to_string(),
        if way.meshes > 1 { format!("{} on {}", way.iterations, way.meshes) } else { way.iterations.to_string() },
        format!("{:.1}", way.time_ms),
        once(format!("{:.1}", row.all_ways_ms)),
        format!("{:.4}", way.objective),
        format!("{:.1e}", way.error_between_nodes),
        format!("{:.4}", way.clearance_m),
        if way.is_solved { String::new() } else { "not solved".to_owned() },
    ]
}

fn notes(results: &Results) -> [String; 4] {
    [
        "taut: tension in closed form. complementarity: tension as a control, λ (l_0 - ρ) <= 1e-6 N m at every node. \
         refined: from a graded mesh, until error, clearance and thrusts hold between the nodes as well."
            .to_owned(),
        format!(
            "ms: from a cold start, fastest of {} solves after a warm-up; one route on one thread, and all routes on {} threads.",
            results.repetitions, results.threads
        ),
        "its: Newton steps, and the number of meshes. variables, segments: on the last mesh.".to_owned(),
        "error: of the states between the nodes, relative to 1 + their magnitude. clearance: of the envelope circle, between \
         the nodes as well."
            .to_owned(),
    ]
}
