//! The results as a table on the terminal and as a page in Markdown.

use super::{REPEATING_S, Results, RouteResult, Row};
use crate::output::report::table;

const HEADER: [&str; 13] = [
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
    "switches",
    "remark",
];

/// Columns of numbers.
const NUMBERS: [usize; 9] = [3, 4, 5, 6, 7, 8, 9, 10, 11];

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
        format!("{}, {}", way.switches_s.len(), way.r_function_switches_s.len()),
        if way.is_solved { String::new() } else { "not solved".to_owned() },
    ]
}

fn notes(results: &Results) -> Vec<String> {
    let mut notes = vec![
        "taut: tension in closed form, the envelope circle by smooth constraints. complementarity: tension as a control, \
         λ (l_0 - ρ) <= 1e-6 N m at every node. r-function: taut, the same circle by the paper's R-functions (eq. 19, 20), with \
         their kinks. parts: taut, with body, cable and load clear of the obstacles instead of the circle. generalised torques: \
         taut, with the paper's approximation E u of the generalised torques (eq. 5); else E u are torques about the body's axes. \
         refined: from a graded mesh, until error, clearance and thrusts hold between the nodes as well."
            .to_owned(),
        format!(
            "ms: from a cold start, fastest of {} solves, or of those that {REPEATING_S} s admit; one route on one thread, and \
             all routes on {} threads.",
            results.repetitions + 1,
            results.threads
        ),
        "its: Newton steps, and the number of meshes. variables, segments: on the last mesh.".to_owned(),
        "error: of the states between the nodes, relative to 1 + their magnitude. clearance: of the envelope circle (eq. 14), \
         between the nodes as well. switches: of its radius between body and load by eq. 14, and by the bound of eq. 19."
            .to_owned(),
    ];
    notes.extend(
        results
            .rows
            .iter()
            .filter(|row| row.mesh == "refined")
            .flat_map(|row| row.ways.iter().map(|way| switches(row, way))),
    );
    notes
}

/// The instants of the switches on the refined mesh.
fn switches(row: &Row, way: &RouteResult) -> String {
    let list = |switches_s: &[f64]| match switches_s {
        [] => "none".to_owned(),
        all => all.iter().map(|at_s| format!("{at_s:.3}")).collect::<Vec<_>>().join(", ") + " s",
    };
    let [exact, bound] = [&way.switches_s, &way.r_function_switches_s].map(|switches_s| list(switches_s));
    format!("Envelope of {}, {}: switches by eq. 14: {exact}; by eq. 19: {bound}.", row.formulation, way.name)
}
