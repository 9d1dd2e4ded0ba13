//! Quadrotors with slung loads: the plant against closed forms and an independent integrator, the tracker on hand-made
//! plans.

mod arena;
mod flatness;
mod plant;
mod pulses;
mod reference_flight;
mod tracking;
