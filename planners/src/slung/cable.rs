//! The cable's direction d(α, β), and with it the motion of quadrotor and load.
//!
//! With the specific thrust A = F/m_Q along b3, the tension λ, and m = m_Q m_L/(m_Q + m_L):
//!
//! ```text
//! p''     = A b3 + λ d/m_Q - g e3
//! α''     = -[ d_α.c/ρ + 2 ρ' α'/ρ + sin α cos α β'^2 ]
//! β''     = -[ d_β.c/(ρ cos^2 α) + 2 ρ' β'/ρ - 2 tan α α' β' ]
//! ρ''     = ρ (α'^2 + cos^2 α β'^2) - d.c - λ/m
//! taut:     λ = m [ l_0 (α'^2 + cos^2 α β'^2) - d.c ],   ρ = l_0
//! ```
//!
//! c is the acceleration of the quadrotor relative to the load's own: A b3 where the load falls, A b3 - g e3 where the
//! ground carries it.

use super::jet::Jet;

/// Direction from the quadrotor to the load with what the equations need of it.
#[derive(Clone, Copy, Debug)]
pub struct Cable<const N: usize> {
    /// d, a unit vector.
    pub direction: [Jet<N>; 3],
    /// -d_α/ρ.
    pub swing_alpha: [Jet<N>; 3],
    /// -d_β/(ρ cos^2 α).
    pub swing_beta: [Jet<N>; 3],
}

impl<const N: usize> Cable<N> {
    /// At (α, β, ρ), rad and m.
    #[inline(always)]
    pub fn at([alpha, beta, length]: [Jet<N>; 3]) -> Self {
        let ((s_a, c_a), (s_b, c_b)) = (alpha.sin_cos(), beta.sin_cos());
        let shorter = length.recip();
        let along_alpha = s_a * shorter;
        let across = (c_a * length).recip();
        Self {
            direction: [-(c_a * s_b), s_a, -(c_a * c_b)],
            swing_alpha: [-(along_alpha * s_b), -(c_a * shorter), -(along_alpha * c_b)],
            swing_beta: [c_b * across, Jet::constant(0.0), -(s_b * across)],
        }
    }
}

/// What the equations need of the rates.
#[derive(Clone, Copy, Debug)]
pub struct Rates<const N: usize> {
    /// The terms of α'' and β'' that hold rates, rad/s^2.
    pub alpha: Jet<N>,
    pub beta: Jet<N>,
    /// `α'^2 + cos^2 α β'^2`, and ρ times it.
    pub squares: Jet<N>,
    pub centrifugal: Jet<N>,
}

impl<const N: usize> Rates<N> {
    /// At (α, ρ, α', β', ρ').
    #[inline(always)]
    pub fn at([alpha, length, alpha_rate, beta_rate, length_rate]: [Jet<N>; 5]) -> Self {
        let (sin, cos) = alpha.sin_cos();
        let stretching = length_rate * length.recip() * -2.0;
        let around = cos * beta_rate;
        let squares = alpha_rate.square() + around.square();
        Self {
            alpha: stretching * alpha_rate - sin * around * beta_rate,
            beta: stretching * beta_rate + sin * cos.recip() * alpha_rate * beta_rate * 2.0,
            squares,
            centrifugal: length * squares,
        }
    }
}
