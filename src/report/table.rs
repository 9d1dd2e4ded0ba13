//! The look of every table on the terminal.

use comfy_table::{ContentArrangement, Table, TableComponent, presets};

/// An empty table with a line under its header, as wide as the terminal at most.
pub fn with_header(header: &[&str]) -> Table {
    let mut table = Table::new();
    table.load_preset(presets::NOTHING).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_style(TableComponent::HeaderLines, '─').set_style(TableComponent::MiddleHeaderIntersections, '─');
    table.set_header(header.iter().copied());
    table
}
