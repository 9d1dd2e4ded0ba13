//! Certified optimality gap of a solution, from the program data and multipliers alone.

use super::program::Program;

/// Multipliers of one program.
#[derive(Clone, Debug)]
pub struct Multipliers {
    /// y of the dynamics constraints and fixed variables, in [-μ, μ].
    pub equalities: Vec<f64>,
    /// λ of upper bounds, lower bounds and halfspaces, in [0, μ].
    pub inequalities: Vec<f64>,
}

/// Objective at `z`, and its distance to the Lagrangian lower bound, relative to the objective or to 1 where that is
/// larger:
///
/// ```text
/// min over lo <= z <= hi of  q θ + y^T (E z - d) + λ^T (F z - g)  =  -y^T d - λ^T g + Σ min(r_i lo_i, r_i hi_i),
/// r = q e_θ + E^T y + F^T λ
/// ```
///
/// The bound holds for any multipliers within their bounds.
pub fn certified_gap(program: &Program, z: &[f64], multipliers: &Multipliers) -> (f64, f64) {
    let Multipliers { equalities, inequalities } = multipliers;
    let mut r = vec![0.0; program.len()];
    r[program.len() - 1] = program.theta_cost;
    program.add_equality_duals(equalities, &mut r);
    program.add_inequality_duals(inequalities, &mut r);
    let bounds_part: f64 = r
        .iter()
        .zip(program.box_lower.iter().zip(&program.box_upper))
        .map(|(r, (lower, upper))| (r * lower).min(r * upper))
        .sum();
    let equality_part: f64 = equalities.iter().zip(program.equality_rhs()).map(|(y, d)| y * d).sum();
    let inequality_part: f64 = inequalities.iter().zip(program.inequality_rhs()).map(|(λ, g)| λ * g).sum();
    let bound = program.offset + bounds_part - equality_part - inequality_part;
    let objective = program.objective(z);
    (objective, (objective - bound) / (objective - program.offset).abs().max(1.0))
}
