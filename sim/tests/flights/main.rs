//! Whole flights against closed forms and independent integrators.

mod arena;
mod crash;
mod disturbances;
mod finer_steps;
mod open_loop;
mod polar;
mod propagate;
mod pulses;
mod reference;
mod repeatability;
mod tracking;
