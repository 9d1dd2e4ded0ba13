//! The optimal control problem of the planner (Kang, Huang, Wen 2020).

use scenarios::GRAVITY_MPS2;

use super::polygon::Polygon;
use crate::pseudospectral::Duration;

/// Masses, lengths and inertia.
#[derive(Clone, Debug, PartialEq)]
pub struct VehicleParameters {
    /// Mass of the quadrotor, kg.
    pub quadrotor_kg: f64,
    /// Mass of the load, kg.
    pub load_kg: f64,
    /// Full length l_0 of the cable, m.
    pub cable_m: f64,
    /// Distance L of the rotors from the roll and pitch axes, m.
    pub arm_m: f64,
    /// Yaw torque per thrust k of a rotor, m.
    pub yaw_m: f64,
    /// Principal moments of inertia about the body's x, y, z, kg m^2.
    pub inertia_kgm2: [f64; 3],
    /// Radius r_2 of the body circle, m.
    pub radius_m: f64,
    /// Radius of the load's ball, m.
    pub load_radius_m: f64,
}

/// Limits of the plan, [minimum, maximum] each.
#[derive(Clone, Debug, PartialEq)]
pub struct Limits {
    /// Thrust of a rotor, N.
    pub thrust_n: [f64; 2],
    /// Yaw, pitch and roll angles, rad.
    pub euler_rad: [f64; 2],
    /// Cable angles α and β, rad.
    pub cable_rad: [f64; 2],
    /// Largest tension of the taut cable, N.
    pub tension_n: f64,
    /// Position of the quadrotor, by coordinate, m.
    pub position_m: [[f64; 2]; 3],
    /// Safety distance r' of the envelope circle from the obstacles, m.
    pub clearance_m: f64,
    /// Minimum altitude of the load, m.
    pub floor_m: Option<f64>,
}

/// Weights of the running cost `x^T Q' x + u^T R' u`, and of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    /// Weight of the squares of (ψ, θ, φ).
    pub euler: f64,
    /// Weight of the squares of (α, β, ρ).
    pub cable: f64,
    /// Weight of the squares of (ψ', θ', φ').
    pub euler_rate: f64,
    /// Weight of the squares of (α', β', ρ').
    pub cable_rate: f64,
    /// Weight of the squares of the rotors' thrusts.
    pub thrust: f64,
    /// Cost per second.
    pub time: f64,
}

/// Other guesses of when a load is lifted off the ground, as fractions of the flight time: optima lie from 0.05 to 0.7.
const LIFT_OFF_FRACTIONS: [f64; 4] = [0.3, 0.15, 0.45, 0.6];

/// Cost per second of minimum-time problems: large enough for the barrier to be small in comparison, as it is beside
/// the effort.
const TIME_WEIGHT: f64 = 30.0;

/// Weight of the effort relative to time in minimum-time problems: it selects one of the controls that are equally
/// fast.
const EFFORT_PER_TIME: f64 = 3e-5;

impl Weights {
    /// Weights Q' and R' of the paper.
    pub fn effort() -> Self {
        Self { euler: 1.0, cable: 10.0, euler_rate: 10.0, cable_rate: 1.0, thrust: 10.0, time: 0.0 }
    }

    /// Weights of minimum-time problems.
    pub fn time() -> Self {
        let (effort, scale) = (Self::effort(), TIME_WEIGHT * EFFORT_PER_TIME);
        Self {
            euler: scale * effort.euler,
            cable: scale * effort.cable,
            euler_rate: scale * effort.euler_rate,
            cable_rate: scale * effort.cable_rate,
            thrust: scale * effort.thrust,
            time: TIME_WEIGHT,
        }
    }
}

/// Mode of the cable in a phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CableMode {
    /// Taut: its length is l_0, and the tension follows in closed form.
    Taut,
    /// Slack: the load is in free fall.
    Slack,
    /// Slack, with the load at rest on the ground.
    OnGround,
    /// Taut or slack at every node, by the paper's complementarity (eq. 2 to 4), relaxed to `λ (l_0 - ρ) <= ε` with the
    /// tension λ as a control.
    Complementarity {
        /// ε, N m.
        epsilon: f64,
    },
}

