//! Everything that is written: files, recordings, reports.

mod files;
pub mod flight_table;
pub mod ghost;
pub mod page;
pub mod recording;
pub mod report;
pub mod run;
pub mod scene;
pub mod tum;

pub use files::{create_folder, remove_stale, replace_file, write_file, write_json};
