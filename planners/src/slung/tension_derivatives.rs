//! Derivatives of the forces other than thrust, by mode: the pull of the taut cable due to its rates, a free tension,
//! and the ground's support of the load.

use super::jet::Jet;
use super::translation::{ALPHA_OUT, BETA_OUT, LENGTH_OUT, Translation, add_symmetric, ground_support};
use crate::pseudospectral::NodeDerivatives;

impl Translation<'_> {
    /// Taut: `m l_0/m_Q (α'^2 + cos^2 α β'^2) d` in the accelerations of the position.
    #[inline(always)]
    pub(super) fn differentiate_centrifugal_pull(&self, derivatives: &mut NodeDerivatives) {
        let vehicle = &self.system.problem.vehicle;
        let gain = self.system.reduced_kg() * vehicle.cable_m / vehicle.quadrotor_kg;
        let squares = &self.rates.squares;
        let (width, count, cable_at) =
            (self.system.width(), self.system.cable_count(self.mode), self.system.cable_indices());
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
        for (j, i) in (0..count).flat_map(|j| (0..5).map(move |i| (j, i))).filter(|&(_, i)| self.is_rate_variable[i]) {
            let mixed = pull.gradient[j] * squares.gradient[i];
            add_symmetric(derivatives.hessian, width, cable_at[j], self.rate_indices[i], mixed);
        }
    }

    /// On the ground: `-g axis_z` in the accelerations of the cable.
    #[inline(always)]
    pub(super) fn differentiate_ground_support(&self, derivatives: &mut NodeDerivatives) {
        let (width, cable_at) = (self.system.width(), self.system.cable_indices());
        for output in [ALPHA_OUT, BETA_OUT, LENGTH_OUT] {
            let up = &self.axes[output][2];
            let row = self.row(derivatives, output);
            for (index, slope) in cable_at.into_iter().zip(up.gradient) {
                row[index] -= ground_support(self.mode) * slope;
            }
            up.scatter(derivatives.hessian, width, cable_at, 3, -ground_support(self.mode) * self.weights[output]);
        }
    }

    /// Complementarity: `λ d/m_Q` in the accelerations of the position, `-λ/m` in that of the length; λ is a control.
    #[inline(always)]
    pub(super) fn differentiate_free_tension(&self, derivatives: &mut NodeDerivatives) {
        let (width, tension, cable_at) = (self.system.width(), self.system.tension(), self.system.cable_indices());
        let quadrotor_kg = self.system.problem.vehicle.quadrotor_kg;
        self.row(derivatives, LENGTH_OUT)[tension] = -1.0 / self.system.reduced_kg();
        for (k, d) in self.cable.direction.iter().enumerate() {
            let weight = self.weights[k] / quadrotor_kg;
            let row = self.row(derivatives, k);
            row[tension] = d.value / quadrotor_kg;
            for (index, slope) in cable_at.into_iter().zip(d.gradient) {
                row[index] += self.tension_n / quadrotor_kg * slope;
            }
            d.scatter(derivatives.hessian, width, cable_at, 3, weight * self.tension_n);
            for (index, slope) in cable_at.into_iter().zip(d.gradient) {
                add_symmetric(derivatives.hessian, width, index, tension, weight * slope);
            }
        }
    }
}
