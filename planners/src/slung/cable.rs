//! Direction d(α, β) of the cable, and the dynamics of quadrotor and load in polar coordinates (Kang, Huang, Wen 2020,
//! eq. 1, in Newton's form; the sign of d follows from eq. 14).
//!
//! With the specific thrust A = F/m_Q along b3, the tension λ, and the reduced mass m = m_Q m_L/(m_Q + m_L):
//!
//! ```text
//! d       = (-cos α sin β, sin α, -cos α cos β)
//! p''     = A b3 + λ d/m_Q - g e3
//! α''     = -[ d_α.c/ρ + 2 ρ' α'/ρ + sin α cos α β'^2 ]
//! β''     = -[ d_β.c/(ρ cos^2 α) + 2 ρ' β'/ρ - 2 tan α α' β' ]
//! ρ''     = ρ (α'^2 + cos^2 α β'^2) - d.c - λ/m
//! taut:     λ = m [ l_0 (α'^2 + cos^2 α β'^2) - d.c ],   ρ = l_0
//! ```
//!
//! c is the acceleration of the quadrotor, without the cable's pull, relative to that of the load: A b3 in flight, and
//! A b3 - g e3 where the ground carries the load.

use super::jet::Jet;

/// Direction of the cable and its scaled derivatives.
#[derive(Clone, Copy, Debug)]
pub struct CableGeometry<const N: usize> {
    /// d, the unit vector from the quadrotor to the load.
    pub direction: [Jet<N>; 3],
    /// -d_α/ρ, 1/m.
    pub swing_alpha: [Jet<N>; 3],
    /// -d_β/(ρ cos^2 α), 1/m.
    pub swing_beta: [Jet<N>; 3],
}

impl<const N: usize> CableGeometry<N> {
    /// Geometry at (α, β, ρ), rad and m.
    #[inline(always)]
    pub fn at([alpha, beta, length]: [Jet<N>; 3]) -> Self {
        let ((s_a, c_a), (s_b, c_b)) = (alpha.sin_cos(), beta.sin_cos());
        let inverse_length = length.recip();
        let along_alpha = s_a * inverse_length;
        let across = (c_a * length).recip();
        Self {
            direction: [-(c_a * s_b), s_a, -(c_a * c_b)],
            swing_alpha: [-(along_alpha * s_b), -(c_a * inverse_length), -(along_alpha * c_b)],
            swing_beta: [c_b * across, Jet::constant(0.0), -(s_b * across)],
        }
    }
}

/// Terms of the dynamics that depend on the cable's rates.
#[derive(Clone, Copy, Debug)]
pub struct CableRates<const N: usize> {
    /// `-2 ρ' α'/ρ - sin α cos α β'^2`, rad/s^2.
    pub alpha: Jet<N>,
    /// `-2 ρ' β'/ρ + 2 tan α α' β'`, rad/s^2.
    pub beta: Jet<N>,
    /// `α'^2 + cos^2 α β'^2`, rad^2/s^2.
    pub squares: Jet<N>,
    /// `ρ (α'^2 + cos^2 α β'^2)`, m/s^2.
    pub centrifugal: Jet<N>,
}

impl<const N: usize> CableRates<N> {
    /// Terms at (α, ρ, α', β', ρ'), rad, m, rad/s and m/s.
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
