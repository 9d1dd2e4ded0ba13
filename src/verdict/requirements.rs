//! Requirements of the scenario: formulas of signal temporal logic over the planned and the flown motion.
//!
//! Their value is the space robustness at the beginning of the motion [Donzé, Maler 2010]: how far the decisive signal is
//! from where the formula would change its truth. It is bounded for all times, not only at samples (`grid`), from bounds of
//! the motions (`body`) by interval arithmetic (`interval`, `signal`). Quantities of the flight log hold from one sample to the
//! next.

mod body;
mod explanation;
mod grid;
mod instance;
mod interval;
mod over_time;
mod scene;
mod signal;
#[cfg(test)]
mod tests;

use rayon::prelude::*;
use scenarios::requirement::{Formula, Requirement};
use scenarios::{CheckSpec, Group, REQUIREMENT_CHECKS, Scenario};
use sim::Flight;

use crate::verdict::case::{Case, PLANNED_IN_LOOP};
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::motion::Motion;
use crate::verdict::{Check, Status};
use grid::Robustness;
use instance::Instance;
use scene::Scene;

pub use over_time::{RobustnessOverTime, robustness_over_time};

/// Inserts the checks of all requirements, in the order of a verdict.
///
/// - `planned`, `flown`: the motions of the vehicles, in the order of the scenario, and of the load after them
pub fn insert(
    checks: &mut Vec<Check>,
    case: &Case<'_>,
    planned: Evidence<'_, [Motion]>,
    flown: Evidence<'_, [Motion]>,
) {
    let end_of_plan = checks.iter().position(|check| check.name.starts_with("flight.")).unwrap_or(checks.len());
    let [of_plan, of_flight] = &REQUIREMENT_CHECKS;
    let planned_in_loop = case.is_planned_in_loop().then_some(PLANNED_IN_LOOP);
    let mut planned = of_group(of_plan, case.scenario, planned, None, planned_in_loop);
    let mut flown = of_group(of_flight, case.scenario, flown, case.flight().ok(), None);
    for requirement in &case.scenario.all_requirements() {
        require_answer(requirement, planned.iter_mut().chain(&mut flown));
    }
    checks.extend(flown);
    drop(checks.splice(end_of_plan..end_of_plan, planned));
}

/// Appends the checks of the requirements on a flight that was flown elsewhere. Requirements on the plan alone are not asked.
pub fn append_recorded(checks: &mut Vec<Check>, scenario: &Scenario, flown: Evidence<'_, [Motion]>) {
    let mut flown = of_group(&REQUIREMENT_CHECKS[1], scenario, flown, None, None);
    let requirements = scenario.all_requirements();
    let asked = requirements.iter().filter(|it| it.applies_to.covers(Group::Flight));
    asked.for_each(|requirement| require_answer(requirement, flown.iter_mut()));
    checks.extend(flown);
}

/// A requirement that neither plan nor flight answers is not kept: its first check fails.
fn require_answer<'a>(requirement: &Requirement, checks: impl Iterator<Item = &'a mut Check>) {
    let names = REQUIREMENT_CHECKS.map(|spec| format!("{}.{}", spec.name, requirement.name));
    let mut own: Vec<&mut Check> = checks.filter(|check| names.contains(&check.name)).collect();
    if own.iter().all(|check| check.status == Status::Skip)
        && let Some(first) = own.first_mut()
    {
        let why = first.reason.take().unwrap_or_default();
        first.reason = Some(format!("nothing answers this requirement: {why}"));
        first.status = Status::Fail;
    }
}

/// - `flight`: the simulator's log, of a flight that it flew
/// - `skipped`: why none is asked
fn of_group(
    spec: &CheckSpec,
    scenario: &Scenario,
    motions: Evidence<'_, [Motion]>,
    flight: Option<&Flight>,
    skipped: Option<&str>,
) -> Vec<Check> {
    let mut asked = scenario.all_requirements();
    asked.retain(|it| it.applies_to.covers(spec.group));
    if asked.is_empty() {
        return Vec::new();
    }
    let scene = motions.map(|motions| Scene::new(scenario, motions, flight));
    let is_reconstructed = motions.is_ok_and(|motions| motions.iter().any(Motion::is_reconstructed));
    let named = |requirement: &Requirement| {
        let check = if let Some(reason) = skipped {
            spec.skip(reason)
        } else {
            let made = scene.as_ref().map_err(|missing| (*missing).clone());
            let made = made.and_then(|scene| check(spec, requirement, scene, is_reconstructed));
            made.unwrap_or_else(|missing| spec.fail(missing))
        };
        Check { name: format!("{}.{}", spec.name, requirement.name), ..check }
    };
    asked.par_iter().map(named).collect()
}

