use std::time::Instant;

use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;
use scenarios::Planning;
use scenarios::in_loop::{
    Decision, InLoopPlanner, Neighbour, Node, Observation, ObstacleMeasurement, PlannerRemarks, ReplanStatus,
};
use scenarios::multirotor::{Limits, Trajectory};

use super::acceptance::{Continuation, defect};
use super::planning_time::PlanningTime;
use super::sensed_world::SensedWorld;
use crate::multirotor::reference::Reference;
use crate::multirotor::state::NavigationState;
use crate::planning_log::Replan;

/// Times that differ by less than this, s, are equal up to rounding.
const ROUNDING_S: f64 = 1e-9;

/// Calls the planner of one vehicle, and keeps the reference in force.
pub(super) struct ReferenceManager {
    vehicle: usize,
    planner: Box<dyn InLoopPlanner>,
    settings: Planning,
    planning_time: PlanningTime,
    limits: Limits,
    step_s: f64,
    /// Scheduled calls that have passed, and the time of the first one, s.
    passed_calls: u64,
    phase_s: f64,
    /// Until when the planner is busy, s.
    busy_s: f64,
    in_force: Reference,
    /// An accepted reference, and the time at which it takes effect, s.
    pending: Option<(f64, Reference)>,
    last: ReplanStatus,
    /// The nodes of what was followed so far.
    followed: Vec<Node>,
}

/// What a vehicle knows when its planner is called.
pub(super) struct NavigationInput<'a> {
    /// Time, s.
    pub t_s: f64,
    /// What it knows of its own motion.
    pub own: NavigationState,
    pub sensed_world: &'a mut SensedWorld,
    pub moving: Vec<ObstacleMeasurement>,
    pub neighbours: Vec<Neighbour>,
}

/// What is specific to one vehicle.
pub(super) struct VehicleSettings {
    /// Its physical limits.
    pub limits: Limits,
    /// Step of the simulator, s.
    pub step_s: f64,
    /// Fraction of the period before the first call, in [0, 1).
    pub phase: f64,
    /// Where it hovers at the beginning, m.
    pub start_m: Vector3<f64>,
}

impl ReferenceManager {
    /// The reference in force at the beginning is to hover at the start.
    pub fn new(
        (vehicle, planner): (usize, Box<dyn InLoopPlanner>),
        settings: &Planning,
        rng: ChaCha8Rng,
        VehicleSettings { limits, step_s, phase, start_m }: VehicleSettings,
    ) -> Self {
        let hovering = Node::at_rest(0.0, start_m.into());
        Self {
            vehicle,
            planner,
            planning_time: PlanningTime::new(settings, rng),
            limits,
            step_s,
            passed_calls: 0,
            phase_s: phase * settings.period_s,
            busy_s: 0.0,
            in_force: Reference::new(vec![hovering]),
            pending: None,
            last: ReplanStatus::None,
            followed: vec![hovering],
            settings: settings.clone(),
        }
    }

    /// The reference in force.
    pub fn reference(&self) -> &Reference {
        &self.in_force
    }

    /// The nodes of the reference that was accepted last, whether it is in force already or pending.
    pub fn accepted(&self) -> &[Node] {
        self.pending.as_ref().map_or(&self.in_force, |(_, reference)| reference).nodes()
    }

    /// Puts the pending reference into force once its time has come.
    pub fn update(&mut self, t_s: f64) {
        let is_due = |(begin_s, _): &mut (f64, Reference)| *begin_s <= t_s + ROUNDING_S;
        let Some((begin_s, reference)) = self.pending.take_if(is_due) else { return };
        self.follow_until(begin_s);
        self.followed.push(reference.at(begin_s).node());
        self.in_force = reference;
    }

    /// Is a call of the planner scheduled, and is the planner free? A call that is missed is not made up for.
    pub fn is_due(&mut self, t_s: f64) -> bool {
        let call_s = |calls: u64| self.phase_s + calls as f64 * self.settings.period_s;
        let mut is_due = false;
        while call_s(self.passed_calls) <= t_s + ROUNDING_S {
            is_due = true;
            self.passed_calls += 1;
        }
        is_due && self.busy_s <= t_s + ROUNDING_S
    }

