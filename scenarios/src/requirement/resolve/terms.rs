//! Terms: arithmetic, functions, signals and what they are relative to.

use super::super::formula::{Signal, Subject, Target, Term};
use super::super::signals::{Quantity, SIGNALS, SignalSpec, TargetKind};
use super::super::syntax::{Kind, Node, Operator};
use super::super::units::Dimension;
use super::{Resolved, Resolver};
use crate::{Family, closest_name};

type Typed = (Term, Dimension);

impl Resolver<'_> {
    /// A term and its dimension.
    pub(super) fn term(&mut self, node: &Node) -> Resolved<Typed> {
        match &node.kind {
            Kind::Number(value, unit) => {
                let (size, dimension) = unit.map_or((1.0, Dimension::NUMBER), |unit| (unit.size, unit.dimension));
                Ok((Term::Constant(value * size), dimension))
            }
            Kind::Minus(inner) => {
                let (term, dimension) = self.term(inner)?;
                Ok((Term::Negate(term.into()), dimension))
            }
            Kind::Binary(operator, left, right) => self.arithmetic(node, *operator, [left, right]),
            Kind::Call(name, arguments) => self.call(node, name, arguments),
            _ => Err(self.error(node.span.clone(), "a quantity, not something true or false", "")),
        }
    }

    fn arithmetic(&mut self, node: &Node, operator: Operator, sides: [&Node; 2]) -> Resolved<Typed> {
        let combine: fn(Box<Term>, Box<Term>) -> Term = match operator {
            Operator::Add => Term::Add,
            Operator::Subtract => Term::Subtract,
            Operator::Multiply => Term::Multiply,
            Operator::Divide => Term::Divide,
            _ => return Err(self.error(node.span.clone(), "a quantity, not something true or false", "")),
        };
        let [(left, dimension), (right, other)] = [self.term(sides[0])?, self.term(sides[1])?];
        let dimension = match operator {
            Operator::Multiply => dimension.times(other),
            Operator::Divide => dimension.per(other),
            _ => self.same_dimension(sides, [dimension, other])?,
        };
        Ok((combine(left.into(), right.into()), dimension))
    }

    fn same_dimension(&self, sides: [&Node; 2], [dimension, other]: [Dimension; 2]) -> Resolved<Dimension> {
        if dimension == other {
            return Ok(dimension);
        }
        let remedy = format!("`{}` is {}", &self.text[sides[0].span.clone()], dimension.describe());
        Err(self.error(sides[1].span.clone(), dimension.describe(), remedy))
    }

    fn call(&mut self, node: &Node, name: &str, arguments: &[Node]) -> Resolved<Typed> {
        match (name, arguments) {
            ("time", []) => Ok((Term::Time, Dimension::TIME)),
            ("time_left", []) => Ok((Term::TimeLeft, Dimension::TIME)),
            ("abs", [inner]) => {
                let (term, dimension) = self.term(inner)?;
                Ok((Term::Absolute(term.into()), dimension))
            }
            ("min" | "max", [first, rest @ ..]) if !rest.is_empty() => {
                let combine = if name == "min" { Term::Minimum } else { Term::Maximum };
                let (mut term, dimension) = self.term(first)?;
                for other in rest {
                    let (next, own) = self.term(other)?;
                    self.same_dimension([first, other], [dimension, own])?;
                    term = combine(term.into(), next.into());
                }
                Ok((term, dimension))
            }
            ("abs" | "min" | "max", _) => {
                Err(self.error(node.span.clone(), "one argument of `abs`, at least two of `min` and `max`", ""))
            }
            _ => match SIGNALS.iter().find(|spec| spec.name == name) {
                Some(spec) => self.signal(node, spec, arguments),
                None => Err(self.unknown_signal(node, name)),
            },
        }
    }

    fn unknown_signal(&self, node: &Node, name: &str) -> super::FormulaError {
        let known = SIGNALS.iter().map(|spec| spec.name).chain(["time", "time_left", "abs", "min", "max"]);
        let remedy = match closest_name(name, known.clone()) {
            _ if name.contains('-') => "put spaces around a minus: without them it is part of the name".to_owned(),
            Some(known) => format!("did you mean `{known}`?"),
            None => format!("the signals are {}", known.collect::<Vec<_>>().join(", ")),
        };
        self.error(node.span.clone(), "a signal or a function", remedy)
    }

    fn signal(&mut self, node: &Node, spec: &SignalSpec, arguments: &[Node]) -> Resolved<Typed> {
        let (subject, target) = match (spec.target, arguments) {
            (TargetKind::None, []) => (None, None),
            (TargetKind::None, [subject]) => (Some(subject), None),
            (TargetKind::Place | TargetKind::Geofence | TargetKind::Bearing, [target]) => (None, Some(target)),
            (TargetKind::Place | TargetKind::Geofence | TargetKind::Bearing, [subject, target]) => {
                (Some(subject), Some(target))
            }
            (TargetKind::None, _) => {
                let expected = format!("`{0}` or `{0}(VEHICLE)`", spec.name);
                return Err(self.error(node.span.clone(), expected, ""));
            }
            _ => {
                let expected = format!("`{0}(TARGET)` or `{0}(VEHICLE, TARGET)`", spec.name);
                return Err(self.error(node.span.clone(), expected, ""));
            }
        };
        let subject = match subject {
            Some(subject) => self.subject(subject)?,
            None => {
                self.implied.get_or_insert(node.span.clone());
                Subject::Variable(0)
            }
        };
        let target = target.map(|target| self.target(target, spec.target)).transpose()?;
        if subject == Subject::Load && (target == Some(Target::Goal) || spec.is_logged || spec.name == "swing") {
            return Err(self.error(node.span.clone(), format!("`{}` of the vehicle, not of its load", spec.name), ""));
        }
        self.possible(node, spec.quantity, target.as_ref())?;
        Ok((Term::Signal(Signal { quantity: spec.quantity, subject, target }), spec.dimension))
    }

    /// Whether the scenario has what a signal needs.
    fn possible(&self, node: &Node, quantity: Quantity, target: Option<&Target>) -> Resolved<()> {
        let world = &self.scenario.world;
        let carries_load = self.scenario.family() == Family::SlungLoad;
        let missing = match quantity {
            Quantity::Height if world.ground_m.is_none() && world.terrain.is_none() => {
                "a scenario with `world.ground_m` or `world.terrain`"
            }
            Quantity::LoadFactor(_) if self.scenario.family() != Family::FixedWing => "a fixed wing",
            Quantity::Thrust if !carries_load => "a vehicle whose rotors are modelled: a quadrotor with a load",
            Quantity::Swing | Quantity::Tension if !carries_load => "a vehicle that carries a load",
            _ if target == Some(&Target::AnyObstacle) && self.obstacle_names().next().is_none() => {
                "a scenario with obstacles"
            }
            _ if target == Some(&Target::AnyVehicle) && self.scenario.vehicles.len() < 2 => {
                "a scenario with at least two vehicles"
            }
            _ => return Ok(()),
        };
        Err(self.error(node.span.clone(), missing, ""))
    }

    fn subject(&self, node: &Node) -> Resolved<Subject> {
        let known = match &node.kind {
            Kind::Call(name, arguments) if arguments.is_empty() => self.body(name),
            _ => None,
        };
        known.ok_or_else(|| {
            let vehicles = self.scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str());
            let names: Vec<&str> = self.variables.iter().map(String::as_str).chain(vehicles).collect();
            self.error(node.span.clone(), format!("a vehicle: {}", names.join(", ")), "")
        })
    }

    fn body(&self, name: &str) -> Option<Subject> {
        let variable = self.variables.iter().position(|it| it == name).map(Subject::Variable);
        let vehicle = || self.scenario.vehicles.iter().position(|it| it.name == name).map(Subject::Vehicle);
        let load = || (name == "load" && self.scenario.family() == Family::SlungLoad).then_some(Subject::Load);
        variable.or_else(vehicle).or_else(load)
    }

    fn target(&mut self, node: &Node, kind: TargetKind) -> Resolved<Target> {
        if kind == TargetKind::Bearing {
            let Kind::Number(value, Some(unit)) = node.kind else {
                return Err(self.error(node.span.clone(), "an angle such as `90 deg`", ""));
            };
            return Ok(Target::Bearing(value * unit.size));
        }
        let Kind::Call(name, arguments) = &node.kind else {
            return Err(self.error(node.span.clone(), "a name", ""));
        };
        if kind == TargetKind::Geofence {
            let fence = self.scenario.world.geofences.iter().position(|fence| fence.name == *name);
            let names = self.scenario.world.geofences.iter().map(|fence| fence.name.as_str()).collect::<Vec<_>>();
            let expected = || format!("a geofence of `world.geofences`: {}", names.join(", "));
            return fence.map(Target::Geofence).ok_or_else(|| self.error(node.span.clone(), expected(), ""));
        }
        self.place(node, name, arguments)
    }

    fn place(&self, node: &Node, name: &str, arguments: &[Node]) -> Resolved<Target> {
        match (name, arguments) {
            ("point", [x, y, z]) => Ok(Target::Point([self.length_m(x)?, self.length_m(y)?, self.length_m(z)?])),
            ("goal", []) => Ok(Target::Goal),
            ("obstacles", []) => Ok(Target::AnyObstacle),
            ("vehicles", []) => Ok(Target::AnyVehicle),
            (name, []) if self.obstacle_names().any(|it| it == name) => Ok(Target::Obstacle(name.to_owned())),
            (name, []) if self.body(name).is_some() => Ok(Target::Body(self.body(name).expect("a body"))),
            _ => {
                let vehicles = self.scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str());
                let remedy = closest_name(name, self.obstacle_names().chain(vehicles));
                let remedy = remedy.map_or_else(String::new, |known| format!("did you mean `{known}`?"));
                let expected = "an obstacle, a vehicle, `goal`, `obstacles`, `vehicles` or `point(1 m, 2 m, 3 m)`";
                Err(self.error(node.span.clone(), expected, remedy))
            }
        }
    }

    fn length_m(&self, node: &Node) -> Resolved<f64> {
        match &node.kind {
            Kind::Number(value, Some(unit)) if unit.dimension == Dimension::LENGTH => Ok(value * unit.size),
            Kind::Minus(inner) => self.length_m(inner).map(|value| -value),
            _ => Err(self.error(node.span.clone(), "a length such as `12.5 m`", "")),
        }
    }

    fn obstacle_names(&self) -> impl Iterator<Item = &str> {
        self.scenario.world.obstacle_names()
    }
}
