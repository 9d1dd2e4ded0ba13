//! Position of a field in the text.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Byte range of the value of `field`, a path such as `vehicles[3].start.x_m`.
///
/// The range of a table is its header. If only a part of the path exists, the range is that of its last existing part, or
/// the beginning of the file.
pub(super) fn span_of_field(root: &DeTable<'_>, field: &str) -> Range<usize> {
    let mut steps = steps(field).into_iter();
    let Some(mut value) = steps.next().and_then(|key| root.get(key)) else { return 0..0 };
    for step in steps {
        match child(value, step) {
            Some(next) => value = next,
            None => break,
        }
    }
    value.span()
}

/// [`span_of_field`], or `None` if the field is not in the file.
pub(super) fn exact_span(root: &DeTable<'_>, field: &str) -> Option<Range<usize>> {
    let mut steps = steps(field).into_iter();
    let first = root.get(steps.next()?)?;
    steps.try_fold(first, child).map(Spanned::span)
}

/// Splits `vehicles[3].start.x_m` into `vehicles`, `3`, `start`, `x_m`.
fn steps(field: &str) -> Vec<&str> {
    field.split(['.', '[', ']']).filter(|step| !step.is_empty()).collect()
}

fn child<'t, 'i>(value: &'t Spanned<DeValue<'i>>, step: &str) -> Option<&'t Spanned<DeValue<'i>>> {
    match value.get_ref() {
        DeValue::Table(table) => table.get(step),
        DeValue::Array(array) => array.get(step.parse::<usize>().ok()?),
        _ => None,
    }
}

/// Position in the file of a byte of the text that a quoted string with the range `span` holds. The beginning of the string
/// if that cannot be told, because it holds escapes.
pub(super) fn within_string(text: &str, span: &Range<usize>, byte: usize) -> usize {
    let quoted = &text[span.clone()];
    let quotes = ["\"\"\"\n", "'''\n", "\"\"\"", "'''", "\"", "'"];
    let opening = quotes.into_iter().find(|quotes| quoted.starts_with(quotes)).map_or(0, str::len);
    let is_plain = opening > 0 && !quoted.contains('\\') && opening + byte < quoted.len();
    if byte > 0 && is_plain { span.start + opening + byte } else { span.start }
}

/// The document without the keys at `fields`.
pub(super) fn without<'i, 'f>(
    root: &Spanned<DeTable<'i>>,
    fields: impl Iterator<Item = &'f str>,
) -> Spanned<DeTable<'i>> {
    let mut root = root.clone();
    for field in fields {
        let steps = steps(field);
        if let Some((key, parents)) = steps.split_last() {
            remove(root.get_mut(), parents, key);
        }
    }
    root
}

fn remove(root: &mut DeTable<'_>, parents: &[&str], key: &str) {
    let Some((first, rest)) = parents.split_first() else {
        root.remove(key);
        return;
    };
    let parent = root.get_mut(*first).and_then(|top| rest.iter().try_fold(top, |value, step| child_mut(value, step)));
    if let Some(parent) = parent
        && let DeValue::Table(table) = parent.get_mut()
    {
        table.remove(key);
    }
}

fn child_mut<'t, 'i>(value: &'t mut Spanned<DeValue<'i>>, step: &str) -> Option<&'t mut Spanned<DeValue<'i>>> {
    match value.get_mut() {
        DeValue::Table(table) => table.get_mut(step),
        DeValue::Array(array) => array.get_mut(step.parse::<usize>().ok()?),
        _ => None,
    }
}

/// Line and column of a byte offset, both from 1; columns count characters.
pub(super) fn line_and_column(text: &str, offset: usize) -> (usize, usize) {
    let before = &text[..text.floor_char_boundary(offset)];
    let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
    (before.matches('\n').count() + 1, before[line_start..].chars().count() + 1)
}

#[cfg(test)]
mod tests {
    use toml::de::DeTable;

    use super::{exact_span, line_and_column, span_of_field};

    const TEXT: &str = "a = \"α\" # β\n[[b]]\nc = { d = [1, 22] }\n[[b]]\n";

    #[test]
    fn fields_are_found_by_their_paths() {
        let tree = DeTable::parse(TEXT).unwrap();
        let found = |field| &TEXT[span_of_field(tree.get_ref(), field)];
        assert_eq!(found("b[0].c.d[1]"), "22");
        assert_eq!(found("b[0].c"), "{ d = [1, 22] }");
        assert_eq!(found("b[1].missing.too"), "[[b]]");
        assert_eq!(found("missing"), "");
        assert_eq!(exact_span(tree.get_ref(), "b[0].c.d[1]"), Some(span_of_field(tree.get_ref(), "b[0].c.d[1]")));
        assert_eq!(exact_span(tree.get_ref(), "b[1].missing.too"), None);
    }

    #[test]
    fn columns_count_characters() {
        assert_eq!(line_and_column(TEXT, 0), (1, 1));
        assert_eq!(line_and_column(TEXT, TEXT.find('β').unwrap()), (1, 11));
        assert_eq!(line_and_column(TEXT, TEXT.find("c =").unwrap()), (3, 1));
        assert_eq!(line_and_column(TEXT, TEXT.len() + 7), (5, 1));
    }
}
