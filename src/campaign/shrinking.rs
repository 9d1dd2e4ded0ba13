//! The smallest scenario in which a check still fails.
//!
//! Elements (vehicles, obstacles) are removed, first many at once, then one by one (delta debugging: Zeller and Hildebrandt,
//! "Simplifying and isolating failure-inducing input", 2002); then settings of the simulation; then numbers are rounded. A
//! change is kept if the same check still fails. All this is repeated until nothing changes any more.

use serde::Serialize;

use crate::campaign::scenario_document::{FieldPath, ScenarioDocument};
use crate::campaign::trial::{Finding, TestSystem, Trial};

/// Tables whose numbers say what is asked or what flies, not what happens: they stay as they are.
const FIXED: [&str; 5] = ["models", "verdict", "planner", "fleet", "requirements"];
/// Keys that stay: without the seed it would be another experiment.
const FIXED_KEYS: [&str; 2] = ["seed", "step_s"];
/// Significant digits that are tried, from the simplest.
const DIGITS: [i32; 4] = [1, 2, 3, 4];

/// A scenario that fails, and what it took to find it.
#[derive(Clone, Debug, PartialEq)]
pub struct Shrunk {
    /// The smallest scenario.
    pub document: ScenarioDocument,
    /// What fails in it.
    pub finding: Finding,
    /// What was made simpler.
    pub counts: Counts,
}

/// What was made simpler.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Flights.
    pub flights: usize,
    /// Vehicles and obstacles that were removed.
    pub elements: usize,
    /// Settings that were removed.
    pub settings: usize,
    /// Numbers that have fewer digits.
    pub numbers: usize,
    /// Whether the flights were used up before nothing could be removed any more.
    pub is_cut_short: bool,
}

/// Shrinks a scenario.
///
/// - `first`: what fails in it
/// - `flights`: the most that may be spent
/// - `progress`: is called with the number of flights so far
pub fn shrink(
    document: &ScenarioDocument,
    first: &Finding,
    system: &TestSystem<'_>,
    flights: usize,
    progress: &mut dyn FnMut(usize),
) -> Shrunk {
    let asked = TestSystem { check: Some(&first.check), ..*system };
    shrink_with(document, first, &|document| asked.try_out(document), flights, progress)
}

fn shrink_with(
    document: &ScenarioDocument,
    first: &Finding,
    try_out: &dyn Fn(&ScenarioDocument) -> Trial,
    flights: usize,
    progress: &mut dyn FnMut(usize),
) -> Shrunk {
    let shrunk = Shrunk { document: document.clone(), finding: first.clone(), counts: Counts::default() };
    let mut shrinker = Shrinker { shrunk, try_out, flights, progress };
    while !shrinker.shrunk.counts.is_cut_short {
        let before = shrinker.shrunk.document.clone();
        shrinker.remove_elements();
        shrinker.remove_settings();
        shrinker.round_numbers();
        if shrinker.shrunk.document == before {
            break;
        }
    }
    shrinker.shrunk
}

struct Shrinker<'a> {
    shrunk: Shrunk,
    try_out: &'a dyn Fn(&ScenarioDocument) -> Trial,
    flights: usize,
    progress: &'a mut dyn FnMut(usize),
}

