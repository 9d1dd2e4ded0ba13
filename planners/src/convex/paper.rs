//! The paper's own ways to the Newton direction (Wang, Xu, Long 2020, section 4 and Table 1), on its own form P4 of the
//! subproblem: what our block sweep is measured against.

mod dense;
mod form;
mod newton;
mod sparse_ldl;

pub use form::PaperForm;

use self::newton::{Elimination, PaperNewton};
use super::backend::Backend;
use super::boxed::Boxed;
use super::iterate::Iterate;
use super::lanes::Vector;
use super::newton::Newton;
use super::program::Program;
use dense::{DenseKkt, DenseReduced};
use sparse_ldl::SparseLdl;

/// Slacks of the equalities in P4 for one of p and n: s_2 = 2 n, λ_2 = (μ + y)/2; s_3 = 2 p, λ_3 = (μ - y)/2.
const EQUALITY_SCALE: f64 = 2.0;

/// The lane in which the paper's methods work.
const LANE: usize = 0;

/// Newton directions by way of P4.
#[derive(Clone, Debug)]
pub struct PaperSystem {
    method: Backend,
    /// Nothing before the first programme.
    newton: Option<PaperNewton>,
}

/// One row of P4 in an iterate: its slack and multiplier, and the target of their product.
struct Row {
    slack: f64,
    multiplier: f64,
    target: f64,
}

impl PaperSystem {
    /// No programme yet; nothing if `method` is not one of the paper's.
    pub fn new(method: Backend) -> Option<Self> {
        (method != Backend::Block).then_some(Self { method, newton: None })
    }

    /// Makes ready for a solve of `program`.
    pub fn begin(&mut self, program: &Program) {
        let form = PaperForm::new(program);
        match &mut self.newton {
            Some(newton) => newton.set_form(form),
            None => {
                let elimination = match self.method {
                    Backend::SparseLdl => Elimination::SparseLdl(SparseLdl::new(&form)),
                    Backend::DenseKkt => Elimination::DenseKkt(DenseKkt::new()),
                    Backend::DenseReduced | Backend::Block => Elimination::DenseReduced(DenseReduced::new()),
                };
                self.newton = Some(PaperNewton::new(form, elimination));
            }
        }
    }

    /// Factors the matrix at `at`.
    pub fn factor<S: Vector>(&mut self, at: &Iterate<S>) {
        let newton = self.newton.as_mut().expect("a solve begins with its programme");
        let values = newton.at.slack.iter_mut().zip(&mut newton.at.multiplier);
        for ((s, λ), row) in values.zip(rows(at)) {
            (*s, *λ) = (row.slack, row.multiplier);
        }
        newton.factor();
    }

    /// The direction for the targets in `at`, refined. Every iterate is feasible: there are no other residuals.
    pub fn direction<S: Vector>(&mut self, at: &Iterate<S>, ours: &mut Newton<S>) {
        let newton = self.newton.as_mut().expect("a solve begins with its programme");
        newton.residuals.dual.fill(0.0);
        newton.residuals.primal.fill(0.0);
        for (r_sl, row) in newton.residuals.product.iter_mut().zip(rows(at)) {
            *r_sl = -row.target;
        }
        newton.solve();
        newton.refine();
        let direction = &newton.direction;
        for (dz, x) in ours.step.z.iter_mut().zip(&direction.x) {
            dz[0].set_lane(LANE, *x);
        }
        let multipliers = &mut ours.multipliers;
        let (n_z, n_eq) = (ours.step.z.len(), ours.step.y.len() + multipliers.pins.len());
        // y = λ_2 - λ_3
        let (under, rest) = direction.multiplier[2 * n_z..].split_at(n_eq);
        let dy = under.iter().zip(rest).map(|(under, over)| under - over);
        for (own, dy) in ours.step.y.as_flattened_mut().iter_mut().chain(&mut multipliers.pins).zip(dy) {
            own.set_lane(LANE, dy);
        }
        let (upper, rest) = rest[n_eq..].split_at(n_z);
        let (lower, planes) = rest.split_at(n_z);
        for (own, (upper, lower)) in multipliers.bounds.iter_mut().zip(upper.iter().zip(lower)) {
            own[0].set_lane(LANE, *upper);
            own[1].set_lane(LANE, *lower);
        }
        for (own, dλ) in multipliers.planes.iter_mut().zip(planes) {
            own.set_lane(LANE, *dλ);
        }
    }
}

/// The rows of P4 in their order: box from above and below, equalities from above and below, inequalities, -β.
fn rows<S: Vector>(at: &Iterate<S>) -> impl Iterator<Item = Row> + '_ {
    let trust = || at.variables.iter().map(|variable| &variable.trust);
    let equalities = || at.links.as_flattened().iter().chain(&at.pins);
    let upper = || at.variables.iter().map(|variable| &variable.upper);
    let lower = || at.variables.iter().map(|variable| &variable.lower);
    let inequalities = move || upper().chain(lower()).chain(&at.planes);
    let primal = trust().map(room_above).chain(trust().map(room_below));
    let rows = equalities().map(force_below).chain(equalities().map(force_above));
    let rows = rows.map(|row| Row {
        slack: EQUALITY_SCALE * row.slack,
        multiplier: row.multiplier / EQUALITY_SCALE,
        target: row.target,
    });
    primal.chain(rows).chain(inequalities().map(force_below)).chain(inequalities().map(force_above))
}

/// a ⟂ c, the room being the slack.
fn room_above<S: Vector>(boxed: &Boxed<S>) -> Row {
    let [target, _] = boxed.targets().map(|target| target.lane(LANE));
    Row { slack: boxed.above.lane(LANE), multiplier: boxed.force_above.lane(LANE), target }
}

/// b ⟂ d, the room being the slack.
fn room_below<S: Vector>(boxed: &Boxed<S>) -> Row {
    let [_, target] = boxed.targets().map(|target| target.lane(LANE));
    Row { slack: boxed.below.lane(LANE), multiplier: boxed.force_below.lane(LANE), target }
}

/// a ⟂ c, the force being the slack.
fn force_above<S: Vector>(boxed: &Boxed<S>) -> Row {
    let row = room_above(boxed);
    Row { slack: row.multiplier, multiplier: row.slack, ..row }
}

/// b ⟂ d, the force being the slack.
fn force_below<S: Vector>(boxed: &Boxed<S>) -> Row {
    let row = room_below(boxed);
    Row { slack: row.multiplier, multiplier: row.slack, ..row }
}
