//! The judge on quadrotors with slung loads: flights that pass, and their defects.

#[path = "../../sim/tests/slung/arena.rs"]
mod arena;
mod broken;
mod case;
#[path = "../edges/mod.rs"]
mod edge_table;
mod edges;
#[path = "../../sim/tests/slung/flatness.rs"]
mod flatness;
#[cfg(feature = "rrd")]
mod recording;
mod solids;
