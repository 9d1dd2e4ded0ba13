//! The plant of multirotors against an independent integrator, and the clockwork of planning in the loop.

mod arena;
mod clockwork;
mod plant;
