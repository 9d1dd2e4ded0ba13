//! The data of one elastic linear program.

use nalgebra::{SMatrix, SVector};

/// Number of variables of one stage.
pub const STAGE_LEN: usize = 9;

/// Number of rows of one constraint between two stages.
pub const DYNAMICS_ROWS: usize = 6;

/// Largest weight μ u of a row that double precision resolves without further ado: its multiplier by its distances to
/// ±μ u, and the penalty on a violation that is only rounding. A multiplier is of order one, so that its distances to
/// bounds of this size resolve it to 1e-13.
pub(super) const MAX_PLAIN_WEIGHT: f64 = 1e3;

/// Rounding of a row relative to the sum of its terms.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// An elastic linear program over the stages 0..=K; see the [module](super) for its mathematics.
///
/// Variables are z = (w_0, ..., w_K, θ), w_k of length [`STAGE_LEN`]; all vectors over z have length [`Program::len`].
#[derive(Clone, Debug)]
pub struct Program {
    /// Cost q of θ, > 0.
    pub theta_cost: f64,
    /// Constant term of the objective. It is part of the reported objective and has no effect on the solution.
    pub offset: f64,
    /// Penalty μ per unit of violation of an elastic row, > q.
    pub penalty: f64,
    /// Units u in which violations are measured: a row in variable i of a stage is weighted with μ `row_units[i]`. The
    /// rows of a dynamics constraint are in the first variables of a stage, halfspaces in the first; the unit of θ is 1.
    pub row_units: [f64; STAGE_LEN],
    /// Dynamics constraints between neighbouring stages, length K.
    pub dynamics: Vec<DynamicsConstraint>,
    /// Elastically fixed variables.
    pub fixed_variables: Vec<FixedVariable>,
    /// Elastic halfspace constraints, sorted by stage.
    pub halfspaces: Vec<HalfspaceConstraint>,
    /// Hard lower bounds of z.
    pub box_lower: Vec<f64>,
    /// Hard upper bounds of z, greater than the lower ones.
    pub box_upper: Vec<f64>,
    /// Elastic lower bounds of z.
    pub soft_lower: Vec<f64>,
    /// Elastic upper bounds of z.
    pub soft_upper: Vec<f64>,
}

/// The elastic equality `left w_k + right w_{k+1} + theta θ = rhs`.
#[derive(Clone, Debug, PartialEq)]
pub struct DynamicsConstraint {
    /// Coefficients of w_k.
    pub left: SMatrix<f64, DYNAMICS_ROWS, STAGE_LEN>,
    /// Coefficients of w_{k+1}.
    pub right: SMatrix<f64, DYNAMICS_ROWS, STAGE_LEN>,
    /// Coefficients of θ.
    pub theta: SVector<f64, DYNAMICS_ROWS>,
    /// Right-hand side.
    pub rhs: SVector<f64, DYNAMICS_ROWS>,
}

/// The elastic equality `z[index] = value`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FixedVariable {
    /// Index into z.
    pub index: usize,
    /// Value.
    pub value: f64,
}

/// The elastic inequality `current · (w_k[0], w_k[1]) + next · (w_{k+1}[0], w_{k+1}[1]) <= bound` in the first two
/// variables of stage k and, where it holds at an instant between two stages, of stage k + 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfspaceConstraint {
    /// The stage k.
    pub stage: usize,
    /// Coefficients of the first two variables of stage k.
    pub current: [f64; 2],
    /// Coefficients of the first two variables of stage k + 1; zero for k = K.
    pub next: [f64; 2],
    /// Right-hand side.
    pub bound: f64,
}

impl HalfspaceConstraint {
    /// Indices into z with their coefficients, ascending; those of stage k + 1 only if they are not both zero.
    pub(super) fn terms(&self) -> impl Iterator<Item = (usize, f64)> {
        let (current, next) = (STAGE_LEN * self.stage, STAGE_LEN * (self.stage + 1));
        let own = [(current, self.current[0]), (current + 1, self.current[1])];
        let following = [(next, self.next[0]), (next + 1, self.next[1])];
        own.into_iter().chain(following.into_iter().filter(|_| self.spans_two_stages()))
    }

    /// Does it have coefficients in stage k + 1?
    pub(super) fn spans_two_stages(&self) -> bool {
        self.next != [0.0; 2]
    }
}

impl Program {
    /// Number K of intervals; there are K + 1 stages.
    pub fn intervals(&self) -> usize {
        self.dynamics.len()
    }

    /// Length of z: `STAGE_LEN (K + 1) + 1`.
    pub fn len(&self) -> usize {
        STAGE_LEN * (self.intervals() + 1) + 1
    }

    /// Always false: z contains at least θ.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Do both programs have the same number of intervals and the same fixed variables, so that one batch can hold
    /// them? Halfspaces may differ.
    pub fn has_shape_of(&self, other: &Self) -> bool {
        let fixed_indices =
            |program: &Self| program.fixed_variables.iter().map(|fixed| fixed.index).collect::<Vec<_>>();
        self.intervals() == other.intervals() && fixed_indices(self) == fixed_indices(other)
    }

