//! The judge on multirotors, with plans that were there before the flight and with such as are made during it.

mod case;
mod edges;
mod gusts;
mod in_loop;
mod plans;
mod together;
