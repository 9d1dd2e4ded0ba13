//! The judge on hand-made plans and flights: wrong ones fail, near misses pass.

#[cfg(feature = "mcap")]
mod bags;
mod between_samples;
mod broken;
mod clearances;
#[path = "../../scenarios/tests/damage/mod.rs"]
mod damage;
mod dense_rows;
#[path = "../edges/mod.rs"]
mod edge_table;
mod edges;
mod fleet;
mod geofences;
mod goals;
mod partial_plans;
mod recorded;
mod requirements;
mod roundabout;
mod rules;
mod simulated;
mod solids;
mod sparse_rows;
mod submitted;
mod via_points;