    /// Number of elastic equalities: dynamics rows, then fixed variables.
    pub fn equalities(&self) -> usize {
        DYNAMICS_ROWS * self.intervals() + self.fixed_variables.len()
    }

    /// Number of elastic inequalities: upper bounds, lower bounds, halfspaces.
    pub fn inequalities(&self) -> usize {
        2 * self.len() + self.halfspaces.len()
    }

    /// Is every number finite, and does every pair of hard bounds have an interior? The solvers refuse other programs.
    pub fn is_well_posed(&self) -> bool {
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        let dynamics = self.dynamics.iter().all(|constraint| {
            finite(constraint.left.as_slice())
                && finite(constraint.right.as_slice())
                && finite(constraint.theta.as_slice())
                && finite(constraint.rhs.as_slice())
        });
        dynamics
            && self.fixed_variables.iter().all(|fixed| fixed.value.is_finite())
            && self
                .halfspaces
                .iter()
                .all(|halfspace| finite(&halfspace.current) && finite(&halfspace.next) && halfspace.bound.is_finite())
            && self.halfspaces.iter().all(|halfspace| halfspace.stage < self.intervals() || halfspace.next == [0.0; 2])
            && [&self.box_lower, &self.box_upper, &self.soft_lower, &self.soft_upper].into_iter().all(|v| finite(v))
            && self.box_lower.iter().zip(&self.box_upper).all(|(lower, upper)| lower < upper)
            && finite(&[self.theta_cost, self.offset, self.penalty])
            && finite(&self.row_units)
    }

    /// Rounding of any row for any z within the hard bounds.
    fn rounding(&self) -> f64 {
        let size = |index: usize| self.box_lower[index].abs().max(self.box_upper[index].abs());
        let term = |index: usize, coefficient: f64| coefficient.abs() * size(index);
        let θ = self.len() - 1;
        let dynamics = self.dynamics.iter().enumerate().flat_map(|(k, constraint)| {
            (0..DYNAMICS_ROWS).map(move |i| {
                let stage = |first: usize, row: &SMatrix<f64, DYNAMICS_ROWS, STAGE_LEN>| {
                    (0..STAGE_LEN).map(|j| term(STAGE_LEN * first + j, row[(i, j)])).sum::<f64>()
                };
                let stages = stage(k, &constraint.left) + stage(k + 1, &constraint.right);
                stages + term(θ, constraint.theta[i]) + constraint.rhs[i].abs()
            })
        });
        ROUNDING * dynamics.fold(0.0, f64::max)
    }

    /// Violations of a row in variable i of a stage, and last of a row in θ, that count as none: the rounding of rows
    /// of large weight. They are violations of a program whose right-hand sides differ in the last digits; with their
    /// weight they would bury the digits of the objective that matter.
    pub(super) fn resolutions(&self) -> [f64; STAGE_LEN + 1] {
        let rounding = self.rounding();
        let resolution = |unit: f64| if self.penalty * unit > MAX_PLAIN_WEIGHT { rounding } else { 0.0 };
        std::array::from_fn(|i| resolution(if i < STAGE_LEN { self.row_units[i] } else { 1.0 }))
    }

    /// Largest violation of an elastic row at `z`, in the units of the row.
    pub fn max_violation(&self, z: &[f64]) -> f64 {
        self.violations(z).into_iter().fold(0.0, f64::max)
    }

    /// The same without the elastic bounds of θ.
    pub fn max_stage_violation(&self, z: &[f64]) -> f64 {
        let components = self.equality_components().chain(self.inequality_components());
        let violations = self.violations(z).into_iter().zip(components);
        violations.filter(|(_, component)| *component < STAGE_LEN).map(|(violation, _)| violation).fold(0.0, f64::max)
    }

    /// `q θ + μ (u · violations)` at `z`, plus the offset. Violations within the resolution of a row
    /// count as none.
    pub fn objective(&self, z: &[f64]) -> f64 {
        let resolutions = self.resolutions();
        let components = self.equality_components().chain(self.inequality_components());
        let violations = self.violations(z).into_iter().zip(components);
        let resolved = violations.filter(|(violation, component)| *violation >= resolutions[*component]);
        let violation = resolved.map(|(violation, component)| self.unit_of(component) * violation).sum::<f64>();
        self.offset + self.theta_cost * z[z.len() - 1] + self.penalty * violation
    }

    /// Unit of the rows in variable `index` of z.
    pub(crate) fn unit(&self, index: usize) -> f64 {
        self.unit_of(self.component(index))
    }

    /// The variable of a stage that variable `index` of z is; STAGE_LEN for θ.
    pub(super) fn component(&self, index: usize) -> usize {
        if index + 1 == self.len() { STAGE_LEN } else { index % STAGE_LEN }
    }

    fn unit_of(&self, component: usize) -> f64 {
        self.row_units.get(component).copied().unwrap_or(1.0)
    }

