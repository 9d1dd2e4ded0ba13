//! The command line from end to end: what a user types, sees and finds on disk.

#[cfg(feature = "mcap")]
mod bags;
mod benchmarks;
mod checking;
mod comparing;
mod edge_cases;
mod external;
mod falsifying;
mod generating;
mod in_ci;
mod judging;
mod listing;
mod machine_faults;
mod planning;
mod probability;
#[cfg(feature = "mcap")]
mod recordings;
mod report_page;
mod results;
mod running;
mod schemas;
mod shipped;
mod starting;
#[cfg(unix)]
mod stopping;
mod sweeping;
mod tools;
mod trust;
mod workplace;
