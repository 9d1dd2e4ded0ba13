//! The results as tables on the terminal and as a page in Markdown.

use super::{Mean, Results, Row};
use crate::metrics::PlanMetrics;
use crate::output::report::table;

const HEADER: [&str; 13] = [
    "mission",
    "N",
    "solver",
    "verdict",
    "its",
    "planning s",
    "flight s",
    "m/s",
    "std m/s",
    "std m",
    "sum n_x",
    "sum n_y",
    "sum n_z-1",
];

const MEANS: [&str; 5] = ["mission", "solver", "mean flight s", "mean planning s", "speed"];

/// Columns of numbers.
const NUMBERS: [usize; 10] = [1, 4, 5, 6, 7, 8, 9, 10, 11, 12];
const MEANS_NUMBERS: [usize; 3] = [2, 3, 4];

/// The tables on the terminal, with notes.
pub fn text(results: &Results) -> String {
    let mut rows = table::with_header(&HEADER, &NUMBERS);
    results.rows.iter().for_each(|row| {
        rows.add_row(cells(row));
    });
    let mut means = table::with_header(&MEANS, &MEANS_NUMBERS);
    results.means.iter().for_each(|mean| {
        means.add_row(mean_cells(mean));
    });
    format!("{}\n\n{}\n\n{}", rows.trim_fmt(), means.trim_fmt(), notes(results).join("\n"))
}

/// The same as a page in Markdown.
pub fn markdown(results: &Results) -> String {
    let mut page = String::from("# Fleets of one to seven\n\n");
    page.push_str(&table::markdown(&HEADER, &NUMBERS, results.rows.iter().map(cells)));
    page.push('\n');
    page.push_str(&table::markdown(&MEANS, &MEANS_NUMBERS, results.means.iter().map(mean_cells)));
    page.push('\n');
    notes(results).iter().for_each(|note| page.push_str(&format!("- {note}\n")));
    page
}

fn cells(row: &Row) -> [String; HEADER.len()] {
    let figure = |value: fn(&PlanMetrics) -> Option<f64>| number(row.metrics.as_ref().and_then(value), 2);
    [
        row.mission.clone(),
        row.vehicles.to_string(),
        row.solver.to_owned(),
        row.outcome.name().to_owned(),
        row.iterations.map_or_else(String::new, |iterations| iterations.to_string()),
        number(row.planning_s, 4),
        figure(|it| it.flight_time_s),
        figure(|it| it.mean_speed_mps),
        figure(|it| it.speed_std_mps),
        figure(|it| it.altitude_std_m),
        figure(|it| it.sum_abs_n_x),
        figure(|it| it.sum_abs_n_y),
        figure(|it| it.sum_abs_n_z_minus_1),
    ]
}

fn mean_cells(mean: &Mean) -> [String; MEANS.len()] {
    [
        mean.mission.clone(),
        mean.solver.to_owned(),
        number(mean.flight_time_s, 2),
        number(mean.planning_s, 4),
        number(mean.speedup, 2),
    ]
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(String::new, |value| format!("{value:.digits$}"))
}

fn notes(results: &Results) -> [String; 4] {
    [
        format!(
            "Planner parallel-scp with the paper's parameters, and decoupled-lgr, the decoupled pseudospectral planner. Each entry \
             had {} s for planning, flight and verdict, and {} threads. verdict: all checks, also between the nodes, of which \
             parallel-scp knows nothing.",
            results.limit_s, results.threads
        ),
        "m/s, std m/s, std m: mean speed, standard deviations of speed and altitude at the nodes, mean over the vehicles. sum: of \
         absolute values over all nodes of all vehicles; decoupled-lgr has several times as many. speed: Clarabel's planning time \
         over this one's, mean over the fleets."
            .to_owned(),
        "The paper, seven vehicles (2.9 GHz i5-2310, Matlab): rendezvous 3.0 s, flight time 256.63 s, 33.08 m/s, 1.49 m/s, \
         2.36 m, 3.66, 37.30, 0.97; its baseline SeDuMi 19.0 s, 232.86 s. Reconfiguration 2.4 s, 191.24 s, 36.08 m/s, \
         1.64 m/s, 0.34 m, 2.72, 18.60, 0.33; SeDuMi 13.1 s, 191.91 s."
            .to_owned(),
        "The paper, mean over one to seven: flight time 186.11 s (SeDuMi 179.67) and 188.67 s (187.34); its method is 7 and 6 \
         times as fast as SeDuMi. Its decoupled pseudospectral planner: mean planning time 100.7 and 111.0 s."
            .to_owned(),
    ]
}
