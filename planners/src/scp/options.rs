//! Options of the fixed-wing planners: those of the scenario, with the paper's values as defaults.

use scenarios::{PlannerSettings, Solver, Transcription, TrustRegion};

use super::dynamics::State;

/// Planner options with all defaults applied.
#[derive(Clone, Debug)]
pub struct Options {
    /// Transcription of the equations of motion.
    pub transcription: Transcription,
    /// Solver of the subproblems.
    pub solver: Solver,
    /// Number of intervals K.
    pub intervals: usize,
    /// Margin on separation and clearance, m.
    pub margin_m: f64,
    /// Penalty per scaled unit of violation.
    pub penalty: f64,
    /// Fraction by which the common time bound falls when all step lengths are at the bound.
    pub time_bound_release: f64,
    /// Maximum number of iterations.
    pub max_iterations: usize,
    /// Initial half-widths ρ of the trust region, in the units of the state.
    pub trust_region: State,
    /// Factor on ρ after each iteration.
    pub shrink: f64,
    /// Convergence thresholds of the change of a state, in its units.
    pub convergence: State,
}

impl Options {
    /// The options of the papers' planners. Defaults are those of Wang, Xu, Long (2020), section 5, except for the
    /// shrink factor of the trust region and the iteration limit, which the paper does not give.
    pub fn new(settings: &PlannerSettings) -> Self {
        let half_widths = |region: &TrustRegion| {
            let (χ, γ) = (region.heading_deg.to_radians(), region.flight_path_deg.to_radians());
            State::new(region.position_m, region.position_m, region.altitude_m, region.speed_mps, χ, γ)
        };
        let paper_trust_region = State::new(4000.0, 4000.0, 100.0, 20.0, 180_f64.to_radians(), 18_f64.to_radians());
        let paper_convergence = State::new(0.1, 0.1, 0.05, 0.01, 0.05_f64.to_radians(), 0.01_f64.to_radians());
        Self {
            transcription: settings.transcription.unwrap_or(Transcription::Trapezoid),
            solver: settings.solver.unwrap_or(Solver::Block),
            intervals: settings.intervals.unwrap_or(40),
            margin_m: settings.margin_m.unwrap_or(0.0),
            penalty: settings.penalty.unwrap_or(1000.0),
            time_bound_release: settings.time_bound_release.unwrap_or(0.0),
            max_iterations: settings.max_iterations.unwrap_or(60),
            trust_region: settings.trust_region.as_ref().map_or(paper_trust_region, half_widths),
            shrink: settings.trust_region.as_ref().map_or(0.7, |region| region.shrink),
            convergence: settings.convergence.as_ref().map_or(paper_convergence, |eps| {
                let (χ, γ) = (eps.heading_deg.to_radians(), eps.flight_path_deg.to_radians());
                State::new(eps.position_m, eps.position_m, eps.altitude_m, eps.speed_mps, χ, γ)
            }),
        }
    }

    /// The options of `fleet-scp`, with defaults of its own except for the number of intervals.
    ///
    /// The penalty is far below that of the papers, which makes early, badly linearised subproblems avoid every
    /// violation at any cost in flight time. It only needs to exceed the multipliers of the rows, a few seconds of step
    /// length per scaled unit.
    pub fn fleet(settings: &PlannerSettings) -> Self {
        let paper = Self::new(settings);
        let trust_region = State::new(100.0, 100.0, 25.0, 5.0, 0.2, 0.05);
        Self {
            transcription: Transcription::Shooting,
            margin_m: settings.margin_m.unwrap_or(0.5),
            penalty: settings.penalty.unwrap_or(20.0),
            time_bound_release: settings.time_bound_release.unwrap_or(0.03),
            trust_region: settings.trust_region.as_ref().map_or(trust_region, |_| paper.trust_region),
            shrink: settings.trust_region.as_ref().map_or(0.5, |region| region.shrink),
            ..paper
        }
    }
}
