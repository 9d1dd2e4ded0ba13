//! A failure probability on the terminal.

use crate::campaign::probability::splitting::RunEnd;
use crate::campaign::probability::{Decision, FailureProbability, Likeliest, Method};
use crate::number_format::signed_quantity;
use crate::output::report::table;

/// Variance of the runs beyond which their moves are too short, as a multiple of that with perfect moves: about the 99.9 %
/// quantile of ten runs.
const SCATTERED: f64 = 3.0;

/// The runs, the estimate, the answer, the likeliest failure.
pub fn text(found: &FailureProbability) -> String {
    let mut lines = Vec::new();
    if found.method == Method::Splitting {
        lines.push(runs(found));
    }
    lines.push(estimate(found));
    lines.extend(answer(found));
    lines.extend(found.scatter.filter(|scatter| *scatter > SCATTERED).map(|scatter| {
        format!("note: the runs scatter {scatter:.1} times as much as with perfect moves; --moves {} would narrow the interval", 2 * found.moves)
    }));
    if let Some(nearest) = &found.likeliest {
        let fields =
            found.fields.iter().zip(&nearest.values).map(|(field, value)| format!("{} = {value:.6}", field.path));
        let seed = nearest.seed.map(|seed| format!("seed {seed}"));
        let place: Vec<String> = fields.chain(seed).collect();
        lines.push(format!("likeliest failure met: {}; {}", likeliest(nearest), place.join(", ")));
    }
    lines.push(counts(found));
    lines.join("\n")
}

fn runs(found: &FailureProbability) -> String {
    let mut table = table::with_header(&["run", "probability", "flights", "ended"], &[0, 1, 2]);
    for (index, run) in found.runs.iter().enumerate() {
        let below = if run.end == RunEnd::Failed { "" } else { "< " };
        let end = match run.end {
            RunEnd::Failed => "all particles fail",
            RunEnd::Rarer => "rarer than matters",
            RunEnd::OutOfFlights => "no flights left: -n",
            RunEnd::Stuck => "all particles have the same margin, which guides nowhere",
            RunEnd::Invalid => "nearly all draws are invalid scenarios",
        };
        let cells =
            [(index + 1).to_string(), format!("{below}{:.2e}", run.reached), run.flights.to_string(), end.to_owned()];
        table.add_row(cells);
    }
    table.trim_fmt()
}

fn estimate(found: &FailureProbability) -> String {
    let what = found.check.as_deref().unwrap_or("a check");
    let interval = found.interval;
    let confidence = 100.0 * found.confidence;
    let failure = format!("{} · {}: {what} fails with probability", found.scenario, found.planner);
    if interval.estimate > 0.0 {
        let range = format!("{:.2e} to {:.2e}", interval.lower, interval.upper);
        return format!("{failure} {:.2e} ({confidence} % confidence interval {range})", interval.estimate);
    }
    format!("{failure} below {:.2e} ({confidence} % confidence interval from 0); no failure was met", interval.upper)
}

fn answer(found: &FailureProbability) -> Option<String> {
    let at_most = found.at_most?;
    Some(match found.is_at_most? {
        Decision::Yes => format!("at most {at_most:e}: yes"),
        Decision::No => format!("at most {at_most:e}: no"),
        Decision::Undecided => {
            format!("at most {at_most:e}: undecided; --particles {} would halve the interval", 4 * found.particles)
        }
    })
}

/// The check, its margin, and how far the inputs are from their medians.
pub fn likeliest(found: &Likeliest) -> String {
    let check = found.finding.as_ref().map(|finding| {
        let margin = finding.margin.map(|margin| format!(" {}", signed_quantity(margin, &finding.unit)));
        format!("{}{}, ", finding.check, margin.unwrap_or_default())
    });
    format!("{}{:.2} standard deviations from the medians", check.unwrap_or_default(), found.distance)
}

/// What became of the draws, in one line.
pub fn counts(found: &FailureProbability) -> String {
    let FailureProbability { flights, rejected, no_plan, unanswered, .. } = found;
    let rest = [
        (*no_plan, "without a plan, which are no failures"),
        (*unanswered, "in which the check was skipped, which are no failures"),
    ];
    let rest: String = rest.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("; {n} {what}")).collect();
    let invalid = if *rejected > 0 { format!("; {rejected} draws were not valid scenarios") } else { String::new() };
    format!("{flights} flights{rest}{invalid}")
}
