//! Options of the fixed-wing planners: those of the scenario, with the paper's values as defaults.

use scenarios::{PlannerSettings, Solver, SolverStart, Transcription, TrustRegion};

use super::dynamics::State;
use super::scaling::NODE_UNITS;
use crate::convex::{STAGE_LEN, Start};

/// Planner options with all defaults applied.
#[derive(Clone, Debug)]
pub struct Options {
    /// Transcription of the equations of motion.
    pub transcription: Transcription,
    /// Solver of the subproblems.
    pub solver: Solver,
    /// Where that solver starts.
    pub solver_start: Start,
    /// Number of intervals K.
    pub intervals: usize,
    /// Margin on separation and clearance, m.
    pub margin_m: f64,
    /// Penalty μ per unit of violation, s.
    pub penalty: f64,
    /// Units in which violations of the rows in (x, y, h, V, χ, γ, n_x, n_y, n_z) are measured, per scaled unit.
    pub row_units: [f64; STAGE_LEN],
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
    /// Thresholds of priorities and of the common arrival.
    pub coordination: Coordination,
}

/// Thresholds of priorities and of the common arrival (Xu et al. 2022, eq. 17 to 19). The paper's values are lost; the
/// defaults are ours.
#[derive(Clone, Debug)]
pub struct Coordination {
    /// Difference of two flight times beyond which two vehicles swap ranks, s.
    pub swap_threshold_s: f64,
    /// Largest change of a damped step length between two iterations, s.
    pub damped_change_s: f64,
    /// Largest spread of the flight times of a fleet that arrives together, s.
    pub arrival_spread_s: f64,
    /// Maximum number of rounds of `serial-scp`.
    pub max_rounds: usize,
}

impl Coordination {
    fn new(settings: &scenarios::Coordination) -> Self {
        Self {
            swap_threshold_s: settings.swap_threshold_s.unwrap_or(0.5),
            damped_change_s: settings.damped_change_s.unwrap_or(0.05),
            arrival_spread_s: settings.arrival_spread_s.unwrap_or(0.1),
            max_rounds: settings.max_rounds.unwrap_or(20),
        }
    }
}

impl Options {
    /// The options of the papers' planners. Defaults are those of Wang, Xu, Long (2020), section 5, except for the
    /// shrink factor of the trust region and the iteration limit, which the papers do not give. In the exchange of 100
    /// the trust region may not shrink faster: with 0.7 it closes on vehicles that are still between others.
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
            solver_start: match settings.solver_start.unwrap_or_default() {
                SolverStart::Feasible => Start::Feasible,
                SolverStart::Infeasible => Start::Infeasible,
            },
            intervals: settings.intervals.unwrap_or(40),
            margin_m: settings.margin_m.unwrap_or(0.0),
            penalty: settings.penalty.unwrap_or(1000.0),
            // violations in SI units
            row_units: NODE_UNITS,
            time_bound_release: settings.time_bound_release.unwrap_or(0.0),
            max_iterations: settings.max_iterations.unwrap_or(90),
            trust_region: settings.trust_region.as_ref().map_or(paper_trust_region, half_widths),
            shrink: settings.trust_region.as_ref().map_or(0.85, |region| region.shrink),
            convergence: settings.convergence.as_ref().map_or(paper_convergence, |eps| {
                let (χ, γ) = (eps.heading_deg.to_radians(), eps.flight_path_deg.to_radians());
                State::new(eps.position_m, eps.position_m, eps.altitude_m, eps.speed_mps, χ, γ)
            }),
            coordination: Coordination::new(&settings.coordination.clone().unwrap_or_default()),
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
            row_units: [1.0; STAGE_LEN],
            time_bound_release: settings.time_bound_release.unwrap_or(0.03),
            max_iterations: settings.max_iterations.unwrap_or(100),
            trust_region: settings.trust_region.as_ref().map_or(trust_region, |_| paper.trust_region),
            shrink: settings.trust_region.as_ref().map_or(0.5, |region| region.shrink),
            ..paper
        }
    }
}
