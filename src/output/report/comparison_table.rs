//! A comparison of two runs as a table, for the terminal and for `summary.md`.

use anstyle::{AnsiColor, Style};
use comfy_table::{Cell, Color};

use super::table;
use crate::campaign::comparison::{Comparison, Difference, Severity};

/// Largest number of rows; the others are counted.
const MAX_ROWS: usize = 200;

/// For the terminal: a table, and a line with counts.
pub fn text(comparison: &Comparison) -> String {
    let color = if comparison.is_good() { AnsiColor::Green } else { AnsiColor::Red };
    let style = Style::new().bold().fg_color(Some(color.into()));
    let counts = format!("{style}{}{style:#}", comparison.counts_line());
    if comparison.differences.is_empty() {
        return counts;
    }
    let mut table = table::with_header(&["", "result", "what", "old", "new", "change"], &[3, 4]);
    table.enforce_styling();
    for difference in comparison.differences.iter().take(MAX_ROWS) {
        let Difference { rating, what, old, new, change, .. } = difference;
        let (word, color) = rated(*rating);
        table.add_row([
            Cell::new(word).fg(color),
            Cell::new(result(difference)),
            Cell::new(what),
            Cell::new(old),
            Cell::new(new),
            Cell::new(change),
        ]);
    }
    let more = comparison.differences.len().saturating_sub(MAX_ROWS);
    let more = if more > 0 { format!("\n{more} more") } else { String::new() };
    format!("{}{more}\n{counts}", table.trim_fmt())
}

/// A section of `summary.md`.
pub fn markdown(comparison: &Comparison) -> String {
    let mut lines = vec![format!("## Against the baseline: {}", comparison.counts_line()), String::new()];
    if !comparison.differences.is_empty() {
        lines.push("| | result | what | old | new | change |".into());
        lines.push("|---|---|---|---:|---:|---|".into());
    }
    let row = |difference: &Difference| {
        let Difference { rating, what, old, new, change, .. } = difference;
        format!("| {} | {} | {what} | {old} | {new} | {change} |", rated(*rating).0, result(difference))
    };
    lines.extend(comparison.differences.iter().take(MAX_ROWS).map(row));
    lines.join("\n") + "\n"
}

fn rated(rating: Severity) -> (&'static str, Color) {
    match rating {
        Severity::Worse => ("worse", Color::Red),
        Severity::Better => ("better", Color::Green),
        Severity::Note => ("note", Color::Yellow),
    }
}

fn result(difference: &Difference) -> String {
    format!("{} · {}", difference.scenario, difference.planner)
}
