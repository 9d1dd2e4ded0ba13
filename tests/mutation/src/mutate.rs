//! Finds what can be mutated in a source file, and writes the file with every mutant in it behind a switch.
//!
//! A mutated expression becomes `(if crate::mutant::is(7) { a >= b } else { a < b })`: one build holds all mutants, and a
//! variable of the environment chooses one.

use std::ops::Range;

use proc_macro2::Span;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};
use syn::{
    Attribute, BinOp, Block, Expr, ExprBinary, ExprMethodCall, ExprUnary, Meta, ReturnType, Signature, Type, UnOp,
};

/// A change of the source.
#[derive(Clone, Debug)]
pub struct Mutant {
    /// Line, from 1.
    pub line: usize,
    /// Bytes that are replaced; empty for a statement at the beginning of a function.
    range: Range<usize>,
    /// What stands there instead.
    replacement: String,
    /// For people: ``replace `<` with `>=` ``.
    pub description: String,
}

impl Mutant {
    /// Whether it differs only where two numbers are equal, as `<` and `<=` do.
    pub fn is_boundary(&self) -> bool {
        ["`<` with `<=`", "`<=` with `<`", "`>` with `>=`", "`>=` with `>`"]
            .iter()
            .any(|end| self.description.ends_with(end))
    }
}

/// All mutants of a file, in the order of the source.
///
/// # Errors
///
/// The text is not Rust.
pub fn mutants(text: &str) -> syn::Result<Vec<Mutant>> {
    let file = syn::parse_file(text)?;
    let mut finder = Finder { text, found: Vec::new() };
    finder.visit_file(&file);
    finder.found.sort_by_key(|mutant| (mutant.range.start, std::cmp::Reverse(mutant.range.end)));
    Ok(finder.found)
}

/// A file with mutants in it.
#[derive(Debug, Default)]
pub struct Rendered {
    /// The source.
    pub text: String,
    /// Which bytes belong to which mutants: switches with their replacements, and whole expressions with all their mutants.
    places: Vec<(Range<usize>, Vec<usize>)>,
}

impl Rendered {
    /// The file with these mutants, each with its number, in the order of [`mutants`].
    pub fn new(text: &str, mutants: &[(usize, &Mutant)]) -> Self {
        let mut rendered = Self::default();
        rendered.emit(text, 0..text.len(), mutants);
        rendered
    }

    /// The mutants that most closely enclose a part of the text.
    pub fn enclosing(&self, part: &Range<usize>) -> &[usize] {
        let encloses = |(range, _): &&(Range<usize>, Vec<usize>)| range.start <= part.start && part.end <= range.end;
        self.places.iter().filter(encloses).min_by_key(|(range, _)| range.len()).map_or(&[], |(_, ids)| ids)
    }

    /// Writes a part of the source. `mutants` are those within it, outer ones first.
    fn emit(&mut self, text: &str, part: Range<usize>, mutants: &[(usize, &Mutant)]) {
        let mut at = part.start;
        let mut next = 0;
        while let Some((_, mutant)) = mutants.get(next) {
            let range = &mutant.range;
            self.text.push_str(&text[at..range.start]);
            at = range.end;
            let alike = mutants[next..].iter().take_while(|(_, other)| other.range == *range).count();
            let (here, rest) = mutants[next..].split_at(alike);
            next += alike;
            if range.is_empty() {
                here.iter().for_each(|mutant| self.switch(mutant));
                continue;
            }
            let inner = rest.iter().take_while(|(_, other)| other.range.end <= range.end).count();
            next += inner;
            let begin = self.text.len();
            self.text.push('(');
            for mutant in here {
                self.switch(mutant);
                self.text.push_str(" else ");
            }
            self.text.push('{');
            self.emit(text, range.clone(), &rest[..inner]);
            self.text.push_str("})");
            self.places.push((begin..self.text.len(), here.iter().map(|(id, _)| *id).collect()));
        }
        self.text.push_str(&text[at..part.end]);
    }

    fn switch(&mut self, (id, mutant): &(usize, &Mutant)) {
        let begin = self.text.len();
        self.text.push_str(&format!("if crate::mutant::is({id}) {{{}}}", mutant.replacement));
        self.places.push((begin..self.text.len(), vec![*id]));
    }
}

struct Finder<'a> {
    text: &'a str,
    found: Vec<Mutant>,
}

impl Finder<'_> {
    fn source(&self, node: &impl Spanned) -> &str {
        &self.text[node.span().byte_range()]
    }

    fn add(&mut self, span: Span, range: Range<usize>, replacement: String, description: String) {
        self.found.push(Mutant { line: span.start().line, range, replacement, description });
    }

    /// A function that answers at once.
    fn answers(&mut self, signature: &Signature, block: &Block) {
        let ReturnType::Type(_, returned) = &signature.output else { return };
        let at = block.brace_token.span.open().byte_range().end;
        for answer in answers(returned) {
            let description = format!("`{}` returns {answer}", signature.ident);
            self.add(signature.ident.span(), at..at, format!("return {answer};"), description);
        }
    }
}

/// What a function of this type may answer without looking.
fn answers(returned: &Type) -> &'static [&'static str] {
    let Type::Path(path) = returned else { return &[] };
    match path.path.segments.last().map(|segment| segment.ident.to_string()).as_deref() {
        Some("bool") => &["true", "false"],
        Some("f64") => &["0.0", "-1.0", "1e9"],
        Some("usize") => &["0"],
        Some("Option") => &["None"],
        _ => &[],
    }
}

fn is_test(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        Meta::Path(path) => path.is_ident("test"),
        Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string().contains("test"),
        Meta::NameValue(_) => false,
    })
}

