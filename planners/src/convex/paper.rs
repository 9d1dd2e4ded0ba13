//! The paper's own ways to the Newton direction (Wang, Xu, Long 2020, section 4 and Table 1), on its own form P4 of the
//! subproblem: what our block sweep is measured against.

mod dense;
mod form;
mod newton;
mod sparse_ldl;

pub use form::PaperForm;

use super::backend::Backend;
use super::newton::Newton;
use super::point::{Pairs, Point};
use super::program::Program;
use dense::{DenseKkt, DenseReduced};
use newton::{Elimination, PaperNewton};
use sparse_ldl::SparseLdl;

/// Slacks of the equalities in P4 for one of p and n: s_2 = 2 n, λ_2 = (μ + y)/2; s_3 = 2 p, λ_3 = (μ - y)/2.
const EQUALITY_SCALE: f64 = 2.0;

/// Newton directions of a [`Point`] by way of P4.
#[derive(Clone, Debug)]
pub struct PaperSystem {
    newton: PaperNewton,
}

impl PaperSystem {
    /// Room for programmes like `program`; nothing if `backend` is not one of the paper's.
    pub fn new(program: &Program, backend: Backend) -> Option<Self> {
        let form = PaperForm::new(program);
        let elimination = match backend {
            Backend::Block => return None,
            Backend::SparseLdl => Elimination::SparseLdl(SparseLdl::new(&form)),
            Backend::DenseReduced => Elimination::DenseReduced(DenseReduced::new()),
            Backend::DenseKkt => Elimination::DenseKkt(DenseKkt::new()),
        };
        Some(Self { newton: PaperNewton::new(form, elimination) })
    }

    /// Makes ready for a solve of `program`.
    pub fn begin(&mut self, program: &Program) {
        self.newton.set_form(PaperForm::new(program));
    }

    /// Factors the matrix at `point`.
    pub fn factor(&mut self, point: &Point) {
        let at = &mut self.newton.at;
        let rows = at.slack.iter_mut().zip(&mut at.multiplier);
        let values = families(point).into_iter().flat_map(|(pairs, scale)| {
            pairs.slack.iter().zip(&pairs.dual).map(move |(slack, dual)| (scale * slack, dual / scale))
        });
        for ((s, λ), (slack, multiplier)) in rows.zip(values) {
            (*s, *λ) = (slack, multiplier);
        }
        self.newton.factor();
    }

    /// The direction for the residuals and targets of `ours`.
    pub fn direction(&mut self, ours: &Newton, step: &mut Point) {
        let residuals = &mut self.newton.residuals;
        // the dual rows of α and β hold by construction: λ_2 + λ_3 = μ, λ_4 + λ_5 = μ
        residuals.dual.fill(0.0);
        residuals.dual[..ours.residual_dual.len()].copy_from_slice(&ours.residual_dual);
        // and so do the rows of the box and of -β
        let (n_z, n_eq, n_in) =
            (ours.residual_dual.len(), ours.residual_equality.len(), ours.residual_inequality.len());
        let (under, over, gap) = (2 * n_z, 2 * n_z + n_eq, 2 * n_z + 2 * n_eq);
        residuals.primal.fill(0.0);
        for (i, residual) in ours.residual_equality.iter().enumerate() {
            residuals.primal[under + i] = -residual;
            residuals.primal[over + i] = *residual;
        }
        for (r_p, residual) in residuals.primal[gap..gap + n_in].iter_mut().zip(&ours.residual_inequality) {
            *r_p = -residual;
        }
        let targets = families(&ours.target).into_iter().flat_map(|(pairs, _)| &pairs.slack);
        for (r_sl, target) in residuals.product.iter_mut().zip(targets) {
            *r_sl = -target;
        }
        self.newton.solve();
        self.write(step);
    }

    /// Refines the direction that was found last.
    pub fn refine(&mut self, step: &mut Point) {
        self.newton.refine();
        self.write(step);
    }

    /// The direction as a step of a point.
    fn write(&self, step: &mut Point) {
        let direction = &self.newton.direction;
        let n_z = step.z.len();
        step.z.copy_from_slice(&direction.x[..n_z]);
        let mut rows = direction.slack.iter().zip(&direction.multiplier);
        for (pairs, scale) in families_mut(step) {
            for ((slack, dual), (ds, dλ)) in pairs.slack.iter_mut().zip(&mut pairs.dual).zip(&mut rows) {
                (*slack, *dual) = (ds / scale, scale * dλ);
            }
        }
    }
}

/// The families of pairs in the order of the rows of P4, with s = scale · slack and λ = dual / scale.
fn families(point: &Point) -> [(&Pairs, f64); 6] {
    [
        (&point.upper, 1.0),
        (&point.lower, 1.0),
        (&point.under, EQUALITY_SCALE),
        (&point.over, EQUALITY_SCALE),
        (&point.gap, 1.0),
        (&point.excess, 1.0),
    ]
}

fn families_mut(point: &mut Point) -> [(&mut Pairs, f64); 6] {
    [
        (&mut point.upper, 1.0),
        (&mut point.lower, 1.0),
        (&mut point.under, EQUALITY_SCALE),
        (&mut point.over, EQUALITY_SCALE),
        (&mut point.gap, 1.0),
        (&mut point.excess, 1.0),
    ]
}
