//! The paper's methods for the Newton direction (Wang, Xu, Long 2020, section 4 and Table 1), on its form P4 of the
//! subproblem: the reference that the block factorisation is compared with.

mod dense;
mod inequality_form;
mod infeasible_loop;
mod kkt_system;
mod kkt_vectors;
mod sparse_ldl;

pub use inequality_form::InequalityForm;
pub use infeasible_loop::InfeasibleLoop;

use self::kkt_system::{Elimination, KktSystem};
use super::backend::Backend;
use super::complementarity::ComplementarityPair;
use super::iterate::Iterate;
use super::newton::NewtonSystem;
use super::program::Program;
use crate::simd::Simd4;
use dense::{DenseKkt, DenseReduced};
use sparse_ldl::SparseLdl;

/// Scale of the equality slacks in P4 relative to p and n: s_2 = 2 n, λ_2 = (μ + y)/2; s_3 = 2 p, λ_3 = (μ - y)/2.
const EQUALITY_SCALE: f64 = 2.0;

/// The lane of the program that is solved.
const LANE: usize = 0;

/// The Newton system in the form P4.
#[derive(Clone, Debug)]
pub struct ReferenceSystem {
    method: Backend,
    /// `None` before the first program.
    kkt: Option<KktSystem>,
}

/// Slack, multiplier and target of their product of one row of P4.
struct Row {
    slack: f64,
    multiplier: f64,
    target: f64,
}

impl ReferenceSystem {
    /// The system without a program; `None` if `method` is not one of the paper's.
    pub fn new(method: Backend) -> Option<Self> {
        (method != Backend::Block).then_some(Self { method, kkt: None })
    }

    /// Prepares for a solve of `program`.
    pub fn begin(&mut self, program: &Program) {
        let form = InequalityForm::new(program);
        match &mut self.kkt {
            Some(kkt) => kkt.set_form(form),
            None => self.kkt = Some(new_system(self.method, form)),
        }
    }

    /// Factors the matrix at `at`.
    pub fn factor<S: Simd4>(&mut self, at: &Iterate<S>) {
        let kkt = self.kkt.as_mut().expect("`begin` comes first");
        let values = kkt.at.slack.iter_mut().zip(&mut kkt.at.multiplier);
        for ((s, λ), row) in values.zip(rows(at)) {
            (*s, *λ) = (row.slack, row.multiplier);
        }
        kkt.factor();
    }

    /// Computes the refined direction for the targets in `at`. Every iterate is feasible, so the other residuals are
    /// zero.
    pub fn solve<S: Simd4>(&mut self, at: &Iterate<S>, newton: &mut NewtonSystem<S>) {
        let kkt = self.kkt.as_mut().expect("`begin` comes first");
        kkt.residuals.dual.fill(0.0);
        kkt.residuals.primal.fill(0.0);
        for (r_sl, row) in kkt.residuals.product.iter_mut().zip(rows(at)) {
            *r_sl = -row.target;
        }
        kkt.solve();
        kkt.refine();
        let direction = &kkt.direction;
        for (dz, x) in newton.step.z.iter_mut().zip(&direction.x) {
            dz[0].set_lane(LANE, *x);
        }
        let multipliers = &mut newton.multipliers;
        let (n_z, n_eq) = (newton.step.z.len(), newton.step.y.len() + multipliers.fixed_variables.len());
        // y = λ_2 - λ_3
        let (under, rest) = direction.multiplier[2 * n_z..].split_at(n_eq);
        let dy = under.iter().zip(rest).map(|(under, over)| under - over);
        for (own, dy) in newton.step.y.as_flattened_mut().iter_mut().chain(&mut multipliers.fixed_variables).zip(dy) {
            own.set_lane(LANE, dy);
        }
        let (upper, rest) = rest[n_eq..].split_at(n_z);
        let (lower, halfspaces) = rest.split_at(n_z);
        for (own, (upper, lower)) in multipliers.bounds.iter_mut().zip(upper.iter().zip(lower)) {
            own[0].set_lane(LANE, *upper);
            own[1].set_lane(LANE, *lower);
        }
        for (own, dλ) in multipliers.halfspaces.iter_mut().zip(halfspaces) {
            own.set_lane(LANE, *dλ);
        }
    }
}

/// The Newton system of `form`, for one of the paper's methods.
fn new_system(method: Backend, form: InequalityForm) -> KktSystem {
    let elimination = match method {
        Backend::SparseLdl => Elimination::SparseLdl(SparseLdl::new(&form)),
        Backend::DenseKkt => Elimination::DenseKkt(DenseKkt::new()),
        Backend::DenseReduced | Backend::Block => Elimination::DenseReduced(DenseReduced::new()),
    };
    KktSystem::new(form, elimination)
}

/// The rows of P4 in order: trust region from above and below, equalities from above and below, inequalities, -β.
fn rows<S: Simd4>(at: &Iterate<S>) -> impl Iterator<Item = Row> + '_ {
    let trust_region = || at.variables.iter().map(|variable| &variable.trust_region);
    let equalities = || at.dynamics.as_flattened().iter().chain(&at.fixed_variables);
    let upper = || at.variables.iter().map(|variable| &variable.upper);
    let lower = || at.variables.iter().map(|variable| &variable.lower);
    let inequalities = move || upper().chain(lower()).chain(&at.halfspaces);
    let primal = trust_region().map(upper_bound).chain(trust_region().map(lower_bound));
    let rows = equalities().map(lower_elastic).chain(equalities().map(upper_elastic));
    let rows = rows.map(|row| Row {
        slack: EQUALITY_SCALE * row.slack,
        multiplier: row.multiplier / EQUALITY_SCALE,
        target: row.target,
    });
    primal.chain(rows).chain(inequalities().map(lower_elastic)).chain(inequalities().map(upper_elastic))
}

/// a ⟂ c with the slack a and the multiplier c.
fn upper_bound<S: Simd4>(pair: &ComplementarityPair<S>) -> Row {
    let [target, _] = pair.targets().map(|target| target.lane(LANE));
    Row { slack: pair.slack_upper.lane(LANE), multiplier: pair.dual_upper.lane(LANE), target }
}

/// b ⟂ d with the slack b and the multiplier d.
fn lower_bound<S: Simd4>(pair: &ComplementarityPair<S>) -> Row {
    let [_, target] = pair.targets().map(|target| target.lane(LANE));
    Row { slack: pair.slack_lower.lane(LANE), multiplier: pair.dual_lower.lane(LANE), target }
}

/// a ⟂ c with the slack c and the multiplier a.
fn upper_elastic<S: Simd4>(pair: &ComplementarityPair<S>) -> Row {
    let row = upper_bound(pair);
    Row { slack: row.multiplier, multiplier: row.slack, ..row }
}

/// b ⟂ d with the slack d and the multiplier b.
fn lower_elastic<S: Simd4>(pair: &ComplementarityPair<S>) -> Row {
    let row = lower_bound(pair);
    Row { slack: row.multiplier, multiplier: row.slack, ..row }
}
