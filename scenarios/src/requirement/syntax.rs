//! The syntax tree of a formula: what was written, before names and dimensions are known.

use std::ops::Range;

use super::units::Unit;

/// A part of a formula and the bytes of the text that it covers.
#[derive(Clone, Debug)]
pub(super) struct Node {
    pub span: Range<usize>,
    pub kind: Kind,
}

/// What a node is.
#[derive(Clone, Debug)]
pub(super) enum Kind {
    /// A number with its unit.
    Number(f64, Option<&'static Unit>),
    /// A signal, a function or a name, with what stands in parentheses after it.
    Call(String, Vec<Node>),
    Minus(Box<Node>),
    Not(Box<Node>),
    Binary(Operator, Box<Node>, Box<Node>),
    Always(Option<Box<[Node; 2]>>, Box<Node>),
    Eventually(Option<Box<[Node; 2]>>, Box<Node>),
    Until(Option<Box<[Node; 2]>>, Box<Node>, Box<Node>),
    Quantified {
        is_universal: bool,
        variables: Vec<String>,
        body: Box<Node>,
    },
}

/// Operators with two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Operator {
    Implies,
    Or,
    And,
    Less,
    Greater,
    Add,
    Subtract,
    Multiply,
    Divide,
}

impl Node {
    /// A binary node over its operands.
    pub fn binary(operator: Operator, left: Self, right: Self) -> Self {
        let span = left.span.start..right.span.end;
        Self { span, kind: Kind::Binary(operator, left.into(), right.into()) }
    }
}
