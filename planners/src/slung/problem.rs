//! The optimal control problem in the planner's own terms.

use super::polygon::Polygon;
use crate::pseudospectral::Duration;

/// Acceleration of gravity, m/s^2.
pub const GRAVITY: f64 = 9.81;

/// Masses, lengths and inertia.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Mass of the quadrotor, kg.
    pub quadrotor_kg: f64,
    /// Mass of the load, kg.
    pub load_kg: f64,
    /// Full length l_0 of the cable, m.
    pub cable_m: f64,
    /// Distance L of the rotors from the roll and pitch axes, m.
    pub arm_m: f64,
    /// Rotor's yaw torque per thrust k, m.
    pub yaw_m: f64,
    /// Principal moments of inertia about x, y, z of the body, kg m^2.
    pub inertia_kgm2: [f64; 3],
    /// Radius r_2 of the body's circle, m.
    pub radius_m: f64,
}

/// What the plan keeps to.
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
    /// Position of the quadrotor, lowest and highest of each coordinate, m.
    pub position_m: [[f64; 2]; 3],
    /// Distance r' kept from the obstacles, m.
    pub clearance_m: f64,
    /// Least altitude of the load, m.
    pub floor_m: Option<f64>,
}

/// Weights of the cost `x^T Q' x + u^T R' u`, and of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Weights {
    /// Of (ψ, θ, φ).
    pub euler: f64,
    /// Of (α, β, ρ).
    pub cable: f64,
    /// Of the Euler angles' rates.
    pub euler_rate: f64,
    /// Of the cable's rates.
    pub cable_rate: f64,
    /// Of each rotor's thrust.
    pub thrust: f64,
    /// Of a second.
    pub time: f64,
}

/// Weight of a second where time is what counts: large enough for the barrier to be small beside it, as it is beside the
/// effort.
const TIME: f64 = 30.0;

/// Weight of the effort beside the duration: next to nothing, but it tells apart controls that are equally fast.
const EFFORT_OF_TIME: f64 = 1e-4;

impl Weights {
    /// The paper's.
    pub fn effort() -> Self {
        Self { euler: 1.0, cable: 10.0, euler_rate: 10.0, cable_rate: 1.0, thrust: 10.0, time: 0.0 }
    }

    /// Time, with a trace of the paper's.
    pub fn time() -> Self {
        let (effort, share) = (Self::effort(), TIME * EFFORT_OF_TIME);
        Self {
            euler: share * effort.euler,
            cable: share * effort.cable,
            euler_rate: share * effort.euler_rate,
            cable_rate: share * effort.cable_rate,
            thrust: share * effort.thrust,
            time: TIME,
        }
    }
}

/// What the cable does in a phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// Taut: its length is l_0 and the tension follows in closed form.
    Taut,
    /// Slack: the load falls freely.
    Slack,
    /// Slack, and the load stands on the ground.
    Parked,
    /// Either, decided node by node: `λ (l_0 - ρ) <= ε` with the tension λ as a control; N m.
    Either {
        /// ε.
        epsilon: f64,
    },
}

impl Mode {
    /// The paper's complementarity, relaxed by next to nothing: larger ε lead into motions whose cable is a spring.
    pub const COMPLEMENTARITY: Self = Self::Either { epsilon: 1e-6 };
}

/// Where quadrotor and load have to be at one instant, lowest and highest of each coordinate, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gate {
    /// The quadrotor.
    pub quadrotor_m: [[f64; 2]; 3],
    /// The load.
    pub load_m: [[f64; 2]; 3],
}

/// A phase of the flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stage {
    /// What the cable does.
    pub mode: Mode,
    /// How long.
    pub duration: Duration,
    /// Largest impulse with which the cable may become taut at the end of the phase, N s; none where it does not matter.
    pub impulse_ns: Option<f64>,
    /// The gate that is passed at the end of the phase, if there is one.
    pub gate: Option<Gate>,
}

/// Rest at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Position of the quadrotor, m.
    pub position_m: [f64; 3],
    /// From the quadrotor to the load: (α, β, ρ), rad and m.
    pub cable: [f64; 3],
}

/// The problem.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// Masses, lengths and inertia.
    pub body: Body,
    /// Limits.
    pub limits: Limits,
    /// Cost.
    pub weights: Weights,
    /// Vertical prisms, by their sections.
    pub obstacles: Vec<Polygon>,
    /// Their names.
    pub obstacle_names: Vec<String>,
    /// Start, at rest.
    pub start: Rest,
    /// Where the quadrotor comes to rest, the load hanging straight down on the taut cable, m.
    pub goal_m: [f64; 3],
    /// The flight's phases.
    pub stages: Vec<Stage>,
}

impl Problem {
    /// The case of Kang, Huang, Wen 2020, with r_p = 0.127 m.
    pub fn paper() -> Self {
        let half = std::f64::consts::FRAC_PI_4;
        Self {
            body: Body {
                quadrotor_kg: 1.32,
                load_kg: 0.2,
                cable_m: 0.65,
                arm_m: 0.225,
                yaw_m: 1.0,
                inertia_kgm2: [0.01768, 0.01764, 0.026432],
                radius_m: 0.225 + 0.127,
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
            start: Rest { position_m: [-2.0, 0.0, 1.3], cable: [0.0, 0.0, 0.65] },
            goal_m: [2.0, 0.0, 1.5],
            stages: vec![Stage { mode: Mode::Taut, duration: Duration::Fixed(4.0), impulse_ns: None, gate: None }],
        }
    }

    /// Thrust of each rotor in hover with the load, N.
    pub fn hover_n(&self) -> f64 {
        0.25 * (self.body.quadrotor_kg + self.body.load_kg) * GRAVITY
    }

    /// Whether a phase leaves slack or taut to the optimiser.
    pub fn is_complementary(&self) -> bool {
        self.stages.iter().any(|stage| matches!(stage.mode, Mode::Either { .. }))
    }

    /// Cost of hovering for so long, s: about what a flight costs.
    pub fn hover_cost(&self, duration_s: f64) -> f64 {
        let Weights { thrust, cable, time, .. } = self.weights;
        duration_s * (4.0 * thrust * self.hover_n().powi(2) + cable * self.body.cable_m.powi(2) + time)
    }

    /// A cost as it is reported: where time counts, in seconds.
    pub fn reported(&self, cost: f64) -> f64 {
        if self.weights.time > 0.0 { cost / self.weights.time } else { cost }
    }

    /// The same flight at least effort, in the time that is guessed for it.
    pub fn at_leisure(&self) -> Self {
        let mut problem = Self { weights: Weights::effort(), ..self.clone() };
        let guess_s = |duration: Duration| match duration {
            Duration::Free { guess_s, .. } => guess_s,
            Duration::Fixed(seconds) => seconds,
            Duration::RestOf(_) => 0.0,
        };
        let total_s = self.stages.iter().map(|stage| guess_s(stage.duration)).sum();
        if let Some(last) = problem.stages.last_mut() {
            last.duration = Duration::RestOf(total_s);
        }
        problem
    }
}
