//! Robustness over time, for plots.

use scenarios::Scenario;
use scenarios::requirement::{Clause, Formula, Quantifier, Requirement};
use sim::Flight;

use super::grid::Grid;
use super::instance::Instance;
use super::interval::Interval;
use super::scene::Scene;
use super::selections;
use crate::verdict::motion::Motion;

/// Number of intervals of time.
const CELLS: usize = 400;
/// With more selections of vehicles there is no curve: it would cost more than the verdict.
const MAX_SELECTIONS: usize = 64;

/// Lower bounds of a requirement's robustness at all times.
#[derive(Clone, Debug, PartialEq)]
pub struct RobustnessOverTime {
    /// Name of the requirement.
    pub name: String,
    /// Unit of the robustness; `-` if the formula compares quantities of several units.
    pub unit: &'static str,
    /// Times, s, and the smallest robustness from each time to the next one.
    pub points: Vec<(f64, f64)>,
}

/// The curves of all requirements on a flown motion.
///
/// Of `always A` and `eventually A` without an interval it is A that is shown, since the formula at a time looks at all that
/// follows. What holds for all vehicles is shown of the worst one at each time.
///
/// - `motions`: of the vehicles, in the order of the scenario, and of the load after them
pub fn robustness_over_time(scenario: &Scenario, motions: &[Motion], flight: &Flight) -> Vec<RobustnessOverTime> {
    let scene = Scene::new(scenario, motions, Some(flight));
    let curve = |requirement: Requirement| {
        let formula = requirement.formula(scenario).ok()?;
        let points = curve(&formula, &scene)?;
        let unit = formula.predicates[0].unit;
        let unit = if formula.predicates.iter().all(|it| it.unit == unit) { unit } else { "-" };
        Some(RobustnessOverTime { name: requirement.name, unit, points })
    };
    scenario.all_requirements().into_iter().filter_map(curve).collect()
}

/// `None` if nothing of it moves, or too many vehicles are selected.
fn curve(formula: &Formula, scene: &Scene<'_>) -> Option<Vec<(f64, f64)>> {
    let vehicles = scene.scenario.vehicles.len();
    let each = |quantifier: &Quantifier| selections(vehicles, quantifier.variables.len());
    let mut selected: Vec<Vec<usize>> = vec![Vec::new()];
    for quantifier in &formula.quantifiers {
        let chosen = each(quantifier);
        if selected.len() * chosen.len() > MAX_SELECTIONS {
            return None;
        }
        selected = selected.iter().flat_map(|before| chosen.iter().map(|next| [&before[..], next].concat())).collect();
    }
    // Of several quantifiers, one `for some` among them, no single vehicle is the worst.
    let is_universal = formula.quantifiers.iter().all(|it| it.is_universal);
    let is_existential = formula.quantifiers.iter().all(|it| !it.is_universal);
    if !(is_universal || is_existential) {
        return None;
    }
    let instances = selected.iter().filter_map(|assigned| Instance::new(formula, scene, assigned));
    let curves: Vec<Vec<(f64, Interval)>> = instances.map(|instance| of_instance(&instance)).collect();
    let end_s = curves.iter().filter_map(|curve| curve.last()).map(|(t_s, _)| *t_s).fold(0.0, f64::max);
    let at = |t_s: f64| {
        let values = curves.iter().filter_map(|curve| {
            let index = curve.partition_point(|(begin_s, _)| *begin_s <= t_s).checked_sub(1)?;
            Some(curve[index].1.min)
        });
        values.reduce(|a, b| if is_universal { a.min(b) } else { a.max(b) })
    };
    let times_s = (0..=CELLS).map(|index| end_s * index as f64 / CELLS as f64);
    Some(times_s.filter_map(|t_s| Some((t_s, at(t_s)?))).collect())
}

/// The bounds in each interval of time, by its beginning.
fn of_instance(instance: &Instance<'_>) -> Vec<(f64, Interval)> {
    Grid::new(instance, CELLS).bounds_over_time(without_outer_window(&instance.formula.body))
}

fn without_outer_window(clause: &Clause) -> &Clause {
    match clause {
        Clause::Always(window, inner) | Clause::Eventually(window, inner)
            if window.from_s == 0.0 && window.to_s.is_infinite() =>
        {
            without_outer_window(inner)
        }
        _ => clause,
    }
}
