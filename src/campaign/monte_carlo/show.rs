//! A sweep on the terminal.

use super::{CheckStatistics, Dispersions, Statistics, Sweep};
use crate::number_format::{given, given_quantity, number, signed};
use crate::output::report::table;

/// What was drawn, how many passed, and of every check how near it came to its limit.
pub fn text(sweep: &Sweep, statistics: &Statistics) -> String {
    let mut table = table::with_header(
        &["check", "red", "smallest margin", "5 %", "median", "unit", "worst sample"],
        &[1, 2, 3, 4, 6],
    );
    // Nothing was ever counted that should not be: no line for each.
    let is_idle = |check: &&CheckStatistics| check.failures == 0 && check.margins == Some([0.0; 3]);
    for check in statistics.checks.iter().filter(|check| !is_idle(check)) {
        table.add_row(row(check));
    }
    let Statistics { samples, passed, pass_share_95: [least, most], .. } = statistics;
    let share = 100.0 * *passed as f64 / (*samples).max(1) as f64;
    format!(
        "{}\n{} · {}: {}\npassed {passed} of {samples}, {share:.1} % (of endlessly many {:.1} % to {:.1} %, with 95 % confidence)",
        table.trim_fmt(),
        sweep.scenario,
        sweep.planner,
        drawn(&sweep.dispersions),
        100.0 * least,
        100.0 * most,
    )
}

fn row(check: &CheckStatistics) -> [String; 7] {
    let [smallest, low, median] = match check.margins {
        Some(margins) => margins.map(|margin| signed(margin, &check.unit)),
        None => [const { String::new() }; 3],
    };
    let worst = check.worst.map(|sample| sample.to_string()).unwrap_or_default();
    [check.name.clone(), number(check.failures as f64, "vehicles"), smallest, low, median, check.unit.clone(), worst]
}

fn drawn(dispersions: &Dispersions) -> String {
    let Dispersions { wind_mps, mass, noise_m, start_m } = *dispersions;
    let parts = [
        (wind_mps, format!("wind up to {} more", given_quantity(wind_mps, "m/s"))),
        (mass, format!("mass within {} %", given(100.0 * mass))),
        (noise_m, format!("noise of the position up to {}", given_quantity(noise_m, "m"))),
        (start_m, format!("start within {}", given_quantity(start_m, "m"))),
    ];
    let parts: Vec<String> = parts.into_iter().filter(|(value, _)| *value > 0.0).map(|(_, text)| text).collect();
    if parts.is_empty() { "only the seed differs".to_owned() } else { parts.join(", ") }
}
