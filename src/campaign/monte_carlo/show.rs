//! The results of a sweep on the terminal.

use super::{CheckStatistics, Dispersions, Statistics, Sweep};
use crate::number_format::{given, given_quantity, number, signed};
use crate::output::report::table;

/// Dispersions, pass rate, and the margins of every check.
pub fn text(sweep: &Sweep, statistics: &Statistics) -> String {
    let mut table = table::with_header(
        &["check", "failed", "smallest margin", "5 %", "median", "unit", "worst sample"],
        &[1, 2, 3, 4, 6],
    );
    // A check that counts events, of which there were none, needs no row.
    let is_idle = |check: &&CheckStatistics| check.failures == 0 && check.margins == Some([0.0; 3]);
    for check in statistics.checks.iter().filter(|check| !is_idle(check)) {
        table.add_row(row(check));
    }
    let Statistics { samples, passed, pass_share_95: [lower, upper], .. } = statistics;
    let pass_rate = 100.0 * *passed as f64 / (*samples).max(1) as f64;
    format!(
        "{}\n{} · {}: {}\npassed {passed} of {samples}, {pass_rate:.1} % (95 % confidence interval {:.1} % to {:.1} %)",
        table.trim_fmt(),
        sweep.scenario,
        sweep.planner,
        dispersions_line(&sweep.dispersions),
        100.0 * lower,
        100.0 * upper,
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

fn dispersions_line(dispersions: &Dispersions) -> String {
    let Dispersions { wind_mps, mass, noise_m, start_m } = *dispersions;
    let parts = [
        (wind_mps, format!("additional wind up to {}", given_quantity(wind_mps, "m/s"))),
        (mass, format!("mass error up to {} %", given(100.0 * mass))),
        (noise_m, format!("position noise up to {}", given_quantity(noise_m, "m"))),
        (start_m, format!("start error up to {}", given_quantity(start_m, "m"))),
    ];
    let parts: Vec<String> = parts.into_iter().filter(|(value, _)| *value > 0.0).map(|(_, text)| text).collect();
    if parts.is_empty() { "no perturbation but the seed".to_owned() } else { parts.join(", ") }
}
