//! The results as a table on the terminal and as a page in Markdown.

use super::measure::Measured;
use super::{Results, Row};
use crate::output::report::table;

const HEADER: [&str; 10] =
    ["subproblem", "rows", "solver", "its", "µs/it", "ms", "objective", "speed", "paper Gflop/it", "remark"];

/// Columns of numbers.
const NUMBERS: [usize; 7] = [1, 3, 4, 5, 6, 7, 8];

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
    format!("# Interior point on subproblems of {}\n\n{grid}\n{notes}", results.scenario)
}

fn rows(results: &Results) -> impl Iterator<Item = [String; HEADER.len()]> + '_ {
    results.rows.iter().enumerate().map(|(i, row)| {
        let is_first = i == 0 || results.rows[i - 1].shape != row.shape;
        cells(row, is_first)
    })
}

fn cells(row: &Row, is_first: bool) -> [String; HEADER.len()] {
    let once = |text: String| if is_first { text } else { String::new() };
    let measured = |form: fn(&Measured) -> String| row.measured.as_ref().map_or_else(String::new, form);
    [
        once(row.shape.clone()),
        once(row.planes.to_string()),
        row.solver.to_owned(),
        measured(|measured| measured.iterations.to_string()),
        measured(|measured| format!("{:.1}", measured.time_per_iteration_us)),
        measured(|measured| format!("{:.3}", 1e-3 * measured.time_us)),
        measured(|measured| format!("{:.6}", measured.objective)),
        row.speedup_vs_clarabel
            .map_or_else(String::new, |speedup| format!("{speedup:.*}", if speedup < 0.1 { 4 } else { 2 })),
        row.paper_flops.map_or_else(String::new, |flops| format!("{:.2}", 1e-9 * flops)),
        remark(row),
    ]
}

fn remark(row: &Row) -> String {
    match &row.measured {
        None => row.not_run.clone().unwrap_or_default(),
        Some(measured) if measured.status == "solved" => String::new(),
        Some(measured) => format!("{} at {:.1e}", measured.status, measured.gap),
    }
}

fn notes(results: &Results) -> [String; 4] {
    [
        format!(
            "subproblem: of a run on {}, with so many avoidance rows. Relative gap at the end: {:e}.",
            results.scenario, results.tolerance
        ),
        format!(
            "ms: best of up to {} solves after one to warm up, on one thread; work memory and symbolic analysis are kept \
             from solve to solve. block x4: four subproblems of one iteration in one pass, time per subproblem; block: \
             one alone, three lanes idle. sparse-ldl infeasible: the paper's loop from Mehrotra's start, whose residuals \
             vanish with the gap; the others keep every iterate feasible.",
            results.repetitions
        ),
        "speed: Clarabel's time over this one's.".to_owned(),
        "paper Gflop/it: Table 1 of Wang, Xu, Long (2020), drawn in ipm.svg as its figure 4. sparse-ldl is its method I, \
         0.33 n_X^3 + 3 n_A^3 + n_X^2 n_A + n_X n_A^2, a count for dense matrices, of which a sparse factorisation does a \
         small part; dense-reduced is its method II, 2.67 n_X^3 and the same further terms; dense-kkt its method III, \
         2.67 (n_X + 2 n_A)^3. II and III invert in the paper; here they are factored, n^3/3 and 2 n^3/3."
            .to_owned(),
    ]
}
