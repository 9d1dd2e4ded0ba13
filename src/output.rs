//! Everything that is written: files, recordings, reports.

mod files;
pub mod recording;
pub mod report;
#[cfg(any(feature = "mcap", feature = "rrd"))]
mod run;
#[cfg(any(feature = "mcap", feature = "rrd"))]
pub mod scene;
pub mod tum;

pub use files::{create_folder, remove_stale, replace_file, write_file, write_json};
