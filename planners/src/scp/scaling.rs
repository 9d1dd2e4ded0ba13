//! Units of the subproblem's variables, so that all of them are near one.

use nalgebra::{SMatrix, SVector};

use super::dynamics::State;

/// Metres per scaled unit of x and y.
pub const POSITION_M: f64 = 1000.0;

/// One scaled unit of (x, y, h, V, χ, γ, n_x, n_y, n_z): m, m, m, m/s, rad, rad, -, -, -.
pub const NODE: [f64; 9] = [POSITION_M, POSITION_M, 100.0, 10.0, 1.0, 0.1, 0.1, 0.1, 0.1];

/// A state in scaled units.
pub fn scaled_state(state: &State) -> State {
    State::from_fn(|i, _| state[i] / NODE[i])
}

/// Rows in the units of a state, columns in the units of a node, both made scaled.
pub fn scaled_rows(rows: &SMatrix<f64, 6, 9>) -> SMatrix<f64, 6, 9> {
    SMatrix::from_fn(|i, j| rows[(i, j)] / NODE[i] * NODE[j])
}

/// One unit of every variable of a node.
pub fn node_units() -> SVector<f64, 9> {
    SVector::from(NODE)
}
