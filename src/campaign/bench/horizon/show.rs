//! The results as a table on the terminal and as a page in Markdown.

use super::cases::{FPSO_ALL, FPSO_SKIP, PSO_ALL, PSO_SKIP};
use super::{Experiment, InLoop, Results, Row};
use crate::output::report::table;

const HEADER: [&str; 15] = [
    "experiment",
    "scenario",
    "case",
    "passed",
    "in limits",
    "flight s",
    "path m",
    "least clearance m",
    "mean clearance m",
    "replan ms (single replans)",
    "its",
    "first feasible",
    "feasible %",
    "empty %",
    "Stab m/s²",
];

/// Columns of numbers.
const NUMBERS: [usize; 12] = [3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14];

/// The table on the terminal, with notes.
pub fn text(results: &Results) -> String {
    let mut table = table::with_header(&HEADER, &NUMBERS);
    for row in &results.rows {
        table.add_row(cells(row, results.seeds));
    }
    format!("{}\n\n{}", table.trim_fmt(), notes(results).join("\n"))
}

/// The same as a page in Markdown.
pub fn markdown(results: &Results) -> String {
    let mut page = String::from("# Receding horizon\n\n");
    let rows = results.rows.iter().map(|row| cells(row, results.seeds));
    page.push_str(&table::markdown(&HEADER, &NUMBERS, rows));
    page.push('\n');
    notes(results).iter().for_each(|note| page.push_str(&format!("- {note}\n")));
    page
}

fn cells(row: &Row, seeds: u64) -> [String; HEADER.len()] {
    let in_loop = |form: fn(&InLoop) -> String| row.in_loop.as_ref().map_or_else(String::new, form);
    [
        row.experiment.name().to_owned(),
        row.scenario.clone(),
        row.case.to_owned(),
        format!("{}/{seeds}", row.passed),
        format!("{}/{seeds}", row.within_limits),
        number(row.flight_time_s),
        number(row.path_m),
        number(row.clearance_m),
        number(row.mean_clearance_m),
        in_loop(|it| {
            let [mean, min, max] =
                [it.replan_s[0], it.single_replan_s[0], it.single_replan_s[1]].map(|time_s| 1e3 * time_s);
            format!("{mean:.2} ({min:.2} .. {max:.2})")
        }),
        in_loop(|it| format!("{:.1}", it.iterations)),
        in_loop(|it| number(it.first_feasible)),
        in_loop(|it| it.feasible.map_or_else(String::new, |share| format!("{:.1}", 100.0 * share))),
        in_loop(|it| format!("{:.2}", 100.0 * it.empty)),
        in_loop(|it| format!("{:.2}", it.stability_mps2)),
    ]
}

fn number(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| format!("{value:.2}"))
}

fn notes(results: &Results) -> Vec<String> {
    let mut notes = vec![
        format!("Each row: {} flights in the simulator with a seed each, judged as any other; {} threads.", results.seeds, results.threads),
        "passed: every check. in limits: speed and acceleration as the judge sees them. flight s, path m: means of the flights \
         that passed. clearance: from the body to obstacles and frame, least of all flights and mean over time. sparse-astar, \
         rrt, rrt-star: paths of straight legs, timed by us with blended corners so that they keep the limits. As planned: at \
         the largest speed along the legs, turning at once at the corners, as the paper compares them; `in limits` shows which \
         planners respect the dynamics, and path m is of the flights that passed."
            .to_owned(),
        "replan ms: mean of all replans, then the shortest and the longest single one (the paper: FPSO 369.5 (310 .. 440), PSO 641.9 \
         (460 .. 800)). its: iterations per replan. first \
         feasible: first iteration with a feasible particle, from 0. feasible: share of all particles. empty: replans without any. Stab: eq. 22, norm over the \
         planned steps."
            .to_owned(),
        "Experiment 3 ends a search after 10 iterations without improvement; the others use all their iterations. Its rows with \
         and without the cost of infeasible particles are the same flights: that cost decides nothing."
            .to_owned(),
        "Experiment 5: rhc-fpso flies out of the pocket in every flight. On pop-up as shipped the cost map then leads it through a \
         slot of 1.25 m between the lower wall and block-10, wide enough for the map's clearance, in which a random swarm finds \
         hardly any feasible motion: most flights hover in front of it to the end. With the slot closed or 2.25 m wide they \
         arrive, and so they do without the mean cost-to-go over the horizon, which measures to the node behind the slot."
            .to_owned(),
    ];
    let mut scenarios: Vec<&str> = Vec::new();
    for row in results.rows.iter().filter(|row| row.experiment == Experiment::Swarms) {
        if !scenarios.contains(&row.scenario.as_str()) {
            scenarios.push(&row.scenario);
        }
    }
    notes.extend(scenarios.into_iter().filter_map(|scenario| savings(results, scenario)));
    notes
}

/// The paper's saving of 42 %, by its causes.
fn savings(results: &Results, scenario: &str) -> Option<String> {
    let replan_s = |case: &str| {
        let is_it = |row: &&Row| row.experiment == Experiment::Swarms && row.scenario == scenario && row.case == case;
        results.rows.iter().find(is_it)?.in_loop.as_ref().map(|it| it.replan_s[0])
    };
    let saved = |with: &str, without: &str| Some(100.0 * (1.0 - replan_s(with)? / replan_s(without)?));
    let whole = saved(FPSO_SKIP, PSO_ALL)?;
    let skipping = saved(PSO_SKIP, PSO_ALL)?;
    let [inertia, inertia_skipping] = [saved(FPSO_ALL, PSO_ALL)?, saved(FPSO_SKIP, PSO_SKIP)?];
    Some(format!(
        "{scenario}: FPSO that skips the cost of infeasible particles takes {whole:.1} % less time per replan than PSO that \
         computes all (the paper: 42.43 %). Of it, skipping alone saves {skipping:.1} %; eq. 15 alone {inertia:.1} %, and \
         {inertia_skipping:.1} % on top of skipping. Eq. 15 saves by the time to the first feasible particle, and costs by every \
         further feasible particle, which has to be charged."
    ))
}
