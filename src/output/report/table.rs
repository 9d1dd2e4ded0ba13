//! The style of all tables: on the terminal and in Markdown.

use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, Table, TableComponent, Width, presets};

/// Width of tables that are not printed to a terminal, characters.
const PAGE_WIDTH: u16 = 120;
/// Smallest width of the last column, characters; on a narrower terminal lines overflow.
const MIN_TEXT_WIDTH: u16 = 14;

/// An empty table with a line below its header, at most as wide as the terminal. Only the last column is wrapped.
///
/// - `numbers`: columns that are right-aligned
pub fn with_header(header: &[&str], numbers: &[usize]) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_style(TableComponent::HeaderLines, '─').set_style(TableComponent::MiddleHeaderIntersections, '─');
    table.set_header(header.iter().copied());
    if !table.is_tty() {
        table.set_width(PAGE_WIDTH);
    }
    for (index, column) in table.column_iter_mut().enumerate() {
        let is_last = index + 1 == header.len();
        let narrowest = ColumnConstraint::LowerBoundary(Width::Fixed(MIN_TEXT_WIDTH));
        column.set_constraint(if is_last { narrowest } else { ColumnConstraint::ContentWidth });
        column.set_padding((0, if is_last { 0 } else { 1 }));
        if numbers.contains(&index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}

/// The table in Markdown, line by line, with a line break at its end.
///
/// - `numbers`: columns that are right-aligned
pub fn markdown(header: &[&str], numbers: &[usize], rows: impl IntoIterator<Item = impl AsRef<[String]>>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let rule = (0..header.len()).map(|column| if numbers.contains(&column) { "---:|" } else { "---|" });
    let head = line(&header.iter().map(ToString::to_string).collect::<Vec<_>>());
    let body = rows.into_iter().map(|cells| line(cells.as_ref()));
    [head, format!("|{}\n", rule.collect::<String>())].into_iter().chain(body).collect()
}

/// The text with lines that are longer than the terminal broken between words and indented; unchanged elsewhere.
pub fn wrapped(text: &str) -> String {
    let terminal = Table::new();
    let Some(width) = terminal.width().filter(|_| terminal.is_tty()) else { return text.to_owned() };
    let options = textwrap::Options::new(usize::from(width)).subsequent_indent("    ").break_words(false);
    textwrap::fill(text, options)
}