impl CableMode {
    /// Complementarity with a negligible relaxation. With larger ε, solutions treat the cable as a spring.
    pub const COMPLEMENTARITY: Self = Self::Complementarity { epsilon: 1e-6 };
}

/// What keeps clear of the obstacles, and in which form.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Avoidance {
    /// The envelope circle of eq. 19 and 20 as five smooth constraints per obstacle.
    #[default]
    SmoothEnvelope,
    /// The same circle by the paper's R-functions, one constraint per obstacle with kinks.
    RFunction,
    /// Body, cable and load, one constraint each per obstacle.
    Parts,
}

/// Meaning of the torques E u of the rotors (eq. 5).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TorqueModel {
    /// Torques about the body's axes, as on the vehicle.
    #[default]
    Body,
    /// Generalised torques of yaw, pitch and roll: the paper's approximation for small angles.
    Generalised,
}

/// Windows that quadrotor and load pass at one instant: [minimum, maximum] by coordinate, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    /// Window of the quadrotor.
    pub quadrotor_m: [[f64; 2]; 3],
    /// Window of the load.
    pub load_m: [[f64; 2]; 3],
}

/// A phase of the flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Phase {
    /// Mode of the cable.
    pub mode: CableMode,
    /// Duration.
    pub duration: Duration,
    /// Maximum impulse with which the cable may become taut at the end of the phase, N s; none for no limit.
    pub max_impulse_ns: Option<f64>,
    /// The gate that is passed at the end of the phase, if any.
    pub gate: Option<Gate>,
}

/// The initial state, at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialCondition {
    /// Position of the quadrotor, m.
    pub position_m: [f64; 3],
    /// Cable from the quadrotor to the load: (α, β, ρ), rad and m.
    pub cable: [f64; 3],
}

/// An optimal control problem of a quadrotor with a slung load.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Masses, lengths and inertia.
    pub vehicle: VehicleParameters,
    /// Limits.
    pub limits: Limits,
    /// Cost.
    pub weights: Weights,
    /// Cross-sections of the obstacles, which are vertical prisms.
    pub obstacles: Vec<Polygon>,
    /// Names of the obstacles.
    pub obstacle_names: Vec<String>,
    /// Lowest and highest altitude of the obstacles, m; only the separate parts of [`Avoidance::Parts`] use them.
    pub obstacle_altitudes_m: Vec<[f64; 2]>,
    /// What keeps clear of the obstacles, and in which form.
    pub avoidance: Avoidance,
    /// Meaning of the rotors' torques.
    pub torques: TorqueModel,
    /// Initial state, at rest.
    pub start: InitialCondition,
    /// Goal position of the quadrotor, at rest with the load hanging straight down, m.
    pub goal_m: [f64; 3],
    /// Phases of the flight.
    pub phases: Vec<Phase>,
}

impl Problem {
    /// The case of Kang, Huang, Wen 2020, with r_p = 0.127 m, which the paper does not give.
    pub fn paper() -> Self {
        let half = std::f64::consts::FRAC_PI_4;
        Self {
            vehicle: VehicleParameters {
                quadrotor_kg: 1.32,
                load_kg: 0.2,
                cable_m: 0.65,
                arm_m: 0.225,
                yaw_m: 1.0,
                inertia_kgm2: [0.01768, 0.01764, 0.026432],
                radius_m: 0.225 + 0.127,
                load_radius_m: 0.03,
            },
            limits: Limits {
                thrust_n: [1.0, 5.0],
                euler_rad: [-half, half],
                cable_rad: [-std::f64::consts::FRAC_PI_3, std::f64::consts::FRAC_PI_3],
                tension_n: f64::INFINITY,
                position_m: [[f64::NEG_INFINITY, f64::INFINITY]; 3],
                clearance_m: 0.05,
                floor_m: None,
            },
            weights: Weights::effort(),
            obstacles: vec![Polygon::rectangle([0.0, 0.0], [3.0, 2.0], -half)],
            obstacle_names: vec!["block".to_owned()],
            obstacle_altitudes_m: vec![[f64::NEG_INFINITY, f64::INFINITY]],
            avoidance: Avoidance::SmoothEnvelope,
            torques: TorqueModel::Body,
            start: InitialCondition { position_m: [-2.0, 0.0, 1.3], cable: [0.0, 0.0, 0.65] },
            goal_m: [2.0, 0.0, 1.5],
            phases: vec![Phase {
                mode: CableMode::Taut,
                duration: Duration::Fixed(4.0),
                max_impulse_ns: None,
                gate: None,
            }],
        }
    }

