//! The command line from end to end: what a user types, sees and finds on disk.

mod benchmarks;
mod listing;
mod results;
mod running;
mod schemas;
mod workplace;
