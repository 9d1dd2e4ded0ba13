//! Up to four programs of one shape, one per lane.

use super::kernels::Matrix;
use super::program::{DYNAMICS_ROWS, HalfspaceConstraint, Program, STAGE_LEN};
use crate::simd::{Lanes, Mask, Simd4, WIDTH};

/// The data of four programs, one per lane. The number of halfspaces may differ: a lane with fewer halfspaces in a
/// stage than another has absent ones there, which have no effect.
#[derive(Clone, Debug)]
pub struct Batch<S: Simd4> {
    /// Vector instructions of the processor.
    pub simd: S,
    /// q.
    pub theta_cost: Lanes<S>,
    /// μ.
    pub penalty: Lanes<S>,
    /// Scales of the rows in each variable of a stage; halfspaces have that of the first.
    pub row_scales: [RowScale<S>; STAGE_LEN],
    /// Dynamics constraints, length K.
    pub dynamics: Vec<DynamicsConstraint<S>>,
    /// Fixed variables: index into z, and value.
    pub fixed_variables: Vec<(usize, Lanes<S>)>,
    /// Halfspaces, sorted by stage.
    pub halfspaces: Vec<HalfspaceRow<S>>,
    /// Index of the first halfspace of every stage, and the total number.
    pub first_halfspace: Vec<usize>,
    /// Bounds of every variable.
    pub bounds: Vec<Bounds<S>>,
    /// Number of complementarity products of every lane.
    pub pairs: Lanes<S>,
}

/// `left w_k + right w_{k+1} + theta θ = rhs`.
#[derive(Clone, Debug)]
pub struct DynamicsConstraint<S: Simd4> {
    /// Coefficients of w_k.
    pub left: Matrix<S, DYNAMICS_ROWS, STAGE_LEN>,
    /// Coefficients of w_{k+1}.
    pub right: Matrix<S, DYNAMICS_ROWS, STAGE_LEN>,
    /// Coefficients of θ.
    pub theta: [Lanes<S>; DYNAMICS_ROWS],
    /// Right-hand side.
    pub rhs: [Lanes<S>; DYNAMICS_ROWS],
}

/// `current · (w_k[0], w_k[1]) + next · (w_{k+1}[0], w_{k+1}[1]) <= bound`.
#[derive(Clone, Copy, Debug)]
pub struct HalfspaceRow<S: Simd4> {
    /// Index into z of w_k[0].
    pub current_index: usize,
    /// Index into z of w_{k+1}[0]; of w_k[0] in the last stage, where `next` is zero.
    pub next_index: usize,
    /// Coefficients of stage k.
    pub current: [Lanes<S>; 2],
    /// Coefficients of stage k + 1.
    pub next: [Lanes<S>; 2],
    /// Right-hand side.
    pub bound: Lanes<S>,
    /// Has any lane a coefficient in stage k + 1?
    pub spans: bool,
    /// 1 in lanes that have this halfspace, 0 where it is absent.
    pub present: Lanes<S>,
}

/// Bounds of one variable.
#[derive(Clone, Copy, Debug)]
pub struct Bounds<S: Simd4> {
    /// Hard lower bound.
    pub box_lower: Lanes<S>,
    /// Hard upper bound.
    pub box_upper: Lanes<S>,
    /// Elastic lower bound.
    pub soft_lower: Lanes<S>,
    /// Elastic upper bound.
    pub soft_upper: Lanes<S>,
    /// Scale of the elastic bounds.
    pub row_scale: RowScale<S>,
}

/// How a violation of a row counts.
#[derive(Clone, Copy, Debug)]
pub struct RowScale<S: Simd4> {
    /// Its unit u.
    pub unit: Lanes<S>,
    /// The violation up to which it is rounding and counts as none; 0 unless the weight is large.
    pub resolution: Lanes<S>,
}

impl<S: Simd4> RowScale<S> {
    /// Lanes in which the weight of the row is large.
    #[inline(always)]
    pub fn is_stiff(&self) -> Mask<S> {
        self.resolution.is_above(self.resolution.like(0.0))
    }
}

impl<S: Simd4> Batch<S> {
    /// An empty batch.
    pub fn new(simd: S) -> Self {
        let zero = Lanes::splat(simd, 0.0);
        Self {
            simd,
            theta_cost: zero,
            penalty: zero,
            row_scales: [RowScale { unit: zero, resolution: zero }; STAGE_LEN],
            dynamics: Vec::new(),
            fixed_variables: Vec::new(),
            halfspaces: Vec::new(),
            first_halfspace: Vec::new(),
            bounds: Vec::new(),
            pairs: zero,
        }
    }

    /// Number K of intervals.
    pub fn intervals(&self) -> usize {
        self.dynamics.len()
    }

    /// Length of z.
    pub fn len(&self) -> usize {
        self.bounds.len()
    }

    /// Weight μ u of a row: its largest multiplier.
    #[inline(always)]
    pub fn weight(&self, scale: &RowScale<S>) -> Lanes<S> {
        self.penalty * scale.unit
    }

    /// Has a lane rows of large weight?
    pub fn is_stiff(&self, lane: usize) -> bool {
        self.row_scales.iter().any(|scale| scale.resolution.lane(lane) > 0.0)
    }