fn check(spec: &CheckSpec, requirement: &Requirement, scene: &Scene<'_>, is_reconstructed: bool) -> CheckResult {
    let formula = match requirement.formula(scene.scenario) {
        Ok(formula) => formula,
        Err(error) => return Ok(spec.fail(format_args!("the formula cannot be evaluated: {error}"))),
    };
    if let Some(signal) = formula.logged_signal().filter(|_| !scene.is_logged()) {
        return Ok(spec.skip(format_args!("{signal} is known at the samples of the simulator's flight log only")));
    }
    if is_reconstructed && formula.needs_velocities() {
        let reason = "the motion is known at its rows only: its velocities between them are not bounded";
        return Ok(Check { status: Status::Undecided, ..spec.skip(reason) });
    }
    let Some(decisive) = smallest(&formula, scene) else {
        return Ok(spec.fail("the scenario has fewer vehicles than the formula speaks of, or none at the same time"));
    };
    Ok(decided(spec, requirement, &decisive))
}

/// The check of the robustness found.
fn decided(spec: &CheckSpec, requirement: &Requirement, decisive: &Decisive<'_>) -> Check {
    let Decisive { instance, robustness } = decisive;
    let predicate = &instance.formula.predicates[robustness.predicate];
    let at_s = 0.5 * (robustness.cell[0] + robustness.cell[1]);
    let spec = CheckSpec { unit: predicate.unit, ..*spec };
    if robustness.bounds.min.is_infinite() && robustness.bounds.max == robustness.bounds.min {
        return spec.fail("the motion ends before the interval of the formula begins, so that no signal decides");
    }
    let measured = Measurement::bounds(robustness.bounds.min, robustness.bounds.max).at(at_s);
    let measured = instance.concerned(predicate).iter().fold(measured, |measured, name| measured.with(name));
    let mut check = spec.at_least(measured, 0.0);
    if check.is_bad() {
        let mut why = explanation::explain(requirement, instance, robustness);
        if check.status == Status::Undecided && robustness.is_cut_short {
            why = format!("the search for closer bounds was ended after its longest duration; {why}");
        }
        check.reason =
            Some(check.reason.take().filter(|it| !it.is_empty()).map_or(why.clone(), |it| format!("{it}; {why}")));
    }
    check
}

/// An instance of a formula, and its robustness.
struct Decisive<'a> {
    instance: Instance<'a>,
    robustness: Robustness,
}

/// The robustness over all vehicles that the quantifiers range over; `None` if there are none.
fn smallest<'a>(formula: &'a Formula, scene: &'a Scene<'a>) -> Option<Decisive<'a>> {
    quantified(formula, scene, &mut Vec::new(), 0, f64::INFINITY)
}

/// - `assigned`: the vehicles of the variables of the quantifiers before `depth`
/// - `beat`: the smallest robustness known so far
fn quantified<'a>(
    formula: &'a Formula,
    scene: &'a Scene<'a>,
    assigned: &mut Vec<usize>,
    depth: usize,
    beat: f64,
) -> Option<Decisive<'a>> {
    let Some(quantifier) = formula.quantifiers.get(depth) else {
        let instance = Instance::new(formula, scene, assigned)?;
        let robustness = grid::robustness(&instance, beat);
        return Some(Decisive { instance, robustness });
    };
    let mut found: Option<Decisive<'a>> = None;
    for chosen in selections(scene.scenario.vehicles.len(), quantifier.variables.len()) {
        let before = assigned.len();
        assigned.extend(chosen);
        let known = found.as_ref().map(|found| found.robustness.bounds);
        // Of several that must all hold, one that is certainly not the worst need not be known better.
        let beat =
            if quantifier.is_universal { known.map_or(beat, |known| beat.min(known.max)) } else { f64::INFINITY };
        let next = quantified(formula, scene, assigned, depth + 1, beat);
        assigned.truncate(before);
        found = combined(quantifier.is_universal, found, next);
    }
    found
}

/// The worse of two for all, the better of two for some; bounds as those of the smaller and of the larger number.
fn combined<'a>(is_universal: bool, a: Option<Decisive<'a>>, b: Option<Decisive<'a>>) -> Option<Decisive<'a>> {
    let (Some(a), Some(b)) = (&a, &b) else { return a.or(b) };
    let [one, other] = [a.robustness.bounds, b.robustness.bounds];
    let bounds = if is_universal { one.minimum(other) } else { one.maximum(other) };
    let is_first = if is_universal { one.min <= other.min } else { one.min >= other.min };
    let of = |it: &Decisive<'a>| Decisive {
        instance: it.instance.clone(),
        robustness: Robustness { bounds, ..it.robustness.clone() },
    };
    Some(if is_first { of(a) } else { of(b) })
}

/// All selections of `count` of `n` vehicles, in their order.
fn selections(n: usize, count: usize) -> Vec<Vec<usize>> {
    let mut all: Vec<Vec<usize>> = vec![Vec::new()];
    for _ in 0..count {
        let longer = |chosen: &Vec<usize>| {
            let first = chosen.last().map_or(0, |last| last + 1);
            (first..n).map(|next| chosen.iter().copied().chain([next]).collect()).collect::<Vec<Vec<usize>>>()
        };
        all = all.iter().flat_map(longer).collect();
    }
    all
}
