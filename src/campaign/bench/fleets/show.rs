//! The results as tables on the terminal and as a page in Markdown.

use super::{Measured, Results, Row};
use crate::output::report::table;

const HEADER: [&str; 13] = [
    "scenario",
    "N",
    "planner",
    "verdict",
    "its",
    "wall s",
    "distr. s",
    "flight s",
    "nodes m",
    "plan m",
    "flight m",
    "defect m",
    "rollout m",
];

const GROWTH: [&str; 7] =
    ["scenario", "N", "verdict", "its", "planning s", "µs per vehicle and iteration", "flight and verdict s"];

/// The tables on the terminal, with notes.
pub fn text(results: &Results) -> String {
    let mut fleets = table::with_header(&HEADER, &[1, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
    results.rows.iter().for_each(|row| {
        fleets.add_row(cells(row));
    });
    let mut growth = table::with_header(&GROWTH, &[1, 3, 4, 5, 6]);
    results.growth.iter().for_each(|row| {
        growth.add_row(growth_cells(row));
    });
    let tables = [fleets.trim_fmt(), growth.trim_fmt()];
    let shown = if results.growth.is_empty() { &tables[..1] } else { &tables[..] };
    format!("{}\n\n{}", shown.join("\n\n"), notes(results).join("\n"))
}

/// The same as a page in Markdown.
pub fn markdown(results: &Results) -> String {
    let mut page = String::from("# Ways to decouple a fleet\n\n");
    page.push_str(&grid(
        &HEADER,
        "|---|---:|---|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
        results.rows.iter().map(cells),
    ));
    if !results.growth.is_empty() {
        page.push_str("\n## Growth at constant density\n\n");
        page.push_str(&grid(&GROWTH, "|---|---:|---|---:|---:|---:|---:|", results.growth.iter().map(growth_cells)));
    }
    page.push('\n');
    notes(results).iter().for_each(|note| page.push_str(&format!("- {note}\n")));
    page
}

fn grid<const N: usize>(header: &[&str; N], rule: &str, rows: impl Iterator<Item = [String; N]>) -> String {
    let line = |cells: &[String; N]| format!("| {} |\n", cells.join(" | "));
    let body: String = rows.map(|cells| line(&cells)).collect();
    format!("{}{rule}\n{body}", line(&header.map(str::to_owned)))
}

fn cells(row: &Row) -> [String; HEADER.len()] {
    let measured = |form: fn(&Measured) -> String| row.measured.as_ref().map_or_else(String::new, form);
    [
        row.scenario.clone(),
        row.vehicles.to_string(),
        row.planner.to_owned(),
        row.outcome.name().to_owned(),
        measured(|it| it.iterations.to_string()),
        measured(|it| format!("{:.3}", it.wall_s)),
        measured(|it| format!("{:.3}", it.distributed_s)),
        measured(|it| metres(it.flight_time_s)),
        measured(|it| metres(it.separation_m[0])),
        measured(|it| metres(it.separation_m[1])),
        measured(|it| metres(it.separation_m[2])),
        measured(|it| metres(it.defect_m)),
        measured(|it| metres(it.rollout_m)),
    ]
}

fn growth_cells(row: &Row) -> [String; GROWTH.len()] {
    let measured = |form: fn(&Measured) -> String| row.measured.as_ref().map_or_else(String::new, form);
    [
        row.scenario.clone(),
        row.vehicles.to_string(),
        row.outcome.name().to_owned(),
        measured(|it| it.iterations.to_string()),
        measured(|it| format!("{:.3}", it.wall_s)),
        measured(|it| format!("{:.0}", 1e6 * it.per_vehicle_and_iteration_s)),
        measured(|it| format!("{:.2}", it.flight_and_verdict_s)),
    ]
}

fn metres(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| format!("{value:.2}"))
}

fn notes(results: &Results) -> [String; 5] {
    [
        format!(
            "N: the first N vehicles of the scenario. Each entry had {} s for planning, flight and verdict, and {} threads.",
            results.limit_s, results.threads
        ),
        "verdict: of the plan and of its flight, all checks. wall s: planning. distr. s: sum over the iterations of the slowest \
         vehicle's time, as if every vehicle had a computer of its own; for serial-scp of all vehicles, which wait for each \
         other; for fleet-scp, which solves many subproblems at a time, by its share of the iterations."
            .to_owned(),
        "nodes, plan, flight m: smallest horizontal distance of two vehicles at the planner's nodes, on the continuous plan, in \
         flight. defect, rollout m: how far the plan's controls lead from it over one interval, and over the whole flight."
            .to_owned(),
        "coupled-scp, serial-scp, parallel-scp and dpd-scp are the papers' methods: trapezoid rule, rows at the nodes, the \
         parameters of Wang, Xu, Long (2020)."
            .to_owned(),
        "The paper (Xu et al. 2022, 3.4 GHz i7-6700, Matlab): dpd-scp plans 15 vehicles in 19 iterations, flight time 174.4 s, \
         and 100 across a circle in 26 iterations, 9.9 s distributed, flight time 209.8 s; the other three found nothing there."
            .to_owned(),
    ]
}
