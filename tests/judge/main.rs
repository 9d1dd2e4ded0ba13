//! The judge against hand-made plans and flights: what must fail fails, near misses pass.

mod between_samples;
mod broken;
mod clearances;
mod edges;
mod fleet;
mod goals;
mod roundabout;
mod rules;
mod simulated;
mod sparse_rows;
mod submitted;