    /// Calls the planner. A result that can be flown becomes the pending reference.
    pub fn replan(&mut self, input: NavigationInput<'_>) -> Replan {
        let NavigationInput { t_s, own, sensed_world, moving, neighbours } = input;
        let discovered = sensed_world.take_discovered();
        let planned_s = self.ceil_to_step_s(t_s + self.settings.deadline_s);
        let observation = Observation {
            t_s,
            takes_effect_s: planned_s,
            position_m: own.measured.position_m.into(),
            velocity_mps: own.measured.velocity_mps.into(),
            acceleration_mps2: own.acceleration_mps2.into(),
            world_from_body: own.world_from_body.coords.into(),
            in_force: self.in_force.nodes(),
            last: &self.last,
            known: sensed_world.known(),
            discovered: &discovered,
            moving: &moving,
            neighbours: &neighbours,
        };
        let began = Instant::now();
        let result = self.planner.replan(&observation);
        let wall_s = began.elapsed().as_secs_f64();
        let ready_s = t_s + self.planning_time.next_s(wall_s);
        self.busy_s = ready_s;
        let takes_effect_s = planned_s.max(self.ceil_to_step_s(ready_s));
        let continuation = self.continuation(t_s, &own, planned_s);
        let (outcome, nodes) = self.accept(result.decision, &continuation, takes_effect_s);
        self.last = outcome.clone();
        let vehicle = self.vehicle;
        Replan {
            vehicle,
            asked_s: t_s,
            ready_s,
            takes_effect_s,
            outcome,
            nodes,
            diagnostics: result.diagnostics,
            discovered,
            wall_s,
        }
    }

    /// Ends the planner.
    pub fn finish_planner(&mut self) -> PlannerRemarks {
        self.planner.finish()
    }

    /// What was followed until `end_s`, as a trajectory.
    pub fn followed(mut self, vehicle: &str, end_s: f64) -> Trajectory {
        self.follow_until(end_s);
        // What was followed later belongs to the coast.
        let end = Reference::new(self.followed.clone()).at(end_s).node();
        self.followed.retain(|node| node.t_s < end_s - ROUNDING_S);
        self.followed.push(end);
        Trajectory::through(vehicle, &self.followed)
    }

    /// What a result has to continue that is planned for `planned_s`, s.
    fn continuation(&self, t_s: f64, own: &NavigationState, planned_s: f64) -> Continuation {
        let now = self.in_force.at(t_s);
        Continuation {
            takes_effect_s: planned_s,
            lead_s: planned_s - t_s,
            expected: self.in_force.before(planned_s),
            position_error_m: own.measured.position_m - now.position_m,
            velocity_error_mps: own.measured.velocity_mps - now.velocity_mps,
            limits: self.limits,
            step_s: self.step_s,
        }
    }

    fn accept(
        &mut self,
        decision: Decision,
        continuation: &Continuation,
        takes_effect_s: f64,
    ) -> (ReplanStatus, Vec<Node>) {
        let nodes = match decision {
            Decision::Keep { reason } => return (ReplanStatus::Kept { reason }, Vec::new()),
            Decision::Failed { reason } => return (ReplanStatus::Failed { reason }, Vec::new()),
            Decision::Fly(nodes) => nodes,
        };
        if let Some(reason) = defect(&nodes, continuation) {
            return (ReplanStatus::Rejected { reason }, Vec::new());
        }
        self.pending = Some((takes_effect_s, Reference::new(nodes.clone())));
        let by_s = takes_effect_s - continuation.takes_effect_s;
        (if by_s > ROUNDING_S { ReplanStatus::Late { by_s } } else { ReplanStatus::InTime }, nodes)
    }

    /// Appends the nodes of the reference in force up to `end_s`, and a node at `end_s`.
    fn follow_until(&mut self, end_s: f64) {
        let begin_s = self.followed.last().map_or(0.0, |node| node.t_s);
        let between = |node: &&Node| node.t_s > begin_s + ROUNDING_S && node.t_s < end_s - ROUNDING_S;
        self.followed.extend(self.in_force.nodes().iter().filter(between));
        if let Some(last) = self.in_force.nodes().last().filter(between) {
            // After its last node the vehicle hovers, even if the reference ends in motion.
            self.followed.push(Node { velocity_mps: [0.0; 3], ..*last });
        }
        if end_s > begin_s + ROUNDING_S {
            self.followed.push(self.in_force.before(end_s).node());
        }
    }

    /// Time of the simulator's first step that is not before `t_s`, s.
    fn ceil_to_step_s(&self, t_s: f64) -> f64 {
        (t_s / self.step_s - 1e-6).ceil() * self.step_s
    }
}
