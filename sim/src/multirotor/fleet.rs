use nalgebra::Vector3;
use scenarios::in_loop::{InLoopPlanner, ReplanStatus};
use scenarios::multirotor::Plant;
use scenarios::{AppliedLimits, Plan, Scenario};

use super::multirotor_sim::{MultirotorSim, Truth};
use super::obstacles::Obstacles;
use super::reference::Reference;
use crate::collision::time_of_impact;
use crate::in_loop::{NavigationInput, Other, PlanningLog, ReferenceManager, Replan, SensedWorld};
use crate::rapier_world::RapierWorld;
use crate::sensors::{Measurement, Sensors};
use crate::{ControlMode, Event, EventKind, Flight, FlightOptions, VehicleLog, start};

/// Longest step of a quadrotor's plant, s: an ordinary step of the simulator, for which a command is held, is divided into
/// such.
const LONGEST_PLANT_STEP_S: f64 = 5e-4;

/// Flies a plan of multirotors for so many steps, and returns their logs and what happened.
pub(crate) fn fly(
    scenario: &Scenario,
    plan: &Plan,
    seed: u64,
    setup: &FlightOptions,
    steps: usize,
    progress: &mut dyn FnMut(f64),
) -> (Vec<VehicleLog>, Vec<Event>) {
    let references = plan.trajectories.iter().map(|it| Reference::new(it.multirotor().nodes()));
    let references: Vec<Reference> = references.collect();
    let mut fleet = Fleet::new(scenario, seed, setup);
    for step in 0..=steps {
        let t_s = fleet.time_s(step);
        let truths = fleet.truths();
        for index in 0..fleet.crafts.len() {
            let Some(truth) = truths[index] else { continue };
            let measured = fleet.crafts[index].measure(&truth);
            fleet.decide(index, t_s, &truth, &measured, &references[index]);
        }
        if step < steps {
            fleet.advance(t_s);
        }
        report(t_s, fleet.step_s, progress);
    }
    fleet.finish()
}

/// Flies multirotors with their planners, until all have come to rest at their goals and coasted, or for the longest
/// duration.
pub(crate) fn fly_in_loop(
    scenario: &Scenario,
    planners: Vec<Box<dyn InLoopPlanner>>,
    seed: u64,
    progress: &mut dyn FnMut(f64),
) -> Flight {
    let settings = &scenario.simulation;
    let mut fleet = Fleet::new(scenario, seed, &FlightOptions::default());
    let mut crew = Crew::new(scenario, planners, seed);
    let most_steps = (settings.max_duration_s / settings.step_s - 1e-3).ceil() as usize;
    let (mut steps, mut arrived_s) = (most_steps, None);
    let mut step = 0;
    while step <= steps {
        let t_s = fleet.time_s(step);
        let truths = fleet.truths();
        let measured: Vec<Option<Measurement>> =
            fleet.crafts.iter_mut().zip(&truths).map(|(craft, truth)| Some(craft.measure(truth.as_ref()?))).collect();
        crew.look(t_s, &truths, &mut fleet.events);
        crew.plan(t_s, &fleet.crafts, &truths, &measured, &mut fleet.events);
        for (index, (truth, measured)) in truths.iter().zip(&measured).enumerate() {
            let (Some(truth), Some(measured)) = (truth, measured) else { continue };
            fleet.decide(index, t_s, truth, measured, crew.helms[index].reference());
        }
        if arrived_s.is_none() && have_arrived(scenario, &truths) {
            arrived_s = Some(t_s);
            let vehicles = fleet.crafts.iter().map(|craft| craft.name().to_owned()).collect();
            fleet.events.push(Event { t_s, kind: EventKind::Arrived, vehicles });
            // One step at least, so that the log goes on beyond the arrival.
            steps = steps.min(step + ((settings.coast_s / settings.step_s).ceil() as usize).max(1));
        }
        if truths.iter().all(Option::is_none) {
            break;
        }
        if step < steps {
            fleet.advance(t_s);
        }
        report(t_s, fleet.step_s, progress);
        step += 1;
    }
    let end_s = arrived_s.unwrap_or(fleet.time_s(step.min(steps)));
    let (vehicles, events) = fleet.finish();
    let planning = Some(crew.log(scenario, end_s));
    Flight { step_s: settings.step_s, plan_end_s: end_s, vehicles, events, planning, wall_s: 0.0 }
}

/// Multirotors in the air.
struct Fleet {
    world: RapierWorld,
    surroundings: Obstacles,
    crafts: Vec<MultirotorSim>,
    is_flying: Vec<bool>,
    events: Vec<Event>,
    step_s: f64,
    plant_steps: usize,
    open_loop: bool,
}

