//! From the text of a formula to its syntax tree. One function per level of precedence, the weakest first:
//!
//! ```text
//! implies < or < and < until < not, always, eventually, for < comparison < + - < * / < unary minus
//! ```

use winnow::ascii::{digit1, multispace0};
use winnow::combinator::{alt, cut_err, delimited, eof, not, opt, preceded, separated, terminated};
use winnow::error::{ContextError, StrContext, StrContextValue};
use winnow::prelude::*;
use winnow::stream::{LocatingSlice, Location};
use winnow::token::{literal, one_of, take_till, take_while};

use super::FormulaError;
use super::syntax::{Kind, Node, Operator};
use super::units::{UNITS, Unit};

type Input<'t> = LocatingSlice<&'t str>;
type Level = fn(&mut Input<'_>) -> ModalResult<Node>;
type Operators = fn(&mut Input<'_>) -> ModalResult<Operator>;

/// Longest formula, bytes, and deepest nesting of parentheses: the parser is recursive.
const MAX_LENGTH: usize = 2000;
const MAX_NESTING: usize = 32;
const OPERAND: &str = "a signal, a number with its unit, `(`, `not`, `always`, `eventually` or `for`";
const KEYWORDS: [&str; 11] =
    ["implies", "or", "and", "until", "not", "always", "eventually", "for", "all", "some", "pairs"];

/// The syntax tree of `text`.
pub(super) fn parse(text: &str) -> Result<Node, FormulaError> {
    if let Some(error) = too_complex(text) {
        return Err(error);
    }
    let end = eof.context(expected("an operator or the end of the formula"));
    let parsed = delimited(multispace0, implication, end).parse(LocatingSlice::new(text));
    parsed.map_err(|error| {
        let at = error.offset();
        let expected = error.inner().context().find_map(|context| match context {
            StrContext::Expected(StrContextValue::Description(what)) => Some((*what).to_owned()),
            StrContext::Expected(what) => Some(what.to_string()),
            _ => None,
        });
        FormulaError {
            span: at..text.len(),
            found: next_word(&text[at..]),
            expected: expected.unwrap_or_else(|| OPERAND.to_owned()),
            remedy: remedy(text, at),
        }
    })
}

/// What is usually meant by what cannot be read at `at`; empty if that is not known.
fn remedy(text: &str, at: usize) -> String {
    let rest = &text[at..];
    let word: String = rest.chars().take_while(|it| is_name(*it)).collect();
    // A keyword in upper case is read as a name, and what follows it is not understood.
    let before = text[..at].trim_end().rsplit(|it: char| !is_name(it)).next().unwrap_or_default();
    let keyword = [before, word.as_str()].into_iter().find_map(|it| {
        let lower = it.to_lowercase();
        (it != lower && KEYWORDS.contains(&lower.as_str())).then_some(lower)
    });
    if let Some(keyword) = keyword {
        format!("write `{keyword}`: keywords are in lower case")
    } else if rest.starts_with('=') {
        "no motion is exactly at a value: write `abs(a - b) < tolerance`".to_owned()
    } else if rest.starts_with(['<', '>', '≤', '≥']) {
        "compare two at a time: `a < b and b < c`".to_owned()
    } else if !word.is_empty() && text[..at].trim_end().ends_with(|it: char| it.is_ascii_digit()) {
        let units: Vec<&str> = UNITS.iter().map(|unit| unit.name).collect();
        format!("if `{word}` is meant as a unit: these are known: {}", units.join(", "))
    } else {
        String::new()
    }
}

fn too_complex(text: &str) -> Option<FormulaError> {
    let mut open = 0_usize;
    let deepest = text.chars().map(|c| {
        open = if c == '(' { open + 1 } else { open.saturating_sub(usize::from(c == ')')) };
        open
    });
    let is_deep = deepest.max().unwrap_or(0) > MAX_NESTING;
    (text.len() > MAX_LENGTH || is_deep).then(|| FormulaError {
        span: 0..text.len(),
        found: "a formula that is longer or more deeply nested".to_owned(),
        expected: format!("at most {MAX_LENGTH} characters and {MAX_NESTING} parentheses within each other"),
        remedy: "split it into several requirements".to_owned(),
    })
}

/// The next word of `rest`, for messages.
fn next_word(rest: &str) -> String {
    let end = rest.char_indices().skip(1).find(|(_, c)| !is_name(*c)).map_or(rest.len(), |(at, _)| at);
    if rest.is_empty() { "the end of the formula".to_owned() } else { format!("`{}`", &rest[..end]) }
}

fn implication(input: &mut Input<'_>) -> ModalResult<Node> {
    let left = disjunction(input)?;
    match opt(keyword("implies")).parse_next(input)? {
        Some(()) => Ok(Node::binary(Operator::Implies, left, operand(implication).parse_next(input)?)),
        None => Ok(left),
    }
}

fn disjunction(input: &mut Input<'_>) -> ModalResult<Node> {
    chain(input, conjunction, |input| keyword("or").value(Operator::Or).parse_next(input))
}

fn conjunction(input: &mut Input<'_>) -> ModalResult<Node> {
    chain(input, until, |input| keyword("and").value(Operator::And).parse_next(input))
}

fn until(input: &mut Input<'_>) -> ModalResult<Node> {
    let left = unary(input)?;
    if opt(keyword("until")).parse_next(input)?.is_none() {
        return Ok(left);
    }
    let window = opt(window).parse_next(input)?.map(Box::new);
    let right = operand(unary).parse_next(input)?;
    Ok(Node { span: left.span.start..right.span.end, kind: Kind::Until(window, left.into(), right.into()) })
}

fn unary(input: &mut Input<'_>) -> ModalResult<Node> {
    let begin = input.current_token_start();
    let is_negated = opt(keyword("not")).parse_next(input)?.is_some();
    if is_negated {
        let inner = operand(unary).parse_next(input)?;
        return Ok(Node { span: begin..inner.span.end, kind: Kind::Not(inner.into()) });
    }
    if opt(keyword("for")).parse_next(input)?.is_some() {
        return quantified(input, begin);
    }
    let operator = opt(alt((keyword("always").value(true), keyword("eventually").value(false)))).parse_next(input)?;
    let Some(is_always) = operator else { return comparison(input) };
    let window = opt(window).parse_next(input)?.map(Box::new);
    let inner = operand(unary).parse_next(input)?;
    let span = begin..inner.span.end;
    let kind = if is_always { Kind::Always(window, inner.into()) } else { Kind::Eventually(window, inner.into()) };
    Ok(Node { span, kind })
}

/// `all a:`, `all pairs a, b:`, `some a:`, and the rest of the formula.
fn quantified(input: &mut Input<'_>, begin: usize) -> ModalResult<Node> {
    let how = alt((keyword("all").value(true), keyword("some").value(false)));
    let is_universal = cut_err(how).context(expected("`all` or `some`")).parse_next(input)?;
    let pairs = opt(keyword("pairs")).parse_next(input)?;
    let name = || spaced(name).context(expected("the name of a variable"));
    let variables: Vec<String> = match pairs {
        Some(()) => {
            let second = preceded(symbol(",").context(expected("`,` and a second variable")), name());
            let (one, other) = cut_err((name(), second)).parse_next(input)?;
            vec![one, other]
        }
        None => cut_err(separated(1.., name(), symbol(","))).parse_next(input)?,
    };
    let colon = symbol(":").context(expected("`:` and a formula"));
    let body = cut_err(preceded(colon, operand(implication))).parse_next(input)?;
    let span = begin..body.span.end;
    Ok(Node { span, kind: Kind::Quantified { is_universal, variables, body: body.into() } })
}

/// `[0 s, 10 s]`
fn window(input: &mut Input<'_>) -> ModalResult<[Node; 2]> {
    let bound = |what| spaced(number).context(expected(what));
    let ends = (bound("a time such as `0 s`"), preceded(symbol(","), bound("a time such as `10 s`")));
    let inner = cut_err(terminated(ends, symbol("]"))).context(expected("an interval such as `[0 s, 10 s]`"));
    preceded(symbol("["), inner).map(|(from, to)| [from, to]).parse_next(input)
}

fn comparison(input: &mut Input<'_>) -> ModalResult<Node> {
    let left = sum(input)?;
    let greater = alt((symbol(">="), symbol("≥"), symbol(">"))).value(Operator::Greater);
    let less = alt((symbol("<="), symbol("≤"), symbol("<"))).value(Operator::Less);
    match opt(alt((greater, less))).parse_next(input)? {
        Some(operator) => Ok(Node::binary(operator, left, operand(sum).parse_next(input)?)),
        None => Ok(left),
    }
}

fn sum(input: &mut Input<'_>) -> ModalResult<Node> {
    let operators: Operators =
        |input| alt((symbol("+").value(Operator::Add), symbol("-").value(Operator::Subtract))).parse_next(input);
    chain(input, product, operators)
}

fn product(input: &mut Input<'_>) -> ModalResult<Node> {
    let operators: Operators =
        |input| alt((symbol("*").value(Operator::Multiply), symbol("/").value(Operator::Divide))).parse_next(input);
    chain(input, factor, operators)
}

fn factor(input: &mut Input<'_>) -> ModalResult<Node> {
    let begin = input.current_token_start();
    if opt(symbol("-")).parse_next(input)?.is_some() {
        let inner = operand(factor).parse_next(input)?;
        return Ok(Node { span: begin..inner.span.end, kind: Kind::Minus(inner.into()) });
    }
    alt((parentheses, spaced(number), call)).context(expected(OPERAND)).parse_next(input)
}

fn parentheses(input: &mut Input<'_>) -> ModalResult<Node> {
    let begin = input.current_token_start();
    symbol("(").parse_next(input)?;
    let inner = operand(implication).parse_next(input)?;
    cut_err(literal(")")).context(expected("an operator or `)`")).parse_next(input)?;
    let span = begin..input.current_token_start();
    multispace0.parse_next(input)?;
    Ok(Node { span, ..inner })
}

/// A name, and the arguments after it if there are any.
fn call(input: &mut Input<'_>) -> ModalResult<Node> {
    let begin = input.current_token_start();
    let (name, name_end) = (name, |input: &mut Input<'_>| Ok(input.current_token_start())).parse_next(input)?;
    multispace0.parse_next(input)?;
    if opt(symbol("(")).parse_next(input)?.is_none() {
        return Ok(Node { span: begin..name_end, kind: Kind::Call(name, Vec::new()) });
    }
    let arguments: Vec<Node> = separated(1.., operand(sum), symbol(",")).parse_next(input)?;
    cut_err(literal(")")).context(expected("`,` or `)`")).parse_next(input)?;
    let end = input.current_token_start();
    multispace0.parse_next(input)?;
    Ok(Node { span: begin..end, kind: Kind::Call(name, arguments) })
}

/// Left-associative operators over operands of the next level.
fn chain(input: &mut Input<'_>, level: Level, operators: Operators) -> ModalResult<Node> {
    let mut left = level(input)?;
    while let Some(operator) = opt(operators).parse_next(input)? {
        left = Node::binary(operator, left, operand(level).parse_next(input)?);
    }
    Ok(left)
}

/// What must follow.
fn operand<'t>(level: Level) -> impl ModalParser<Input<'t>, Node, ContextError> {
    cut_err(level).context(expected(OPERAND))
}

fn number(input: &mut Input<'_>) -> ModalResult<Node> {
    let fraction = opt((".", digit1));
    let exponent = opt((one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1));
    let begin = input.current_token_start();
    let value: f64 = (digit1, fraction, exponent).take().parse_to().parse_next(input)?;
    let unit = opt(preceded(multispace0, unit)).parse_next(input)?;
    Ok(Node { span: begin..input.current_token_start(), kind: Kind::Number(value, unit) })
}

fn unit(input: &mut Input<'_>) -> ModalResult<&'static Unit> {
    let found = UNITS.iter().find(|unit| {
        let rest = input.as_ref().strip_prefix(unit.name);
        rest.is_some_and(|rest| !rest.starts_with(is_name))
    });
    match found {
        Some(unit) => literal(unit.name).value(unit).parse_next(input),
        None => winnow::combinator::fail.parse_next(input),
    }
}

/// Letters, digits, `-` and `_`, a letter first; or anything in single quotes.
fn name(input: &mut Input<'_>) -> ModalResult<String> {
    let quoted = delimited("'", take_till(1.., '\''), "'");
    let plain = (one_of(|c: char| c.is_alphabetic()), take_while(0.., is_name)).take();
    let plain = plain.verify(|name: &str| !KEYWORDS.contains(&name));
    alt((quoted, plain)).map(str::to_owned).parse_next(input)
}

fn is_name(c: char) -> bool {
    c.is_alphanumeric() || c == '-' || c == '_'
}

fn keyword<'t>(word: &'static str) -> impl ModalParser<Input<'t>, (), ContextError> {
    spaced((literal(word), not(one_of(is_name))).void())
}

fn symbol<'t>(text: &'static str) -> impl ModalParser<Input<'t>, (), ContextError> {
    spaced(literal(text).void())
}

fn spaced<'t, O>(parser: impl ModalParser<Input<'t>, O, ContextError>) -> impl ModalParser<Input<'t>, O, ContextError> {
    terminated(parser, multispace0)
}

fn expected(what: &'static str) -> StrContext {
    StrContext::Expected(StrContextValue::Description(what))
}
