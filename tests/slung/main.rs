//! The judge on quadrotors with slung loads: flights that are right, and everything that can be wrong with them.

#[path = "../../sim/tests/slung/arena.rs"]
mod arena;
mod broken;
mod case;
mod edges;
#[path = "../../sim/tests/slung/flatness.rs"]
mod flatness;
#[cfg(feature = "rrd")]
mod recording;