    /// Units u of all rows, equalities first.
    pub(super) fn units(&self) -> impl Iterator<Item = f64> + '_ {
        self.equality_components().chain(self.inequality_components()).map(|component| self.unit_of(component))
    }

    /// Components that the equalities are in.
    fn equality_components(&self) -> impl Iterator<Item = usize> + '_ {
        let dynamics = self.dynamics.iter().flat_map(|_| 0..DYNAMICS_ROWS);
        dynamics.chain(self.fixed_variables.iter().map(|fixed| self.component(fixed.index)))
    }

    /// Components that the inequalities are in; a halfspace counts as the first.
    fn inequality_components(&self) -> impl Iterator<Item = usize> + '_ {
        let bounds = || (0..self.len()).map(|index| self.component(index));
        bounds().chain(bounds()).chain(self.halfspaces.iter().map(|_| 0))
    }

    /// Violations of all elastic rows at `z`, >= 0, equalities first.
    fn violations(&self, z: &[f64]) -> Vec<f64> {
        let mut equalities = vec![0.0; self.equalities()];
        self.equality_values(z, &mut equalities);
        let mut inequalities = vec![0.0; self.inequalities()];
        self.inequality_values(z, &mut inequalities);
        let residuals = equalities.iter().zip(self.equality_rhs()).map(|(value, d)| (value - d).abs());
        let excesses = inequalities.iter().zip(self.inequality_rhs()).map(|(value, g)| (value - g).max(0.0));
        residuals.chain(excesses).collect()
    }

    /// `out = E z`: dynamics rows, then fixed variables.
    pub(super) fn equality_values(&self, z: &[f64], out: &mut [f64]) {
        let θ = z[z.len() - 1];
        let (stages, _) = z.as_chunks::<STAGE_LEN>();
        let (dynamics, fixed_variables) = out.split_at_mut(DYNAMICS_ROWS * self.intervals());
        for (k, (constraint, row)) in self.dynamics.iter().zip(dynamics.as_chunks_mut::<DYNAMICS_ROWS>().0).enumerate()
        {
            let value = constraint.left * SVector::from(stages[k])
                + constraint.right * SVector::from(stages[k + 1])
                + constraint.theta * θ;
            *row = value.into();
        }
        for (fixed, row) in self.fixed_variables.iter().zip(fixed_variables) {
            *row = z[fixed.index];
        }
    }

    /// `out += E^T y`.
    pub(super) fn add_equality_duals(&self, y: &[f64], out: &mut [f64]) {
        let (dynamics, fixed_variables) = y.split_at(DYNAMICS_ROWS * self.intervals());
        let last = out.len() - 1;
        for (k, (constraint, y)) in self.dynamics.iter().zip(dynamics.as_chunks::<DYNAMICS_ROWS>().0).enumerate() {
            let y = SVector::from(*y);
            let left = constraint.left.tr_mul(&y);
            let right = constraint.right.tr_mul(&y);
            for i in 0..STAGE_LEN {
                out[STAGE_LEN * k + i] += left[i];
                out[STAGE_LEN * (k + 1) + i] += right[i];
            }
            out[last] += constraint.theta.dot(&y);
        }
        for (fixed, y) in self.fixed_variables.iter().zip(fixed_variables) {
            out[fixed.index] += y;
        }
    }

    /// `out = F z`: upper bounds (z), lower bounds (-z), halfspaces.
    pub(super) fn inequality_values(&self, z: &[f64], out: &mut [f64]) {
        let (upper, rest) = out.split_at_mut(z.len());
        let (lower, halfspaces) = rest.split_at_mut(z.len());
        upper.copy_from_slice(z);
        for (row, z) in lower.iter_mut().zip(z) {
            *row = -z;
        }
        for (halfspace, row) in self.halfspaces.iter().zip(halfspaces) {
            *row = halfspace.terms().map(|(index, coefficient)| coefficient * z[index]).sum();
        }
    }

    /// `out += F^T λ`.
    pub(super) fn add_inequality_duals(&self, λ: &[f64], out: &mut [f64]) {
        let (upper, rest) = λ.split_at(out.len());
        let (lower, halfspaces) = rest.split_at(out.len());
        for ((out, upper), lower) in out.iter_mut().zip(upper).zip(lower) {
            *out += upper - lower;
        }
        for (halfspace, λ) in self.halfspaces.iter().zip(halfspaces) {
            for (index, coefficient) in halfspace.terms() {
                out[index] += coefficient * λ;
            }
        }
    }

    /// Right-hand sides d of the equalities.
    pub(super) fn equality_rhs(&self) -> impl Iterator<Item = f64> + '_ {
        let dynamics = self.dynamics.iter().flat_map(|constraint| constraint.rhs.as_slice().iter().copied());
        dynamics.chain(self.fixed_variables.iter().map(|fixed| fixed.value))
    }

    /// Right-hand sides g of the inequalities.
    pub(super) fn inequality_rhs(&self) -> impl Iterator<Item = f64> + '_ {
        let upper = self.soft_upper.iter().copied();
        let lower = self.soft_lower.iter().map(|bound| -bound);
        upper.chain(lower).chain(self.halfspaces.iter().map(|halfspace| halfspace.bound))
    }
}
