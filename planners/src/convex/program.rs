//! The data of one subproblem.

use nalgebra::{SMatrix, SVector};

/// Number of variables of one stage.
pub const STAGE: usize = 9;

/// Number of rows of one link between two stages.
pub const LINK: usize = 6;

/// An elastic linear programme over the stages 0..=K; see the [module](super) for its mathematics.
///
/// Variables are z = (w_0, ..., w_K, θ), w_k of length [`STAGE`]; all vectors over z have length [`Program::len`].
#[derive(Clone, Debug)]
pub struct Program {
    /// Cost q of θ, > 0.
    pub theta_cost: f64,
    /// Constant part of the objective: added to what a solver reports, without influence on what it does.
    pub offset: f64,
    /// Weight μ of every violated elastic row, > q.
    pub penalty: f64,
    /// One link for each pair of neighbouring stages, K of them.
    pub links: Vec<Link>,
    /// Variables that are held at a value, elastically.
    pub pins: Vec<Pin>,
    /// Elastic planes in single stages, in ascending order of the stage.
    pub planes: Vec<Plane>,
    /// Hard lower bounds of z.
    pub box_lower: Vec<f64>,
    /// Hard upper bounds of z, above the lower ones.
    pub box_upper: Vec<f64>,
    /// Elastic lower bounds of z.
    pub soft_lower: Vec<f64>,
    /// Elastic upper bounds of z.
    pub soft_upper: Vec<f64>,
}

/// The elastic equality `left w_k + right w_{k+1} + theta θ = rhs`.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Coefficients of w_k.
    pub left: SMatrix<f64, LINK, STAGE>,
    /// Coefficients of w_{k+1}.
    pub right: SMatrix<f64, LINK, STAGE>,
    /// Coefficients of θ.
    pub theta: SVector<f64, LINK>,
    /// Right-hand side.
    pub rhs: SVector<f64, LINK>,
}

/// The elastic equality `z[index] = value`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// Index into z.
    pub index: usize,
    /// Value.
    pub value: f64,
}

/// The elastic inequality `here · (w_k[0], w_k[1]) + next · (w_{k+1}[0], w_{k+1}[1]) <= bound` in the first two variables
/// of a stage and, where it speaks of an instant between two stages, of the one after it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// The stage k.
    pub stage: usize,
    /// Coefficients of its first two variables.
    pub here: [f64; 2],
    /// Coefficients of the first two variables of stage k + 1; zero for k = K.
    pub next: [f64; 2],
    /// Right-hand side.
    pub bound: f64,
}

impl Plane {
    /// Indices into z with their coefficients, ascending; those of the next stage only where there are any.
    pub(super) fn terms(&self) -> impl Iterator<Item = (usize, f64)> {
        let (here, next) = (STAGE * self.stage, STAGE * (self.stage + 1));
        let own = [(here, self.here[0]), (here + 1, self.here[1])];
        let following = [(next, self.next[0]), (next + 1, self.next[1])];
        own.into_iter().chain(following.into_iter().filter(|_| self.spans_two_stages()))
    }

    /// Does it touch the stage after its own?
    pub(super) fn spans_two_stages(&self) -> bool {
        self.next != [0.0; 2]
    }
}

impl Program {
    /// Number K of links; there are K + 1 stages.
    pub fn intervals(&self) -> usize {
        self.links.len()
    }

    /// Length of z: `STAGE (K + 1) + 1`.
    pub fn len(&self) -> usize {
        STAGE * (self.intervals() + 1) + 1
    }

    /// Always false: there is at least θ.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Can it be solved in one pass with `other`: as many links, pins of the same variables? Planes may differ.
    pub fn has_shape_of(&self, other: &Self) -> bool {
        let pins = |program: &Self| program.pins.iter().map(|pin| pin.index).collect::<Vec<_>>();
        self.intervals() == other.intervals() && pins(self) == pins(other)
    }

    /// Number of elastic equalities: the rows of the links, then the pins.
    pub fn equalities(&self) -> usize {
        LINK * self.intervals() + self.pins.len()
    }

    /// Number of elastic inequalities: upper bounds, lower bounds, planes.
    pub fn inequalities(&self) -> usize {
        2 * self.len() + self.planes.len()
    }

    /// Is every number finite, and every box open? A programme for which this is false is refused.
    pub fn is_well_posed(&self) -> bool {
        let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
        let links = self.links.iter().all(|link| {
            finite(link.left.as_slice())
                && finite(link.right.as_slice())
                && finite(link.theta.as_slice())
                && finite(link.rhs.as_slice())
        });
        links
            && self.pins.iter().all(|pin| pin.value.is_finite())
            && self.planes.iter().all(|plane| finite(&plane.here) && finite(&plane.next) && plane.bound.is_finite())
            && self.planes.iter().all(|plane| plane.stage < self.intervals() || plane.next == [0.0; 2])
            && [&self.box_lower, &self.box_upper, &self.soft_lower, &self.soft_upper].into_iter().all(|v| finite(v))
            && self.box_lower.iter().zip(&self.box_upper).all(|(lower, upper)| lower < upper)
            && finite(&[self.theta_cost, self.offset, self.penalty])
    }

