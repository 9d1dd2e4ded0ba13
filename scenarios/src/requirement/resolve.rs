//! From the syntax tree to a formula: names are looked up in the scenario, dimensions are checked.

mod terms;

use std::ops::Range;

use super::FormulaError;
use super::formula::{Clause, Formula, Predicate, Quantifier, Window};
use super::syntax::{Kind, Node, Operator};
use super::units::Dimension;
use crate::Scenario;

type Resolved<T> = Result<T, FormulaError>;

/// The formula of a syntax tree.
pub(super) fn resolve(node: &Node, text: &str, scenario: &Scenario) -> Resolved<Formula> {
    let mut resolver = Resolver {
        text,
        scenario,
        variables: Vec::new(),
        quantifiers: Vec::new(),
        predicates: Vec::new(),
        implied: None,
    };
    let body = resolver.quantified(node)?;
    if let Some(span) = resolver.implied.clone() {
        if !resolver.quantifiers.is_empty() {
            let remedy = "name one of the variables in parentheses, as in `altitude(a)`";
            return Err(resolver.error(span, "a vehicle: with quantifiers, every signal names its own", remedy));
        }
        resolver.quantifiers.push(Quantifier { is_universal: true, variables: 0..1 });
        resolver.variables.push("the vehicle".to_owned());
    }
    let Resolver { variables, quantifiers, predicates, .. } = resolver;
    Ok(Formula { quantifiers, variables, body, predicates })
}

struct Resolver<'a> {
    text: &'a str,
    scenario: &'a Scenario,
    variables: Vec<String>,
    quantifiers: Vec<Quantifier>,
    predicates: Vec<Predicate>,
    /// The first signal without a vehicle: it is about every one.
    implied: Option<Range<usize>>,
}

impl Resolver<'_> {
    fn error(&self, span: Range<usize>, expected: impl Into<String>, remedy: impl Into<String>) -> FormulaError {
        let found = format!("`{}`", &self.text[span.clone()]);
        FormulaError { span, found, expected: expected.into(), remedy: remedy.into() }
    }

    /// The quantifiers at the beginning, and the clause after them.
    fn quantified(&mut self, node: &Node) -> Resolved<Clause> {
        let Kind::Quantified { is_universal, variables, body } = &node.kind else { return self.clause(node) };
        let first = self.variables.len();
        for name in variables {
            let is_taken = self.variables.contains(name) || self.scenario.vehicles.iter().any(|it| it.name == *name);
            if is_taken {
                let expected = format!("a variable other than `{name}`, which is taken");
                return Err(self.error(node.span.start..body.span.start, expected, ""));
            }
            self.variables.push(name.clone());
        }
        self.quantifiers.push(Quantifier { is_universal: *is_universal, variables: first..self.variables.len() });
        self.quantified(body)
    }

    fn clause(&mut self, node: &Node) -> Resolved<Clause> {
        match &node.kind {
            Kind::Not(inner) => Ok(Clause::Not(self.clause(inner)?.into())),
            Kind::Always(window, inner) => Ok(Clause::Always(self.window(window)?, self.clause(inner)?.into())),
            Kind::Eventually(window, inner) => Ok(Clause::Eventually(self.window(window)?, self.clause(inner)?.into())),
            Kind::Until(window, first, second) => {
                Ok(Clause::Until(self.window(window)?, self.clause(first)?.into(), self.clause(second)?.into()))
            }
            Kind::Binary(operator, left, right) => self.binary(node, *operator, [left, right]),
            Kind::Quantified { .. } => {
                let remedy = "move it to the front: `for all a: always ...`";
                Err(self.error(node.span.clone(), "quantifiers only at the beginning of the formula", remedy))
            }
            Kind::Number(..) | Kind::Call(..) | Kind::Minus(_) => Err(self.not_a_clause(node)),
        }
    }

    fn binary(&mut self, node: &Node, operator: Operator, [left, right]: [&Node; 2]) -> Resolved<Clause> {
        match operator {
            Operator::And => Ok(Clause::And(self.clause(left)?.into(), self.clause(right)?.into())),
            Operator::Or => Ok(Clause::Or(self.clause(left)?.into(), self.clause(right)?.into())),
            Operator::Implies => {
                let premise = Clause::Not(self.clause(left)?.into());
                Ok(Clause::Or(premise.into(), self.clause(right)?.into()))
            }
            Operator::Less | Operator::Greater => self.predicate(node, operator == Operator::Greater, [left, right]),
            Operator::Add | Operator::Subtract | Operator::Multiply | Operator::Divide => Err(self.not_a_clause(node)),
        }
    }

    fn not_a_clause(&self, node: &Node) -> FormulaError {
        self.error(node.span.clone(), "something that is true or false", "compare it: `... > 50 m`")
    }

    fn predicate(&mut self, node: &Node, is_greater: bool, sides: [&Node; 2]) -> Resolved<Clause> {
        let [(left, dimension), (right, other)] = [self.term(sides[0])?, self.term(sides[1])?];
        if dimension != other {
            let remedy = format!("`{}` is {}", &self.text[sides[0].span.clone()], dimension.describe());
            return Err(self.error(sides[1].span.clone(), dimension.describe(), remedy));
        }
        let Some((unit, unit_size)) = dimension.display_unit() else {
            let expected = "a comparison of lengths, times, speeds, accelerations, angles, forces or numbers";
            return Err(self.error(node.span.clone(), expected, ""));
        };
        let (sides, side_spans) = ([left, right], sides.map(|side| side.span.clone()));
        self.predicates.push(Predicate { sides, is_greater, unit, unit_size, span: node.span.clone(), side_spans });
        Ok(Clause::Predicate(self.predicates.len() - 1))
    }

    fn window(&self, window: &Option<Box<[Node; 2]>>) -> Resolved<Window> {
        let Some(ends) = window else { return Ok(Window { from_s: 0.0, to_s: f64::INFINITY }) };
        let time = |node: &Node| match node.kind {
            Kind::Number(value, Some(unit)) if unit.dimension == Dimension::TIME => Ok(value * unit.size),
            _ => Err(self.error(node.span.clone(), "a time with its unit, as `10 s`", "")),
        };
        let [from_s, to_s] = [time(&ends[0])?, time(&ends[1])?];
        if from_s > to_s {
            let span = ends[0].span.start..ends[1].span.end;
            return Err(self.error(span, "an interval whose end is not before its beginning", ""));
        }
        Ok(Window { from_s, to_s })
    }
}
