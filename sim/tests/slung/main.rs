//! Quadrotors with slung loads: the plant against closed-form motions and an independent integrator, the tracker on plans
//! made by hand.

mod arena;
mod flatness;
mod plant;
mod reference_flight;
mod tracking;