    /// Largest violation of an elastic row at `z`, in the row's units.
    pub fn largest_violation(&self, z: &[f64]) -> f64 {
        self.violations(z).into_iter().fold(0.0, f64::max)
    }

    /// `q θ + μ (violations)` at `z`, plus the offset.
    pub fn objective(&self, z: &[f64]) -> f64 {
        self.offset + self.theta_cost * z[z.len() - 1] + self.penalty * self.violations(z).into_iter().sum::<f64>()
    }

    /// Violations of all elastic rows at `z`, >= 0, equalities first.
    fn violations(&self, z: &[f64]) -> Vec<f64> {
        let mut equalities = vec![0.0; self.equalities()];
        self.equality_values(z, &mut equalities);
        let mut inequalities = vec![0.0; self.inequalities()];
        self.inequality_values(z, &mut inequalities);
        let off = equalities.iter().zip(self.equality_rhs()).map(|(value, d)| (value - d).abs());
        let above = inequalities.iter().zip(self.inequality_rhs()).map(|(value, g)| (value - g).max(0.0));
        off.chain(above).collect()
    }

    /// `out = E z`: links, then pins.
    pub(super) fn equality_values(&self, z: &[f64], out: &mut [f64]) {
        let θ = z[z.len() - 1];
        let (stages, _) = z.as_chunks::<STAGE>();
        let (links, pins) = out.split_at_mut(LINK * self.intervals());
        for (k, (link, row)) in self.links.iter().zip(links.as_chunks_mut::<LINK>().0).enumerate() {
            let value =
                link.left * SVector::from(stages[k]) + link.right * SVector::from(stages[k + 1]) + link.theta * θ;
            *row = value.into();
        }
        for (pin, row) in self.pins.iter().zip(pins) {
            *row = z[pin.index];
        }
    }

    /// `out += E^T y`.
    pub(super) fn add_equality_duals(&self, y: &[f64], out: &mut [f64]) {
        let (links, pins) = y.split_at(LINK * self.intervals());
        let last = out.len() - 1;
        for (k, (link, y)) in self.links.iter().zip(links.as_chunks::<LINK>().0).enumerate() {
            let y = SVector::from(*y);
            let left = link.left.tr_mul(&y);
            let right = link.right.tr_mul(&y);
            for i in 0..STAGE {
                out[STAGE * k + i] += left[i];
                out[STAGE * (k + 1) + i] += right[i];
            }
            out[last] += link.theta.dot(&y);
        }
        for (pin, y) in self.pins.iter().zip(pins) {
            out[pin.index] += y;
        }
    }

    /// `out = F z`: upper bounds (z), lower bounds (-z), planes.
    pub(super) fn inequality_values(&self, z: &[f64], out: &mut [f64]) {
        let (upper, rest) = out.split_at_mut(z.len());
        let (lower, planes) = rest.split_at_mut(z.len());
        upper.copy_from_slice(z);
        for (row, z) in lower.iter_mut().zip(z) {
            *row = -z;
        }
        for (plane, row) in self.planes.iter().zip(planes) {
            *row = plane.terms().map(|(index, coefficient)| coefficient * z[index]).sum();
        }
    }

    /// `out += F^T λ`.
    pub(super) fn add_inequality_duals(&self, λ: &[f64], out: &mut [f64]) {
        let (upper, rest) = λ.split_at(out.len());
        let (lower, planes) = rest.split_at(out.len());
        for ((out, upper), lower) in out.iter_mut().zip(upper).zip(lower) {
            *out += upper - lower;
        }
        for (plane, λ) in self.planes.iter().zip(planes) {
            for (index, coefficient) in plane.terms() {
                out[index] += coefficient * λ;
            }
        }
    }

    /// Right-hand sides d of the equalities.
    pub(super) fn equality_rhs(&self) -> impl Iterator<Item = f64> + '_ {
        let links = self.links.iter().flat_map(|link| link.rhs.as_slice().iter().copied());
        links.chain(self.pins.iter().map(|pin| pin.value))
    }

    /// Right-hand sides g of the inequalities.
    pub(super) fn inequality_rhs(&self) -> impl Iterator<Item = f64> + '_ {
        let upper = self.soft_upper.iter().copied();
        let lower = self.soft_lower.iter().map(|bound| -bound);
        upper.chain(lower).chain(self.planes.iter().map(|plane| plane.bound))
    }
}