impl Fleet {
    fn new(scenario: &Scenario, seed: u64, setup: &FlightOptions) -> Self {
        let step_s = scenario.simulation.step_s;
        let has_rotors = scenario.vehicles.iter().any(|it| scenario.multirotor_model(it).plant == Plant::Quadrotor);
        let plant_steps = if has_rotors { (step_s / LONGEST_PLANT_STEP_S - 1e-6).ceil().max(1.0) as usize } else { 1 };
        let mut world = RapierWorld::new(step_s / plant_steps as f64);
        let crafts: Vec<MultirotorSim> = scenario
            .vehicles
            .iter()
            .enumerate()
            .map(|(index, vehicle)| {
                let offset_m = start::offset_m(scenario, vehicle, setup, seed);
                let position_m = Vector3::from(vehicle.start.position_m()) + offset_m;
                let velocity_mps =
                    Vector3::from(vehicle.start.velocity_mps()) + Vector3::from(setup.start_velocity_offset_mps);
                MultirotorSim::new(scenario, (index, vehicle), seed, &mut world, [position_m, velocity_mps])
            })
            .collect();
        Self {
            world,
            surroundings: Obstacles::new(&scenario.world),
            is_flying: vec![true; crafts.len()],
            crafts,
            events: Vec::new(),
            step_s,
            plant_steps,
            open_loop: setup.control_mode == ControlMode::OpenLoop,
        }
    }

    fn time_s(&self, step: usize) -> f64 {
        step as f64 * self.step_s
    }

    /// The bodies as they are; `None` for whoever has crashed.
    fn truths(&self) -> Vec<Option<Truth>> {
        let crafts = self.crafts.iter().zip(&self.is_flying);
        crafts.map(|(craft, is_flying)| is_flying.then(|| craft.truth(&self.world))).collect()
    }

    fn decide(&mut self, index: usize, t_s: f64, truth: &Truth, measured: &Measurement, reference: &Reference) {
        let craft = &mut self.crafts[index];
        if let Some((t_s, kind)) = craft.decide(t_s, truth, measured, reference, self.open_loop) {
            self.events.push(Event { t_s, kind, vehicles: vec![craft.name().to_owned()] });
        }
    }

    /// One step of the simulator, in steps of the plant.
    fn advance(&mut self, t_s: f64) {
        let plant_step_s = self.step_s / self.plant_steps as f64;
        for plant_step in 0..self.plant_steps {
            let times_s = [plant_step, plant_step + 1].map(|count| t_s + count as f64 * plant_step_s);
            let before = self.truths();
            for (craft, _) in self.crafts.iter_mut().zip(&self.is_flying).filter(|(_, is_flying)| **is_flying) {
                craft.push(&mut self.world, plant_step_s);
            }
            self.world.step();
            self.touch_each_other(times_s, &before);
            self.touch_obstacles(times_s, &before);
        }
    }

    /// Takes out those who touched each other, the earliest first.
    fn touch_each_other(&mut self, times_s: [f64; 2], before: &[Option<Truth>]) {
        let mut touches: Vec<(f64, [usize; 2])> = Vec::new();
        let flying: Vec<usize> = (0..self.crafts.len()).filter(|index| self.is_flying[*index]).collect();
        for (place, &first) in flying.iter().enumerate() {
            for &second in &flying[place + 1..] {
                let (Some(a), Some(b)) = (before[first], before[second]) else { continue };
                let start_m = a.position_m - b.position_m;
                let end_m = self.world.position_m(first) - self.world.position_m(second);
                let reach_m = self.crafts[first].model.body_radius_m + self.crafts[second].model.body_radius_m;
                touches.extend(time_of_impact(&start_m, &end_m, reach_m).map(|share| (share, [first, second])));
            }
        }
        touches.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (share, pair) in touches {
            if pair.iter().all(|index| self.is_flying[*index]) {
                self.crash(&pair, None, times_s[0] + share * (times_s[1] - times_s[0]));
            }
        }
    }

    fn touch_obstacles(&mut self, times_s: [f64; 2], before: &[Option<Truth>]) {
        for (index, start) in before.iter().enumerate() {
            let Some(start) = start.filter(|_| self.is_flying[index]) else { continue };
            let ends_m = [start.position_m, self.world.position_m(index)];
            let radius_m = self.crafts[index].model.body_radius_m;
            if let Some((share, obstacle)) = self.surroundings.time_of_impact(times_s, ends_m, radius_m) {
                let name = self.surroundings.name(obstacle).to_owned();
                self.crash(&[index], Some(name), times_s[0] + share * (times_s[1] - times_s[0]));
            }
        }
    }

    fn crash(&mut self, bodies: &[usize], obstacle: Option<String>, t_s: f64) {
        let vehicles = bodies.iter().map(|body| self.crafts[*body].name().to_owned()).collect();
        self.events.push(Event { t_s, kind: EventKind::Crash { obstacle }, vehicles });
        for &body in bodies {
            self.is_flying[body] = false;
            self.world.remove_body(body);
        }
    }

    fn finish(mut self) -> (Vec<VehicleLog>, Vec<Event>) {
        let mut logs = Vec::with_capacity(self.crafts.len());
        for mut craft in self.crafts {
            let vehicle = craft.name().to_owned();
            self.events.extend(craft.finish().map(|(t_s, kind)| Event { t_s, kind, vehicles: vec![vehicle] }));
            logs.push(craft.log);
        }
        (logs, self.events)
    }
}

