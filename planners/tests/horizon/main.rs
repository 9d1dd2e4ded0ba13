//! Planners in the loop, on maps that are made up, with an ideal vehicle.

mod arena;
mod closed_loop;
mod cost_maps;
mod samplers;