/// What stands for an operator in a mutant.
fn other_operators(operator: &BinOp) -> &'static [&'static str] {
    match operator {
        BinOp::Add(_) => &["-"],
        BinOp::Sub(_) => &["+"],
        BinOp::Mul(_) => &["/"],
        BinOp::Div(_) => &["*"],
        BinOp::And(_) => &["||"],
        BinOp::Or(_) => &["&&"],
        BinOp::Eq(_) => &["!="],
        BinOp::Ne(_) => &["=="],
        BinOp::Lt(_) => &[">=", "<="],
        BinOp::Le(_) => &[">", "<"],
        BinOp::Gt(_) => &["<=", ">="],
        BinOp::Ge(_) => &["<", ">"],
        BinOp::AddAssign(_) => &["-="],
        BinOp::SubAssign(_) => &["+="],
        BinOp::MulAssign(_) => &["/="],
        BinOp::DivAssign(_) => &["*="],
        _ => &[],
    }
}

/// `let` in a condition cannot be moved into an `if` of its own.
fn has_let(expression: &Expr) -> bool {
    match expression {
        Expr::Let(_) => true,
        Expr::Binary(binary) => has_let(&binary.left) || has_let(&binary.right),
        _ => false,
    }
}

impl<'ast> Visit<'ast> for Finder<'_> {
    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !is_test(&item.attrs) {
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        if !is_test(&item.attrs) && item.sig.constness.is_none() {
            self.answers(&item.sig, &item.block);
            visit::visit_block(self, &item.block);
        }
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        if item.sig.constness.is_none() {
            self.answers(&item.sig, &item.block);
            visit::visit_block(self, &item.block);
        }
    }

    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}

    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}

    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}

    fn visit_type(&mut self, _: &'ast Type) {}

    fn visit_pat(&mut self, _: &'ast syn::Pat) {}

    fn visit_expr_repeat(&mut self, repeat: &'ast syn::ExprRepeat) {
        self.visit_expr(&repeat.expr);
    }

    fn visit_expr_binary(&mut self, binary: &'ast ExprBinary) {
        if !has_let(&binary.left) && !has_let(&binary.right) {
            let (left, right) = (self.source(&binary.left).to_owned(), self.source(&binary.right).to_owned());
            let operator = self.source(&binary.op).to_owned();
            for other in other_operators(&binary.op) {
                let left = if other.ends_with('=') && other.len() == 2 && !"=!<>".contains(&other[..1]) {
                    left.clone()
                } else {
                    format!("({left})")
                };
                let description = format!("replace `{operator}` with `{other}`");
                self.add(
                    binary.op.span(),
                    binary.span().byte_range(),
                    format!("{left} {other} ({right})"),
                    description,
                );
            }
        }
        visit::visit_expr_binary(self, binary);
    }

    fn visit_expr_unary(&mut self, unary: &'ast ExprUnary) {
        if matches!(unary.op, UnOp::Not(_) | UnOp::Neg(_)) && !matches!(*unary.expr, Expr::Lit(_)) {
            let (operator, operand) = (self.source(&unary.op).to_owned(), self.source(&unary.expr).to_owned());
            self.add(unary.span(), unary.span().byte_range(), operand, format!("delete `{operator}`"));
        }
        visit::visit_expr_unary(self, unary);
    }

    fn visit_expr_method_call(&mut self, call: &'ast ExprMethodCall) {
        let method = call.method.to_string();
        let other = match method.as_str() {
            "min" => Some("max"),
            "max" => Some("min"),
            "any" => Some("all"),
            "all" => Some("any"),
            _ => None,
        };
        if let Some(other) = other.filter(|_| call.args.len() == 1) {
            let (whole, name) = (call.span().byte_range(), call.method.span().byte_range());
            let text = self.text;
            let replacement = format!("{}{other}{}", &text[whole.start..name.start], &text[name.end..whole.end]);
            let description = format!("replace `{method}` with `{other}`");
            self.add(call.method.span(), whole, replacement, description);
        }
        visit::visit_expr_method_call(self, call);
    }
}

#[cfg(test)]
mod tests {
    use super::{Rendered, mutants};

    #[test]
    fn every_mutant_stands_behind_its_switch() {
        let text = "fn far(a: f64, b: f64) -> bool {\n    a - b > 1.0\n}\n";
        let found = mutants(text).unwrap();
        let described: Vec<_> = found.iter().map(|mutant| (mutant.line, mutant.description.as_str())).collect();
        let wanted = [
            (1, "`far` returns true"),
            (1, "`far` returns false"),
            (2, "replace `>` with `<=`"),
            (2, "replace `>` with `>=`"),
            (2, "replace `-` with `+`"),
        ];
        assert_eq!(described, wanted);
        let numbered: Vec<_> = found.iter().enumerate().collect();
        let rendered = Rendered::new(text, &numbered[2..]);
        let wanted = "fn far(a: f64, b: f64) -> bool {\n    (if crate::mutant::is(2) {(a - b) <= (1.0)} else \
                      if crate::mutant::is(3) {(a - b) >= (1.0)} else {(if crate::mutant::is(4) {(a) + (b)} else {a - b}) > 1.0})\n}\n";
        assert_eq!(rendered.text, wanted);
        let at = rendered.text.find("(a) + (b)").unwrap();
        assert_eq!(rendered.enclosing(&(at..at + 3)), [4]);
    }

    #[test]
    fn tests_and_constants_are_left_alone() {
        let text = "const A: f64 = 1.0 + 2.0;\n#[cfg(test)]\nmod tests {\n    fn f() -> bool { 1 < 2 }\n}\n";
        assert!(mutants(text).unwrap().is_empty());
    }
}