    /// Sets one program per lane; all must have the [same shape](Program::has_shape_of).
    pub fn set(&mut self, programs: [&Program; WIDTH]) {
        let simd = self.simd;
        let lanes = |value: &dyn Fn(&Program) -> f64| Lanes::new(simd, programs.map(value));
        self.theta_cost = lanes(&|program| program.theta_cost);
        self.penalty = lanes(&|program| program.penalty);
        let resolutions = programs.map(Program::resolutions);
        let row_scale = |component: usize, index: usize| RowScale {
            unit: lanes(&|program| program.unit(index)),
            resolution: Lanes::new(simd, resolutions.map(|resolutions| resolutions[component])),
        };
        self.row_scales = std::array::from_fn(|i| row_scale(i, i));
        self.pairs = lanes(&|program| 2.0 * (program.len() + program.equalities() + program.inequalities()) as f64);
        self.fixed_variables.clear();
        let fixed_variables = programs[0].fixed_variables.iter().enumerate();
        self.fixed_variables.extend(
            fixed_variables.map(|(i, fixed)| (fixed.index, lanes(&|program| program.fixed_variables[i].value))),
        );
        self.bounds.clear();
        self.bounds.extend((0..programs[0].len()).map(|i| Bounds {
            box_lower: lanes(&|program| program.box_lower[i]),
            box_upper: lanes(&|program| program.box_upper[i]),
            soft_lower: lanes(&|program| program.soft_lower[i]),
            soft_upper: lanes(&|program| program.soft_upper[i]),
            row_scale: row_scale(programs[0].component(i), i),
        }));
        self.set_dynamics(programs);
        self.set_halfspaces(programs);
    }

    fn set_dynamics(&mut self, programs: [&Program; WIDTH]) {
        let simd = self.simd;
        let zero = Lanes::splat(simd, 0.0);
        let empty = DynamicsConstraint {
            left: [[zero; STAGE_LEN]; DYNAMICS_ROWS],
            right: [[zero; STAGE_LEN]; DYNAMICS_ROWS],
            theta: [zero; DYNAMICS_ROWS],
            rhs: [zero; DYNAMICS_ROWS],
        };
        self.dynamics.resize(programs[0].intervals(), empty);
        for (k, constraint) in self.dynamics.iter_mut().enumerate() {
            let [a, b, c, d] = programs.map(|program| &program.dynamics[k]);
            for i in 0..DYNAMICS_ROWS {
                for j in 0..STAGE_LEN {
                    let at = (i, j);
                    constraint.left[i][j] = Lanes::new(simd, [a.left[at], b.left[at], c.left[at], d.left[at]]);
                    constraint.right[i][j] = Lanes::new(simd, [a.right[at], b.right[at], c.right[at], d.right[at]]);
                }
                constraint.theta[i] = Lanes::new(simd, [a.theta[i], b.theta[i], c.theta[i], d.theta[i]]);
                constraint.rhs[i] = Lanes::new(simd, [a.rhs[i], b.rhs[i], c.rhs[i], d.rhs[i]]);
            }
        }
    }

    fn set_halfspaces(&mut self, programs: [&Program; WIDTH]) {
        let stages = programs[0].intervals() + 1;
        let mut rest = programs.map(|program| program.halfspaces.as_slice());
        self.halfspaces.clear();
        self.first_halfspace.clear();
        for stage in 0..stages {
            self.first_halfspace.push(self.halfspaces.len());
            let own = rest.map(|halfspaces| halfspaces.iter().take_while(|halfspace| halfspace.stage == stage).count());
            for i in 0..own.into_iter().max().unwrap_or(0) {
                let halfspaces = std::array::from_fn(|lane| (i < own[lane]).then(|| &rest[lane][i]));
                self.halfspaces.push(HalfspaceRow::new(self.simd, stage, stages, halfspaces));
            }
            rest = std::array::from_fn(|lane| &rest[lane][own[lane]..]);
        }
        self.first_halfspace.push(self.halfspaces.len());
    }
}

impl<S: Simd4> HalfspaceRow<S> {
    fn new(simd: S, stage: usize, stages: usize, halfspaces: [Option<&HalfspaceConstraint>; WIDTH]) -> Self {
        let lanes = |value: &dyn Fn(&HalfspaceConstraint) -> f64, absent: f64| {
            Lanes::new(simd, halfspaces.map(|p| p.map_or(absent, value)))
        };
        Self {
            current_index: STAGE_LEN * stage,
            next_index: STAGE_LEN * (stage + 1).min(stages - 1),
            current: [lanes(&|halfspace| halfspace.current[0], 0.0), lanes(&|halfspace| halfspace.current[1], 0.0)],
            next: [lanes(&|halfspace| halfspace.next[0], 0.0), lanes(&|halfspace| halfspace.next[1], 0.0)],
            bound: lanes(&|halfspace| halfspace.bound, 1.0),
            spans: halfspaces.into_iter().flatten().any(HalfspaceConstraint::spans_two_stages),
            present: lanes(&|_| 1.0, 0.0),
        }
    }

    /// Lanes that have this halfspace.
    #[inline(always)]
    pub fn is_present(&self) -> Mask<S> {
        self.present.is_above(self.present.like(0.5))
    }

    /// `current · w_k + next · w_{k+1}`.
    #[inline(always)]
    pub fn value(&self, z: &[Lanes<S>]) -> Lanes<S> {
        let current = self.current[0] * z[self.current_index] + self.current[1] * z[self.current_index + 1];
        current + (self.next[0] * z[self.next_index] + self.next[1] * z[self.next_index + 1])
    }

    /// `out +=` the row times `multiplier`.
    #[inline(always)]
    pub fn add(&self, multiplier: Lanes<S>, out: &mut [Lanes<S>]) {
        for i in 0..2 {
            out[self.current_index + i] += self.current[i] * multiplier;
            out[self.next_index + i] += self.next[i] * multiplier;
        }
    }
}
