//! What a run leaves behind: files, recordings and reports.

mod files;
pub mod recording;
pub mod report;
pub mod tum;

pub use files::{create_folder, print, remove_stale, replace_file, tell, write_file, write_json};
