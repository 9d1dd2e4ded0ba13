//! Controls as the flight log holds them: one variant per kind of control.

use scenarios::{fixed_wing, slung_load};

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
    /// Does the control differ from the command?
    pub(crate) fn is_saturated(&self) -> bool {
        match self {
            Self::LoadFactors(Commanded { command, control }) => command != control,
            Self::Thrusts(Commanded { command, control }) => command != control,
            Self::Acceleration(Commanded { command, control }) => command != control,
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
