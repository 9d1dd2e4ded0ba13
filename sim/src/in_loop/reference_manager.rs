use std::time::Instant;

use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;
use scenarios::Planning;
use scenarios::in_loop::{Decision, InLoopPlanner, Neighbour, Node, Observation, ObstacleMeasurement, ReplanStatus};
use scenarios::multirotor::Trajectory;

use super::acceptance::defect;
use super::planning_time::PlanningTime;
use super::{Replan, SensedWorld};
use crate::multirotor::Reference;
use crate::sensors::Measurement;

/// What rounding leaves of an instant, s.
const ROUNDING_S: f64 = 1e-9;

/// Asks one vehicle's planner, and says what is flown.
pub(crate) struct ReferenceManager {
    vehicle: usize,
    planner: Box<dyn InLoopPlanner>,
    settings: Planning,
    planning_time: PlanningTime,
    step_s: f64,
    /// Turns taken so far, and the first one's instant, s.
    turns: u64,
    phase_s: f64,
    /// Until when the planner is busy, s.
    busy_s: f64,
    in_force: Reference,
    /// A reference that waits for its instant, s.
    pending: Option<(f64, Reference)>,
    last: ReplanStatus,
    /// What was flown so far.
    followed: Vec<Node>,
}

/// Where a vehicle is, as it measures itself, and what it has seen.
pub(crate) struct NavigationInput<'a> {
    pub t_s: f64,
    pub own: Measurement,
    pub senses: &'a mut SensedWorld,
    pub moving: Vec<ObstacleMeasurement>,
    pub neighbours: Vec<Neighbour>,
}

impl ReferenceManager {
    /// At the beginning the vehicle stands at its start, m.
    ///
    /// - `share`: of the period that passes before the first turn, in [0, 1)
    pub fn new(
        (vehicle, planner): (usize, Box<dyn InLoopPlanner>),
        settings: &Planning,
        rng: ChaCha8Rng,
        step_s: f64,
        share: f64,
        start_m: Vector3<f64>,
    ) -> Self {
        let standing = Node::at_rest(0.0, start_m.into());
        Self {
            vehicle,
            planner,
            planning_time: PlanningTime::new(settings, rng),
            step_s,
            turns: 0,
            phase_s: share * settings.period_s,
            busy_s: 0.0,
            in_force: Reference::new(vec![standing]),
            pending: None,
            last: ReplanStatus::None,
            followed: vec![standing],
            settings: settings.clone(),
        }
    }

    /// The reference now.
    pub fn reference(&self) -> &Reference {
        &self.in_force
    }

    /// What it has accepted last, whether it is flown already or not.
    pub fn intent(&self) -> &[Node] {
        self.pending.as_ref().map_or(&self.in_force, |(_, reference)| reference).nodes()
    }

    /// Puts a reference into force whose instant has come.
    pub fn install(&mut self, t_s: f64) {
        let is_due = |(from_s, _): &mut (f64, Reference)| *from_s <= t_s + ROUNDING_S;
        let Some((from_s, reference)) = self.pending.take_if(is_due) else { return };
        self.follow_until(from_s);
        self.followed.push(reference.at(from_s).node());
        self.in_force = reference;
    }

    /// Is it the planner's turn, and is he free? A turn that he misses is gone.
    pub fn is_due(&mut self, t_s: f64) -> bool {
        let turn_s = |turns: u64| self.phase_s + turns as f64 * self.settings.period_s;
        let mut is_due = false;
        while turn_s(self.turns) <= t_s + ROUNDING_S {
            is_due = true;
            self.turns += 1;
        }
        is_due && self.busy_s <= t_s + ROUNDING_S
    }

    /// Asks the planner.
    pub fn ask(&mut self, fix: NavigationInput<'_>) -> Replan {
        let NavigationInput { t_s, own, senses, moving, neighbours } = fix;
        let discovered = senses.news();
        let planned_s = self.on_step(t_s + self.settings.deadline_s);
        let observation = Observation {
            t_s,
            takes_effect_s: planned_s,
            position_m: own.position_m.into(),
            velocity_mps: own.velocity_mps.into(),
            in_force: self.in_force.nodes(),
            last: &self.last,
            known: senses.known(),
            discovered: &discovered,
            moving: &moving,
            neighbours: &neighbours,
        };
        let began = Instant::now();
        let answer = self.planner.replan(&observation);
        let wall_s = began.elapsed().as_secs_f64();
        let ready_s = t_s + self.planning_time.next_s(wall_s);
        self.busy_s = ready_s;
        let takes_effect_s = planned_s.max(self.on_step(ready_s));
        let (outcome, nodes) = self.take(answer.decision, planned_s, takes_effect_s);
        self.last = outcome.clone();
        let vehicle = self.vehicle;
        Replan {
            vehicle,
            asked_s: t_s,
            ready_s,
            takes_effect_s,
            outcome,
            nodes,
            diagnostics: answer.diagnostics,
            discovered,
            wall_s,
        }
    }

    /// What was flown to `end_s`, as a trajectory.
    pub fn followed(mut self, vehicle: &str, end_s: f64) -> Trajectory {
        self.follow_until(end_s);
        // What was flown beyond it belongs to the coast.
        let end = Reference::new(self.followed.clone()).at(end_s).node();
        self.followed.retain(|node| node.t_s < end_s - ROUNDING_S);
        self.followed.push(end);
        Trajectory::through(vehicle, &self.followed)
    }

    fn take(&mut self, decision: Decision, planned_s: f64, takes_effect_s: f64) -> (ReplanStatus, Vec<Node>) {
        let nodes = match decision {
            Decision::Keep { reason } => return (ReplanStatus::Kept { reason }, Vec::new()),
            Decision::Fly(nodes) => nodes,
        };
        if let Some(reason) = defect(&nodes, planned_s) {
            return (ReplanStatus::Rejected { reason }, Vec::new());
        }
        self.pending = Some((takes_effect_s, Reference::new(nodes.clone())));
        let by_s = takes_effect_s - planned_s;
        (if by_s > ROUNDING_S { ReplanStatus::Late { by_s } } else { ReplanStatus::InTime }, nodes)
    }

    /// Appends what the reference in force holds up to `end_s`, and where it is then.
    fn follow_until(&mut self, end_s: f64) {
        let from_s = self.followed.last().map_or(0.0, |node| node.t_s);
        let between = |node: &&Node| node.t_s > from_s + ROUNDING_S && node.t_s < end_s - ROUNDING_S;
        self.followed.extend(self.in_force.nodes().iter().filter(between));
        if let Some(last) = self.in_force.nodes().last().filter(between) {
            // Beyond its end a reference stands, also one that ends in motion.
            self.followed.push(Node { velocity_mps: [0.0; 3], ..*last });
        }
        if end_s > from_s + ROUNDING_S {
            self.followed.push(self.in_force.at(end_s).node());
        }
    }

    /// The simulator's first step that is not before `t_s`, s.
    fn on_step(&self, t_s: f64) -> f64 {
        (t_s / self.step_s - 1e-6).ceil() * self.step_s
    }
}
