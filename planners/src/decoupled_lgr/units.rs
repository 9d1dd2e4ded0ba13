//! Units of the nonlinear program: kilometres and tens of seconds, so that its variables are of order one.

use scenarios::GRAVITY_MPS2;

/// Unit of length, m.
pub const LENGTH_M: f64 = 1000.0;
/// Unit of time, s.
pub const TIME_S: f64 = 10.0;
/// Unit of speed, m/s.
pub const SPEED_MPS: f64 = LENGTH_M / TIME_S;
/// Gravity in these units.
pub const GRAVITY: f64 = GRAVITY_MPS2 * TIME_S * TIME_S / LENGTH_M;
