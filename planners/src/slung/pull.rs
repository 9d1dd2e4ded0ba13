//! Derivatives of what pulls at quadrotor and load beside the thrust, mode by mode: the taut cable's rates, a tension that
//! is free, the ground that carries the load.

use super::jet::Jet;
use super::translation::{ALPHA_OUT, BETA_OUT, LENGTH_OUT, Translation, add_both, carried};
use crate::pseudospectral::NodeDerivatives;

impl Translation<'_> {
    /// Taut: `m l_0/m_Q (α'^2 + cos^2 α β'^2) d` in the position's rows.
    #[inline(always)]
    pub(super) fn pull_of_rates(&self, derivatives: &mut NodeDerivatives) {
        let body = &self.model.problem.body;
        let gain = self.model.reduced_kg() * body.cable_m / body.quadrotor_kg;
        let squares = &self.rates.squares;
        let (width, count, cable_at) = (self.model.width(), self.model.cable_count(self.mode), self.model.cable_at());
        let mut pull = Jet::<3>::constant(0.0);
        for (k, d) in self.cable.direction.iter().enumerate() {
            let row = self.row(derivatives, k);
            self.add_rates(row, squares, gain * d.value);
            for (index, slope) in cable_at.into_iter().zip(d.gradient).take(count) {
                row[index] += gain * squares.value * slope;
            }
            pull = pull + *d * (gain * self.weights[k]);
        }
        pull.scatter(derivatives.hessian, width, cable_at, count, squares.value);
        self.scatter_rates(derivatives.hessian, &(*squares * pull.value));
        for (j, i) in (0..count).flat_map(|j| (0..5).map(move |i| (j, i))).filter(|&(_, i)| self.rates_used[i]) {
            let mixed = pull.gradient[j] * squares.gradient[i];
            add_both(derivatives.hessian, width, cable_at[j], self.rates_at[i], mixed);
        }
    }

    /// Parked: the ground carries the load's weight.
    #[inline(always)]
    pub(super) fn carried_weight(&self, derivatives: &mut NodeDerivatives) {
        let (width, cable_at) = (self.model.width(), self.model.cable_at());
        for output in [ALPHA_OUT, BETA_OUT, LENGTH_OUT] {
            let up = &self.axes[output][2];
            let row = self.row(derivatives, output);
            for (index, slope) in cable_at.into_iter().zip(up.gradient) {
                row[index] -= carried(self.mode) * slope;
            }
            up.scatter(derivatives.hessian, width, cable_at, 3, -carried(self.mode) * self.weights[output]);
        }
    }

    /// Either: the tension is a control.
    #[inline(always)]
    pub(super) fn free_tension(&self, derivatives: &mut NodeDerivatives) {
        let (width, tension, cable_at) = (self.model.width(), self.model.tension(), self.model.cable_at());
        let quadrotor_kg = self.model.problem.body.quadrotor_kg;
        self.row(derivatives, LENGTH_OUT)[tension] = -1.0 / self.model.reduced_kg();
        for (k, d) in self.cable.direction.iter().enumerate() {
            let weight = self.weights[k] / quadrotor_kg;
            let row = self.row(derivatives, k);
            row[tension] = d.value / quadrotor_kg;
            for (index, slope) in cable_at.into_iter().zip(d.gradient) {
                row[index] += self.tension_n / quadrotor_kg * slope;
            }
            d.scatter(derivatives.hessian, width, cable_at, 3, weight * self.tension_n);
            for (index, slope) in cable_at.into_iter().zip(d.gradient) {
                add_both(derivatives.hessian, width, index, tension, weight * slope);
            }
        }
    }
}
