//! Where the numbers of a node stand: coordinates, their derivatives, load factors.

/// Number of coordinates: position and clock.
pub const COORDINATES: usize = 4;
/// Number of states: coordinates and their derivatives.
pub const STATES: usize = 2 * COORDINATES;
/// Number of controls: load factors.
pub const CONTROLS: usize = 3;
/// Length of a node vector.
pub const WIDTH: usize = STATES + CONTROLS;
/// Index of the clock σ.
pub const CLOCK: usize = 3;
/// First index of the derivatives: the velocity, then that of the clock.
pub const VELOCITY: usize = COORDINATES;
/// First index of the controls.
pub const LOAD_FACTORS: usize = STATES;