    /// Lowest and highest altitude of an obstacle, m; unbounded if none is given.
    pub fn altitudes_m(&self, obstacle: usize) -> [f64; 2] {
        self.obstacle_altitudes_m.get(obstacle).copied().unwrap_or([f64::NEG_INFINITY, f64::INFINITY])
    }

    /// Thrust of each rotor in hover with the load, N.
    pub fn hover_n(&self) -> f64 {
        0.25 * (self.vehicle.quadrotor_kg + self.vehicle.load_kg) * GRAVITY_MPS2
    }

    /// Whether any phase is under complementarity.
    pub fn has_complementarity(&self) -> bool {
        self.phases.iter().any(|phase| matches!(phase.mode, CableMode::Complementarity { .. }))
    }

    /// Cost of hovering for `duration_s`: the order of magnitude of the cost of a flight.
    pub fn hover_cost(&self, duration_s: f64) -> f64 {
        let Weights { thrust, cable, time, .. } = self.weights;
        duration_s * (4.0 * thrust * self.hover_n().powi(2) + cable * self.vehicle.cable_m.powi(2) + time)
    }

    /// The objective as reported: in seconds for minimum-time problems, else the cost itself.
    pub fn reported(&self, cost: f64) -> f64 {
        if self.weights.time > 0.0 { cost / self.weights.time } else { cost }
    }

    /// The same problem with other guesses of the instant at which the load is lifted off the ground: the method may converge
    /// from one of them and not from another. Empty if it does not lie there.
    pub fn other_lift_offs(&self) -> Vec<Self> {
        let total_s = self.guessed_time_s();
        let with_lift_off = |fraction: f64| {
            let mut problem = self.clone();
            let first = problem.phases.first_mut().filter(|phase| phase.mode == CableMode::OnGround)?;
            let Duration::Free { min_s, guess_s, max_s } = first.duration else { return None };
            let moved_s = (fraction * total_s).min(max_s).max(min_s);
            first.duration = Duration::Free { min_s, guess_s: moved_s, max_s };
            if let Some(Phase { duration: Duration::Free { guess_s: last_s, .. }, .. }) = problem.phases.last_mut() {
                *last_s = (*last_s + guess_s - moved_s).max(min_s);
            }
            Some(problem)
        };
        LIFT_OFF_FRACTIONS.into_iter().filter_map(with_lift_off).collect()
    }

    /// The guessed duration of the flight, s.
    fn guessed_time_s(&self) -> f64 {
        let guess_s = |phase: &Phase| match phase.duration {
            Duration::Free { guess_s, .. } => guess_s,
            Duration::Fixed(seconds) => seconds,
            Duration::Remainder(_) => 0.0,
        };
        let total_s = self.phases.iter().rev().find_map(|phase| match phase.duration {
            Duration::Remainder(total_s) => Some(total_s),
            _ => None,
        });
        total_s.unwrap_or_else(|| self.phases.iter().map(guess_s).sum())
    }

    /// The minimum-effort problem with the same phases, in the guessed total time.
    pub fn min_effort(&self) -> Self {
        let mut problem = Self { weights: Weights::effort(), ..self.clone() };
        let total_s = self.guessed_time_s();
        if let Some(last) = problem.phases.last_mut() {
            last.duration = Duration::Remainder(total_s);
        }
        problem
    }
}
