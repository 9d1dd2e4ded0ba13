//! The receding-horizon controller and its parts on test maps.

mod arena;
mod closed_loop;
mod cost_maps;
mod samplers;
