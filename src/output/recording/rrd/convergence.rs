//! Convergence of the planner: series on the timeline `planner_iter`, and the same as a table.

use std::fmt::Write;

use rerun::{RecordingStream, Scalars, SeriesLines, TextDocument, TimeColumn};
use scenarios::{Iteration, Plan};

use super::shapes::color;
use super::{Logged, entity};
use crate::number_format::number;
use crate::output::scene::{Paint, colours};

/// Timeline of the planner's iterations.
pub const PLANNER_ITER: &str = "planner_iter";

/// A series: group, name, value.
type Series = (&'static str, &'static str, fn(&Iteration) -> f64);

const SERIES: [Series; 7] = [
    ("objective", "objective [s]", |it| it.objective),
    ("residuals", "log10 of change [m]", |it| log10(it.change_m)),
    ("residuals", "log10 of trust region [m]", |it| log10(it.trust_region_m)),
    ("residuals", "log10 of defect [m]", |it| log10(it.defect_m)),
    ("residuals", "log10 of slack [-]", |it| log10(it.slack)),
    ("separation", "separation at the nodes [m]", |it| it.separation_m.unwrap_or(f64::NAN)),
    ("effort", "interior-point iterations", |it| it.solver_iterations as f64),
];

/// The groups and the titles of their views.
pub const GROUPS: [(&str, &str); 4] = [
    ("objective", "Objective (timeline planner_iter)"),
    ("residuals", "Change, trust region, defect, slack (timeline planner_iter)"),
    ("separation", "Smallest separation at the nodes (timeline planner_iter)"),
    ("effort", "Interior-point iterations (timeline planner_iter)"),
];

/// Logs the planner's history, if it has one.
pub fn log(stream: &RecordingStream, plan: &Plan) -> Logged {
    if plan.history.is_empty() {
        return Ok(());
    }
    for (index, (group, name, value)) in SERIES.into_iter().enumerate() {
        let (iterations, values): (Vec<i64>, Vec<f64>) =
            (1..).zip(plan.history.iter().map(value)).filter(|(_, v)| v.is_finite()).unzip();
        let path = entity(&format!("planner/{group}"), name);
        let colour = color(Paint::opaque(colours::vehicle(index, SERIES.len())));
        stream.log_static(
            path.clone(),
            &SeriesLines::new().with_names([name]).with_colors([colour]).with_widths([1.8]),
        )?;
        let times = TimeColumn::new_sequence(PLANNER_ITER, iterations);
        stream.send_columns(path, [times], Scalars::new(values).columns_of_unit_batches()?)?;
    }
    Ok(stream.log_static("convergence", &TextDocument::from_markdown(table(plan)))?)
}

fn table(plan: &Plan) -> String {
    let mut text = format!(
        "**{}: {} after {} iterations.** The same as curves: next tab, with the timeline `{PLANNER_ITER}` chosen at \
         the left of the time bar.\n\n| # | objective s | defect m | slack | separation m | change m | trust region m | solver it. |\n\
         |--:|--:|--:|--:|--:|--:|--:|--:|\n",
        plan.planner,
        plan.status,
        plan.history.len()
    );
    for (k, it) in plan.history.iter().enumerate() {
        let values = [Some(it.objective), Some(it.defect_m), Some(it.slack), it.separation_m];
        let values = values.into_iter().chain([Some(it.change_m), Some(it.trust_region_m)]);
        let cells: Vec<String> =
            values.map(|value| value.map_or_else(|| "–".to_owned(), |value| number(value, ""))).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(text, "| {} | {} | {} |", k + 1, cells.join(" | "), it.solver_iterations);
    }
    text
}

/// Values below 1e-12 are clipped, so that a zero stays in the plot.
fn log10(value: f64) -> f64 {
    value.max(1e-12).log10()
}
