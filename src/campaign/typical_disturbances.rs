//! Disturbances of an ordinary day, from which campaigns begin.

/// Disturbances of an ordinary day for vehicles of one family.
pub struct TypicalDisturbances {
    /// Speed of a light breeze, m/s.
    pub wind_mps: f64,
    /// Standard deviation of the measured position, m.
    pub position_noise_m: f64,
}
