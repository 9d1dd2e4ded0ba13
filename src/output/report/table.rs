//! The look of every table on the terminal.

use comfy_table::{CellAlignment, ColumnConstraint, ContentArrangement, Table, TableComponent, Width, presets};

/// Width away from a terminal, characters.
const PAGE_WIDTH: u16 = 120;
/// Narrowest last column, characters: on a terminal that is too narrow for it, lines run over the edge.
const NARROWEST_TEXT: u16 = 24;

/// An empty table with a line under its header, as wide as the terminal at most. Only its last column is wrapped.
///
/// - `numbers`: columns that are set flush right
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
        let narrowest = ColumnConstraint::LowerBoundary(Width::Fixed(NARROWEST_TEXT));
        column.set_constraint(if is_last { narrowest } else { ColumnConstraint::ContentWidth });
        column.set_padding((0, if is_last { 0 } else { 1 }));
        if numbers.contains(&index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
}
