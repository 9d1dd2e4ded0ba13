//! Reports for people and for CI servers: the terminal, JSON lines, JUnit, Markdown, GitHub.

pub mod comparison_table;
pub mod github;
mod headline;
pub mod json_lines;
pub mod junit;
mod markdown;
mod scenario_field;
mod summary;
pub mod table;
pub mod terminal;

pub use markdown::Links;
pub use summary::{RefusedFile, Summary, SummaryRun};
