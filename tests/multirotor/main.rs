//! The judge on multirotors, planned before the flight and in the loop.

mod case;
#[path = "../edges/mod.rs"]
mod edge_table;
mod edges;
mod gusts;
mod in_loop;
mod plans;
mod solids;
mod together;
