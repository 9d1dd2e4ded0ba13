//! The plant of multirotors against an independent integrator, and the schedule of in-loop planning.

mod arena;
mod plant;
mod pulses;
mod schedule;
