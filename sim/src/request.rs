//! What is to be simulated.

use rand_chacha::ChaCha8Rng;
use scenarios::in_loop::InLoopPlanner;
use scenarios::{Plan, Scenario, Vehicle};

use crate::flight::Flight;

/// Where the references of a flight come from.
pub enum ReferenceSource<'a> {
    /// A plan that was made before the flight.
    Plan(&'a Plan),
    /// In-loop planners, one per vehicle, in the order of the scenario.
    InLoop(Vec<Box<dyn InLoopPlanner>>),
    /// The references of an earlier flight that was planned in the loop, for as long as that flight lasted.
    Recorded(&'a Flight),
}

impl<'a> ReferenceSource<'a> {
    /// The plan.
    ///
    /// # Panics
    ///
    /// If the flight is planned in the loop, which only multirotors are.
    pub(crate) fn plan(&self) -> &'a Plan {
        match self {
            Self::Plan(plan) => plan,
            Self::InLoop(_) | Self::Recorded(_) => panic!("only multirotors are planned for in the loop"),
        }
    }
}

impl<'a> From<&'a Plan> for ReferenceSource<'a> {
    fn from(plan: &'a Plan) -> Self {
        Self::Plan(plan)
    }
}

impl From<Vec<Box<dyn InLoopPlanner>>> for ReferenceSource<'_> {
    fn from(planners: Vec<Box<dyn InLoopPlanner>>) -> Self {
        Self::InLoop(planners)
    }
}

/// What determines the controls.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ControlMode {
    /// The tracker, from the reference and the measured state.
    #[default]
    Tracker,
    /// The planned controls as a function of time, without feedback, inside the vehicle's limits.
    OpenLoop,
}

/// How a flight differs from an ordinary one, to examine plant and tracker separately: the tests compare open-loop
/// flights with an independent integrator, and let the tracker recover from a wrong start.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlightOptions {
    /// What determines the controls.
    pub control_mode: ControlMode,
    /// Start of every vehicle relative to the first state of its plan, world frame, m.
    pub start_offset_m: [f64; 3],
    /// Initial velocity over ground of every vehicle relative to the first state of its plan, world frame, m/s.
    pub start_velocity_offset_mps: [f64; 3],
    /// Number of times that the plant's step is halved, and with it the distance between samples of the air. Commands
    /// are still held, and the log written, once per step of the scenario.
    pub halvings: u32,
}

impl FlightOptions {
    /// An ordinary flight whose plant step is halved `halvings` times.
    pub fn finer(halvings: u32) -> Self {
        Self { halvings, ..Self::default() }
    }
}

/// What every family's simulation needs to know, besides the source of the references.
#[derive(Clone, Copy)]
pub(crate) struct FlightRequest<'a> {
    pub scenario: &'a Scenario,
    pub seed: u64,
    pub options: &'a FlightOptions,
    /// Number of steps to simulate, at most.
    pub steps: usize,
}

impl FlightRequest<'_> {
    /// The random numbers of one kind for one vehicle.
    pub fn stream(&self, kind: &str, vehicle: &Vehicle) -> ChaCha8Rng {
        scenarios::stream(self.seed, &format!("{kind}/{}", vehicle.name))
    }

    /// Step of the simulator, s.
    pub fn step_s(&self) -> f64 {
        self.scenario.simulation.step_s
    }

    /// Time at the beginning of a step, s.
    pub fn time_s(&self, step: usize) -> f64 {
        step as f64 * self.step_s()
    }

    /// Reports the time of a step if it is the first one of a second.
    pub fn report_second(&self, t_s: f64, progress: &mut dyn FnMut(f64)) {
        if t_s.floor() > (t_s - self.step_s()).floor() {
            progress(t_s);
        }
    }
}
