//! Units of the subproblem's variables, chosen so that all of them are of order one.

use nalgebra::SMatrix;

use super::dynamics::State;

/// Metres per scaled unit of x and y.
pub const POSITION_M: f64 = 1000.0;

/// One scaled unit of (x, y, h, V, χ, γ, n_x, n_y, n_z): m, m, m, m/s, rad, rad, -, -, -.
pub const NODE_UNITS: [f64; 9] = [POSITION_M, POSITION_M, 100.0, 10.0, 1.0, 0.1, 0.1, 0.1, 0.1];

/// A state in scaled units.
pub fn scaled_state(state: &State) -> State {
    State::from_fn(|i, _| state[i] / NODE_UNITS[i])
}

/// Rows in the units of a state and columns in the units of a node, converted to scaled units.
pub fn scaled_rows(rows: &SMatrix<f64, 6, 9>) -> SMatrix<f64, 6, 9> {
    SMatrix::from_fn(|i, j| rows[(i, j)] / NODE_UNITS[i] * NODE_UNITS[j])
}
