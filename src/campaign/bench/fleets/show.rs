//! The results as tables on the terminal and as a page in Markdown.

use super::{Mean, Measured, Results, Row};
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

const MEANS: [&str; 9] = ["scenario", "N", "planner", "solved", "passed", "its", "distr. s", "wall s", "flight s"];

const GROWTH: [&str; 7] =
    ["scenario", "N", "verdict", "its", "planning s", "µs per vehicle and iteration", "flight and verdict s"];

/// Columns of numbers.
const NUMBERS: [usize; 10] = [1, 4, 5, 6, 7, 8, 9, 10, 11, 12];
const MEANS_NUMBERS: [usize; 7] = [1, 3, 4, 5, 6, 7, 8];
const GROWTH_NUMBERS: [usize; 5] = [1, 3, 4, 5, 6];

/// The tables on the terminal, with notes.
pub fn text(results: &Results) -> String {
    let mut fleets = table::with_header(&HEADER, &NUMBERS);
    results.rows.iter().for_each(|row| {
        fleets.add_row(cells(row));
    });
    let mut growth = table::with_header(&GROWTH, &GROWTH_NUMBERS);
    results.growth.iter().for_each(|row| {
        growth.add_row(growth_cells(row));
    });
    let mut means = table::with_header(&MEANS, &MEANS_NUMBERS);
    results.means.iter().for_each(|mean| {
        means.add_row(mean_cells(mean));
    });
    let mut tables = vec![fleets.trim_fmt()];
    tables.extend(has_geometries(results).then(|| means.trim_fmt()));
    tables.extend((!results.growth.is_empty()).then(|| growth.trim_fmt()));
    format!("{}\n\n{}", tables.join("\n\n"), notes(results).join("\n"))
}

/// The same as a page in Markdown.
pub fn markdown(results: &Results) -> String {
    let mut page = String::from("# Ways to decouple a fleet\n\n");
    page.push_str(&table::markdown(&HEADER, &NUMBERS, results.rows.iter().map(cells)));
    if has_geometries(results) {
        page.push_str("\n## Means over the geometries\n\n");
        page.push_str(&table::markdown(&MEANS, &MEANS_NUMBERS, results.means.iter().map(mean_cells)));
    }
    if !results.growth.is_empty() {
        page.push_str("\n## Growth at constant density\n\n");
        page.push_str(&table::markdown(&GROWTH, &GROWTH_NUMBERS, results.growth.iter().map(growth_cells)));
    }
    page.push('\n');
    notes(results).iter().for_each(|note| page.push_str(&format!("- {note}\n")));
    page
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

/// Has any fleet more than one geometry?
fn has_geometries(results: &Results) -> bool {
    results.means.iter().any(|mean| mean.geometries > 1)
}

fn mean_cells(mean: &Mean) -> [String; MEANS.len()] {
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| format!("{value:.2}"));
    let of_all = |count: usize| format!("{count}/{}", mean.geometries);
    [
        mean.scenario.clone(),
        mean.vehicles.to_string(),
        mean.planner.to_owned(),
        of_all(mean.solved),
        of_all(mean.passed),
        mean.iterations.map_or_else(String::new, |iterations| format!("{iterations:.1}")),
        number(mean.distributed_s),
        number(mean.wall_s),
        number(mean.flight_time_s),
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

fn notes(results: &Results) -> [String; 6] {
    [
        format!(
            "N: the first N vehicles of the scenario. Each entry had {} s for planning, flight and verdict, and {} threads.",
            results.limit_s, results.threads
        ),
        "verdict: of the plan and of its flight, all checks. wall s: planning. distr. s: sum over the iterations of the slowest \
         vehicle's time, as if every vehicle had a computer of its own; for serial-scp of all vehicles, which wait for each \
         other; for fleet-scp, which solves many subproblems at a time, by its share of the iterations."
            .to_owned(),
        "solved, passed: geometries in which the planner calls its plan solved, and in which the judge passes plan and flight. \
         The other means are over the solved ones. Geometry 0 is the scenario; in the others every start is displaced by up to \
         100 m in x and in y, and the planner has another seed. A planner that reaches the time limit is not run again."
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
