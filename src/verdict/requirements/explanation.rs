//! Why a requirement failed, in words.

use std::ops::Range;

use scenarios::requirement::{Clause, Formula, Requirement, Term};

use crate::number_format::quantity;
use crate::verdict::requirements::grid::Robustness;
use crate::verdict::requirements::instance::Instance;

/// The formula, the clause that decides, the instant, the vehicles, the values there, and by how much it falls short.
pub fn explain(requirement: &Requirement, instance: &Instance<'_>, robustness: &Robustness) -> String {
    let text = |span: &Range<usize>| &requirement.formula[span.clone()];
    let formula = instance.formula;
    let decisive = &formula.predicates[robustness.predicate];
    let at_s = 0.5 * (robustness.cell[0] + robustness.cell[1]);
    let named = formula.variables.iter().zip(&instance.assigned);
    let variables: Vec<String> =
        named.map(|(name, &vehicle)| format!("{name} is {}", instance.scene.bodies[vehicle].name())).collect();
    let mut values: Vec<String> = Vec::new();
    for predicate in &formula.predicates {
        for (side, span) in predicate.sides.iter().zip(&predicate.side_spans) {
            let value =
                format!("{} is {}", text(span), value(instance, side, at_s, (predicate.unit, predicate.unit_size)));
            if !matches!(side, Term::Constant(_)) && !values.contains(&value) {
                values.push(value);
            }
        }
    }
    let who = (!variables.is_empty()).then(|| format!("where {}", variables.join(" and ")));
    let facts: Vec<String> = [format!("at {at_s:.2} s")].into_iter().chain(who).chain(values).collect();
    let short = quantity(-robustness.bounds.min, decisive.unit);
    let decision = match demanded(&formula.body, robustness.predicate).and_then(|clause| span(clause, formula)) {
        Some(demanded) => {
            let premise = text(&decisive.span);
            format!("`{premise}` holds by {short}, and there `{}` is demanded", text(&demanded))
        }
        None => format!("`{}` decides, short by {short}", text(&decisive.span)),
    };
    format!("{}: {}: {decision}", requirement.formula, facts.join(", "))
}

/// What an implication demands, if the predicate is its premise.
fn demanded(clause: &Clause, predicate: usize) -> Option<&Clause> {
    match clause {
        Clause::Or(premise, conclusion) => match &**premise {
            Clause::Not(inner) if matches!(**inner, Clause::Predicate(index) if index == predicate) => Some(conclusion),
            _ => demanded(premise, predicate).or_else(|| demanded(conclusion, predicate)),
        },
        Clause::And(a, b) | Clause::Until(_, a, b) => demanded(a, predicate).or_else(|| demanded(b, predicate)),
        Clause::Not(a) | Clause::Always(_, a) | Clause::Eventually(_, a) => demanded(a, predicate),
        Clause::Predicate(_) => None,
    }
}

/// From the first to the last predicate of a clause, in bytes of the formula; `None` if it looks into the future, whose operator is
/// not part of that.
fn span(clause: &Clause, formula: &Formula) -> Option<Range<usize>> {
    match clause {
        Clause::Predicate(index) => Some(formula.predicates[*index].span.clone()),
        Clause::And(a, b) | Clause::Or(a, b) => Some(span(a, formula)?.start..span(b, formula)?.end),
        Clause::Not(_) | Clause::Always(..) | Clause::Eventually(..) | Clause::Until(..) => None,
    }
}

fn value(instance: &Instance<'_>, side: &Term, at_s: f64, (unit, unit_size): (&'static str, f64)) -> String {
    let (bounds, _) = instance.bounds(side, [at_s, at_s]);
    quantity(0.5 * (bounds.min + bounds.max) / unit_size, unit)
}
