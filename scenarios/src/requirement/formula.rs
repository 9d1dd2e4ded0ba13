//! A formula whose names are resolved and whose dimensions agree.

use std::ops::Range;

use super::signals::{Quantity, SIGNALS};

/// A formula: quantifiers over vehicles, then a clause about the motion from its beginning.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    /// From the outermost inwards.
    pub quantifiers: Vec<Quantifier>,
    /// Names of the variables, in the order of the quantifiers.
    pub variables: Vec<String>,
    /// What is said of the vehicles.
    pub body: Clause,
    /// The predicates of the clause, by index.
    pub predicates: Vec<Predicate>,
}

/// A quantifier over vehicles. Several variables of one quantifier are different vehicles, in the order of the scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantifier {
    /// Whether the rest holds for all vehicles; otherwise for at least one.
    pub is_universal: bool,
    /// The indices of its variables.
    pub variables: Range<usize>,
}

/// A temporal clause.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the operators of signal temporal logic")]
pub enum Clause {
    Predicate(usize),
    Not(Box<Clause>),
    And(Box<Clause>, Box<Clause>),
    Or(Box<Clause>, Box<Clause>),
    Always(Window, Box<Clause>),
    Eventually(Window, Box<Clause>),
    /// The second holds at some time of the window, and the first from now until then.
    Until(Window, Box<Clause>, Box<Clause>),
}

/// An interval of time relative to now, both ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// Beginning, s, ≥ 0.
    pub from_s: f64,
    /// End, s; infinite for the rest of the motion.
    pub to_s: f64,
}

/// A comparison of two terms.
#[derive(Clone, Debug, PartialEq)]
pub struct Predicate {
    /// The two sides, SI units and radians.
    pub sides: [Term; 2],
    /// Whether the first side must be the larger one.
    pub is_greater: bool,
    /// Unit of its robustness.
    pub unit: &'static str,
    /// Size of that unit in SI units and radians.
    pub unit_size: f64,
    /// The bytes of the formula that it covers.
    pub span: Range<usize>,
    /// The bytes of its sides.
    pub side_spans: [Range<usize>; 2],
}

/// A real-valued function of time, SI units and radians.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the operations of arithmetic")]
pub enum Term {
    Constant(f64),
    /// Time since the beginning of the scenario.
    Time,
    /// Time until the judged motion ends.
    TimeLeft,
    Signal(Signal),
    Negate(Box<Term>),
    Absolute(Box<Term>),
    Add(Box<Term>, Box<Term>),
    Subtract(Box<Term>, Box<Term>),
    Multiply(Box<Term>, Box<Term>),
    Divide(Box<Term>, Box<Term>),
    Minimum(Box<Term>, Box<Term>),
    Maximum(Box<Term>, Box<Term>),
}

/// A quantity of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// What is measured.
    pub quantity: Quantity,
    /// Of whom.
    pub subject: Subject,
    /// Relative to what, for signals that have a target.
    pub target: Option<Target>,
}

/// A body that moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A vehicle, by its index in the scenario.
    Vehicle(usize),
    /// The vehicle that a variable stands for.
    Variable(usize),
    /// The load of the scenario's only vehicle.
    Load,
}

/// What a signal is relative to.
#[derive(Clone, Debug, PartialEq)]
pub enum Target {
    /// The goal of the subject.
    Goal,
    /// An obstacle, by its name.
    Obstacle(String),
    /// The nearest obstacle.
    AnyObstacle,
    /// Another body.
    Body(Subject),
    /// The nearest of the other vehicles.
    AnyVehicle,
    /// A point, m.
    Point([f64; 3]),
    /// A geofence, by its index.
    Geofence(usize),
    /// A direction in the plane, counterclockwise from east, rad.
    Bearing(f64),
}

impl Term {
    /// Calls `visit` with every signal of the term.
    pub fn each_signal(&self, visit: &mut dyn FnMut(&Signal)) {
        match self {
            Self::Constant(_) | Self::Time | Self::TimeLeft => {}
            Self::Signal(signal) => visit(signal),
            Self::Negate(a) | Self::Absolute(a) => a.each_signal(visit),
            Self::Add(a, b)
            | Self::Subtract(a, b)
            | Self::Multiply(a, b)
            | Self::Divide(a, b)
            | Self::Minimum(a, b)
            | Self::Maximum(a, b) => {
                a.each_signal(visit);
                b.each_signal(visit);
            }
        }
    }
}

impl Formula {
    /// Calls `visit` with every signal.
    pub fn each_signal(&self, visit: &mut dyn FnMut(&Signal)) {
        for side in self.predicates.iter().flat_map(|predicate| &predicate.sides) {
            side.each_signal(visit);
        }
    }

    /// The first signal that is known only at the samples of a flight log, by its name.
    pub fn logged_signal(&self) -> Option<&'static str> {
        let mut found = None;
        self.each_signal(&mut |signal| {
            let spec = SIGNALS.iter().find(|spec| spec.quantity == signal.quantity && spec.is_logged);
            found = found.or(spec.map(|spec| spec.name));
        });
        found
    }

    /// Whether a signal depends on velocities or accelerations.
    pub fn needs_velocities(&self) -> bool {
        use Quantity::{Acceleration, ClimbRate, FlightPath, GroundSpeed, HeadingFrom, Speed};
        let mut found = false;
        self.each_signal(&mut |signal| {
            found |=
                matches!(signal.quantity, ClimbRate | Speed | GroundSpeed | FlightPath | HeadingFrom | Acceleration);
        });
        found
    }
}
