//! A sample for tests of logs.

use sim::{Actuation, Commanded, Sample};

/// A vehicle at rest at the origin in still air, s.
pub fn still_sample(t_s: f64) -> Sample {
    Sample {
        t_s,
        position_m: [0.0; 3],
        velocity_mps: [0.0; 3],
        wind_mps: [0.0; 3],
        world_from_body: [0.0, 0.0, 0.0, 1.0],
        measured_position_m: [0.0; 3],
        measured_velocity_mps: [0.0; 3],
        reference_position_m: [0.0; 3],
        reference_velocity_mps: [0.0; 3],
        actuation: Actuation::Acceleration(Commanded { command: [0.0; 3], control: [0.0; 3] }),
    }
}
