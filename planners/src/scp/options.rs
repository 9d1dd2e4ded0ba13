//! Options of the planners of this family: the paper's values where the scenario is silent.

use scenarios::{PlannerSettings, Solver, Transcription, TrustRegion};

use super::dynamics::State;

/// Options with every default filled in.
#[derive(Clone, Debug)]
pub struct Options {
    /// How the equations of motion become rows.
    pub transcription: Transcription,
    /// Who solves the subproblems.
    pub solver: Solver,
    /// Number of intervals K.
    pub intervals: usize,
    /// Distance kept beyond separation and obstacles, m.
    pub margin_m: f64,
    /// Weight of violated rows.
    pub penalty: f64,
    /// Share by which the common time bound falls when the whole fleet sits on it.
    pub time_bound_release: f64,
    /// Most iterations.
    pub max_iterations: usize,
    /// Half-widths ρ of the trust region at the start, in the units of the state.
    pub trust_region: State,
    /// Factor on ρ after each iteration.
    pub shrink: f64,
    /// Largest change of a converged state, in its units.
    pub convergence: State,
}

impl Options {
    /// Fills in the values of Wang, Xu, Long (2020), section 5. The shrinking of the trust region and the iteration
    /// limit are ours.
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

    /// The same for `fleet-scp`, where all but the number of intervals is ours.
    ///
    /// The penalty is far below the papers': there it makes an early, badly linearised subproblem buy its way out of
    /// every violation with flight time. It only has to exceed the price of a violated row, which is a few seconds of
    /// step length per scaled unit.
    pub fn fleet(settings: &PlannerSettings) -> Self {
        let of_the_papers = Self::new(settings);
        let trust_region = State::new(100.0, 100.0, 25.0, 5.0, 0.2, 0.05);
        Self {
            transcription: Transcription::Shooting,
            margin_m: settings.margin_m.unwrap_or(0.5),
            penalty: settings.penalty.unwrap_or(20.0),
            time_bound_release: settings.time_bound_release.unwrap_or(0.03),
            trust_region: settings.trust_region.as_ref().map_or(trust_region, |_| of_the_papers.trust_region),
            shrink: settings.trust_region.as_ref().map_or(0.5, |region| region.shrink),
            ..of_the_papers
        }
    }
}