impl Shrinker<'_> {
    /// Keeps a simpler scenario if the check fails in it too. Returns whether it does.
    fn accepts(&mut self, simpler: ScenarioDocument) -> bool {
        if self.shrunk.counts.flights >= self.flights {
            self.shrunk.counts.is_cut_short = true;
            return false;
        }
        match (self.try_out)(&simpler) {
            Trial::Rejected => false,
            trial => {
                self.shrunk.counts.flights += 1;
                (self.progress)(self.shrunk.counts.flights);
                let Trial::Judged(finding) = trial else { return false };
                // A check that fails without a margin fails for want of something to measure: that is another failure.
                if finding.fails && finding.margin.is_some() == self.shrunk.finding.margin.is_some() {
                    (self.shrunk.document, self.shrunk.finding) = (simpler, finding);
                    return true;
                }
                false
            }
        }
    }

    /// Removes halves, quarters, ... and at last single elements.
    fn remove_elements(&mut self) {
        let mut size = self.shrunk.document.elements().len().div_ceil(2);
        while size > 0 {
            let mut from = 0;
            loop {
                let elements = self.shrunk.document.elements();
                let Some(group) = elements.get(from..(from + size).min(elements.len())).filter(|it| !it.is_empty())
                else {
                    break;
                };
                let mut simpler = self.shrunk.document.clone();
                // From the last to the first, so that the indices of the others stay.
                for path in group.iter().rev() {
                    simpler.remove(path);
                }
                if self.accepts(simpler) {
                    self.shrunk.counts.elements += elements.len() - self.shrunk.document.elements().len();
                } else {
                    from += size;
                }
            }
            size = if size == 1 { 0 } else { size.div_ceil(2) };
        }
    }

    /// Wind, gusts, noise, delays: whatever the scenario need not say.
    fn remove_settings(&mut self) {
        for table in ["simulation", "world"] {
            for path in self.shrunk.document.keys_below(table) {
                let mut simpler = self.shrunk.document.clone();
                if !is_fixed(&path) && simpler.remove(&path) && self.accepts(simpler) {
                    self.shrunk.counts.settings += 1;
                }
            }
        }
    }

    fn round_numbers(&mut self) {
        for (path, number) in self.shrunk.document.numbers() {
            if is_fixed(&path) {
                continue;
            }
            let simpler = DIGITS.iter().map(|digits| rounded(number, *digits)).take_while(|simpler| *simpler != number);
            for candidate in [0.0].into_iter().filter(|zero| *zero != number).chain(simpler) {
                let mut simpler = self.shrunk.document.clone();
                if simpler.set_number(&path, candidate) && self.accepts(simpler) {
                    self.shrunk.counts.numbers += 1;
                    break;
                }
            }
        }
    }
}

fn is_fixed(path: &FieldPath) -> bool {
    FIXED.iter().any(|table| path.is_below(table)) || path.last_key().is_some_and(|key| FIXED_KEYS.contains(&key))
}

/// The nearest number with so many significant digits.
fn rounded(number: f64, digits: i32) -> f64 {
    format!("{number:.*e}", digits as usize - 1).parse().unwrap_or(number)
}

#[cfg(test)]
mod tests {
    use scenarios::ScenarioFile;

    use super::{rounded, shrink_with};
    use crate::campaign::scenario_document::{FieldPath, ScenarioDocument};
    use crate::campaign::trial::{Finding, Trial};

    const TEXT: &str = "name = \"a\"\n[simulation]\nseed = 17\nnoise_m = 0.25\n[world]\nx_m = 3.14999\n\
        [[world.boxes]]\nname = \"a\"\n[[world.boxes]]\nname = \"b\"\n[[world.boxes]]\nname = \"c\"\n[[world.boxes]]\nname = \"d\"\n\
        [[world.boxes]]\nname = \"e\"\n";

    /// Fails if `b` and `e` are both there and x is above 3.05.
    fn needs_two_boxes(document: &ScenarioDocument) -> Trial {
        let text = document.text();
        let x_m = document.number(&FieldPath::parse("world.x_m").unwrap());
        let Some(x_m) = x_m else { return Trial::Rejected };
        Trial::Judged(Finding {
            fails: text.contains("\"b\"") && text.contains("\"e\"") && x_m > 3.05,
            check: "flight.clearance".to_owned(),
            margin: Some(-0.5),
            unit: "m".to_owned(),
            relative: -0.5,
            at_s: None,
            between: Vec::new(),
        })
    }

    #[test]
    fn what_is_not_needed_for_the_failure_goes() {
        let document = ScenarioDocument::of(&ScenarioFile::new("a.toml", TEXT));
        let Trial::Judged(first) = needs_two_boxes(&document) else { panic!("it is judged") };
        let shrunk = shrink_with(&document, &first, &needs_two_boxes, 200, &mut |_| {});
        let wanted = "name = \"a\"\n\n[simulation]\nseed = 17\n\n[world]\nx_m = 3.1\n\n[[world.boxes]]\nname = \"b\"\n\n[[world.boxes]]\nname = \"e\"\n";
        assert_eq!(shrunk.document.text(), wanted);
        let counts = shrunk.counts;
        assert_eq!((counts.elements, counts.settings, counts.numbers, counts.is_cut_short), (3, 1, 1, false));
        let short = shrink_with(&document, &first, &needs_two_boxes, 2, &mut |_| {});
        assert!(short.counts.is_cut_short && short.counts.flights == 2 && needs_two_boxes(&short.document).fails());
    }

    #[test]
    fn numbers_are_rounded_to_significant_digits() {
        assert_eq!([1, 2, 3].map(|digits| rounded(2.34567, digits)), [2.0, 2.3, 2.35]);
        assert_eq!([1, 2].map(|digits| rounded(-1250.0, digits)), [-1000.0, -1200.0]);
    }
}