/// Who looks around, asks the planners, and keeps the log of their answers.
struct Crew {
    names: Vec<String>,
    plans_shared: bool,
    senses: Vec<SensedWorld>,
    helms: Vec<ReferenceManager>,
    replans: Vec<Replan>,
}

impl Crew {
    fn new(scenario: &Scenario, planners: Vec<Box<dyn InLoopPlanner>>, seed: u64) -> Self {
        let settings = &scenario.simulation;
        let (mut senses, mut helms) = (Vec::new(), Vec::new());
        let count = planners.len() as f64;
        for (index, (vehicle, planner)) in scenario.vehicles.iter().zip(planners).enumerate() {
            let stream = |kind: &str| scenarios::stream(seed, &format!("{kind}/{}", vehicle.name));
            let range_m = scenario.multirotor_model(vehicle).sensor_range_m;
            senses.push(SensedWorld::new(
                &scenario.world,
                range_m,
                Sensors::new(&settings.sensors, stream("sightings")),
            ));
            let share = index as f64 / count;
            let start_m = Vector3::from(vehicle.start.position_m());
            let rng = stream("planning");
            helms.push(ReferenceManager::new(
                (index, planner),
                &settings.planning,
                rng,
                settings.step_s,
                share,
                start_m,
            ));
        }
        let names = scenario.vehicles.iter().map(|vehicle| vehicle.name.clone()).collect();
        Self { names, plans_shared: scenario.fleet.plans_shared, senses, helms, replans: Vec::new() }
    }

    /// Everybody looks around.
    fn look(&mut self, t_s: f64, truths: &[Option<Truth>], events: &mut Vec<Event>) {
        for (index, truth) in truths.iter().enumerate() {
            let Some(truth) = truth else { continue };
            for obstacle in self.senses[index].look(&truth.position_m) {
                let kind = EventKind::Discovered { obstacle };
                events.push(Event { t_s, kind, vehicles: vec![self.names[index].clone()] });
            }
        }
    }

    /// Puts into force what is due, and asks whose turn it is.
    fn plan(
        &mut self,
        t_s: f64,
        crafts: &[MultirotorSim],
        truths: &[Option<Truth>],
        measured: &[Option<Measurement>],
        events: &mut Vec<Event>,
    ) {
        for index in 0..self.helms.len() {
            self.helms[index].install(t_s);
            let (Some(truth), Some(own)) = (truths[index], measured[index]) else { continue };
            if !self.helms[index].is_due(t_s) {
                continue;
            }
            let others = self.others(index, crafts, truths);
            let senses = &mut self.senses[index];
            let moving = senses.sightings(t_s, &truth.position_m);
            let neighbours = senses.neighbours(&truth.position_m, &others);
            let replan = self.helms[index].ask(NavigationInput { t_s, own, senses, moving, neighbours });
            events.extend(about(&replan).map(|kind| Event { t_s, kind, vehicles: vec![self.names[index].clone()] }));
            self.replans.push(replan);
            self.helms[index].install(t_s);
        }
    }

    fn others(&self, own: usize, crafts: &[MultirotorSim], truths: &[Option<Truth>]) -> Vec<Other> {
        let others = (0..crafts.len()).filter(|index| *index != own);
        let other = |index: usize| {
            let truth = truths[index]?;
            Some(Other {
                name: self.names[index].clone(),
                body_radius_m: crafts[index].model.body_radius_m,
                position_m: truth.position_m,
                velocity_mps: truth.velocity_mps,
                plan: if self.plans_shared { self.helms[index].intent().to_vec() } else { Vec::new() },
            })
        };
        others.filter_map(other).collect()
    }

    fn log(self, scenario: &Scenario, end_s: f64) -> PlanningLog {
        let helms = self.helms.into_iter().zip(&scenario.vehicles);
        let followed = helms.map(|(helm, vehicle)| helm.followed(&vehicle.name, end_s)).collect();
        PlanningLog { replans: self.replans, followed }
    }
}

/// What an answer is worth a line for, if it is.
fn about(replan: &Replan) -> Option<EventKind> {
    match &replan.outcome {
        ReplanStatus::Late { by_s } => Some(EventKind::ReplanLate { by_s: *by_s }),
        ReplanStatus::Rejected { reason } => Some(EventKind::ReplanRejected { reason: reason.clone() }),
        ReplanStatus::None | ReplanStatus::InTime | ReplanStatus::Kept { .. } => None,
    }
}

/// Is everybody at rest at his goal?
fn have_arrived(scenario: &Scenario, truths: &[Option<Truth>]) -> bool {
    let AppliedLimits { goal_m, rest_mps, .. } = scenario.limits();
    scenario.vehicles.iter().zip(truths).all(|(vehicle, truth)| {
        truth.is_some_and(|truth| {
            let distance_m = (truth.position_m - Vector3::from(vehicle.goal.position_m())).norm();
            distance_m <= goal_m && truth.velocity_mps.norm() <= rest_mps
        })
    })
}

fn report(t_s: f64, step_s: f64, progress: &mut dyn FnMut(f64)) {
    if t_s.floor() > (t_s - step_s).floor() {
        progress(t_s);
    }
}
