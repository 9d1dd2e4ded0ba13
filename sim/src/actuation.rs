//! Controls as the flight log holds them: one variant per kind of control.

use scenarios::{fixed_wing, slung_load};

/// Commands that exceed a limit by less than this, relative to it, are at the limit.
const ROUNDING: f64 = 1e-9;

/// Controls at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Actuation {
    /// Load factors of a fixed wing.
    LoadFactors(Commanded<fixed_wing::Control>),
    /// Rotor thrusts of a quadrotor.
    Thrusts(Commanded<slung_load::Control>),
    /// Acceleration of a point mass in excess of the one that balances gravity, world frame, m/s².
    Acceleration(Commanded<[f64; 3]>),
}

/// A control before and after saturation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Commanded<C> {
    /// What the tracker commanded.
    pub command: C,
    /// What acted, inside the vehicle's limits.
    pub control: C,
}

impl Actuation {
    /// Does the control differ from the command, by more than rounding?
    pub(crate) fn is_saturated(&self) -> bool {
        match self {
            Self::LoadFactors(Commanded { command, control }) => differ(command.to_array(), control.to_array()),
            Self::Thrusts(Commanded { command, control }) => differ(command.thrust_n, control.thrust_n),
            Self::Acceleration(Commanded { command, control }) => differ(*command, *control),
        }
    }

    /// The numbers of the command, then those of the control.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        match self {
            Self::LoadFactors(Commanded { command, control }) => [command, control].map(|it| it.to_array()).concat(),
            Self::Thrusts(Commanded { command, control }) => [command.thrust_n, control.thrust_n].concat(),
            Self::Acceleration(Commanded { command, control }) => [*command, *control].concat(),
        }
    }
}

/// NaN differs from everything.
fn differ<const N: usize>(command: [f64; N], control: [f64; N]) -> bool {
    let is_same = |(a, b): (f64, f64)| (a - b).abs() <= ROUNDING * b.abs().max(1.0);
    !command.into_iter().zip(control).all(is_same)
}
