use nalgebra::Vector3;
use scenarios::in_loop::{InLoopPlanner, Node, PlannerRemarks, ReplanStatus};
use scenarios::{Scenario, Vehicle};

use super::reference_manager::{NavigationInput, ReferenceManager, VehicleSettings};
use super::sensed_world::{Other, SensedWorld};
use crate::flight::{Event, EventKind};
use crate::multirotor::reference::Reference;
use crate::multirotor::state::{MultirotorState, NavigationState};
use crate::planning_log::{PlanningLog, Replan};
use crate::request::FlightRequest;
use crate::sensors::Sensors;

/// Planning of the whole fleet: one planner per vehicle, and the log of their results.
pub(in crate::multirotor) struct PlanningLoop {
    vehicles: Vec<PlannedVehicle>,
    plans_shared: bool,
    replans: Vec<Replan>,
}

/// A vehicle as the planning sees it.
struct PlannedVehicle {
    name: String,
    body_radius_m: f64,
    sensed_world: SensedWorld,
    reference_manager: ReferenceManager,
}

impl PlannedVehicle {
    /// `phase`: fraction of the period before the first call, in [0, 1).
    fn new(
        request: &FlightRequest<'_>,
        (index, vehicle): (usize, &Vehicle),
        planner: Box<dyn InLoopPlanner>,
        phase: f64,
    ) -> Self {
        let Scenario { world, simulation, .. } = request.scenario;
        let model = request.scenario.multirotor_model(vehicle);
        let sensors = Sensors::new(&simulation.sensors, request.stream("sightings", vehicle));
        Self {
            name: vehicle.name.clone(),
            body_radius_m: model.body_radius_m,
            sensed_world: SensedWorld::new(world, model.sensor_range_m, sensors),
            reference_manager: ReferenceManager::new(
                (index, planner),
                &simulation.planning,
                request.stream("planning", vehicle),
                VehicleSettings {
                    limits: model.limits,
                    step_s: simulation.step_s,
                    phase,
                    start_m: vehicle.start.position_m().into(),
                },
            ),
        }
    }
}

impl PlanningLoop {
    /// `planners`: one per vehicle, in the order of the scenario. Their calls are distributed evenly over a period.
    pub fn new(request: &FlightRequest<'_>, planners: Vec<Box<dyn InLoopPlanner>>) -> Self {
        let count = planners.len() as f64;
        let vehicles = request.scenario.vehicles.iter().enumerate().zip(planners);
        let vehicles = vehicles
            .map(|(vehicle, planner)| PlannedVehicle::new(request, vehicle, planner, vehicle.0 as f64 / count))
            .collect();
        Self { vehicles, plans_shared: request.scenario.fleet.plans_shared, replans: Vec::new() }
    }

    /// The reference in force of a vehicle.
    pub fn reference(&self, index: usize) -> &Reference {
        self.vehicles[index].reference_manager.reference()
    }

    /// Nodes of the reference of a vehicle that was accepted last, whether it is in force already or pending.
    pub fn accepted(&self, index: usize) -> &[Node] {
        self.vehicles[index].reference_manager.accepted()
    }

    /// Sensing and planning at the beginning of a step. Returns what happened.
    ///
    /// - `truths`, `known`: true states of the vehicles, and what their controllers know of them; `None` once crashed
    pub fn advance(
        &mut self,
        t_s: f64,
        truths: &[Option<MultirotorState>],
        known: &[Option<NavigationState>],
    ) -> Vec<Event> {
        let mut events = self.discover(t_s, truths);
        for index in 0..self.vehicles.len() {
            self.vehicles[index].reference_manager.update(t_s);
            let (Some(truth), Some(own)) = (&truths[index], known[index]) else { continue };
            if self.vehicles[index].reference_manager.is_due(t_s) {
                let event = self.replan(index, t_s, &truth.position_m, own, truths);
                events.extend(event.map(|kind| Event::of_vehicle(&self.vehicles[index].name, (t_s, kind))));
                self.vehicles[index].reference_manager.update(t_s);
            }
        }
        events
    }

    /// Every vehicle that has not crashed senses its surroundings.
    fn discover(&mut self, t_s: f64, truths: &[Option<MultirotorState>]) -> Vec<Event> {
        let mut events = Vec::new();
        for (vehicle, truth) in self.vehicles.iter_mut().zip(truths) {
            let Some(truth) = truth else { continue };
            let discovered = vehicle.sensed_world.discover(&truth.position_m).into_iter();
            let kinds = discovered.map(|obstacle| EventKind::Discovered { obstacle });
            events.extend(kinds.map(|kind| Event::of_vehicle(&vehicle.name, (t_s, kind))));
        }
        events
    }

    /// Calls the planner of a vehicle. Returns an event if its result is not simply flown in time.
    fn replan(
        &mut self,
        index: usize,
        t_s: f64,
        position_m: &Vector3<f64>,
        own: NavigationState,
        truths: &[Option<MultirotorState>],
    ) -> Option<EventKind> {
        let others = self.others(index, truths);
        let PlannedVehicle { sensed_world, reference_manager, .. } = &mut self.vehicles[index];
        let moving = sensed_world.measure_moving(t_s, position_m);
        let neighbours = sensed_world.measure_neighbours(position_m, &others);
        let replan = reference_manager.replan(NavigationInput { t_s, own, sensed_world, moving, neighbours });
        let previous = self.replans.iter().rfind(|previous| previous.vehicle == index);
        let event = event_of(&replan, previous);
        self.replans.push(replan);
        event
    }

    /// All vehicles but one.
    fn others(&self, own: usize, truths: &[Option<MultirotorState>]) -> Vec<Other> {
        let vehicles = self.vehicles.iter().zip(truths).enumerate().filter(|(index, _)| *index != own);
        let other = |(_, (vehicle, truth)): (usize, (&PlannedVehicle, &Option<MultirotorState>))| {
            let MultirotorState { position_m, velocity_mps, .. } = (*truth)?;
            let plan = if self.plans_shared { vehicle.reference_manager.accepted().to_vec() } else { Vec::new() };
            let PlannedVehicle { name, body_radius_m, .. } = vehicle;
            Some(Other { name: name.clone(), body_radius_m: *body_radius_m, position_m, velocity_mps, plan })
        };
        vehicles.filter_map(other).collect()
    }

    /// Ends the planning. Returns its log, and events of what is to be said of the planners.
    ///
    /// - `end_s`: when all vehicles had arrived, or the flight ended, s
    pub fn finish(mut self, end_s: f64) -> (PlanningLog, Vec<Event>) {
        let (mut remarks, mut events) = (PlannerRemarks::default(), Vec::new());
        for vehicle in &mut self.vehicles {
            let PlannerRemarks { notes, failure } = vehicle.reference_manager.finish_planner();
            let kinds = notes.iter().chain(&failure).map(|text| EventKind::PlannerRemark { text: text.clone() });
            events.extend(kinds.map(|kind| Event::of_vehicle(&vehicle.name, (end_s, kind))));
            remarks.notes.extend(notes);
            remarks.failure = remarks.failure.or(failure);
        }
        let vehicles = self.vehicles.into_iter();
        let followed = vehicles.map(|vehicle| vehicle.reference_manager.followed(&vehicle.name, end_s)).collect();
        (PlanningLog { replans: self.replans, followed, remarks }, events)
    }
}

/// The event to report of a result, if there is one. Equal failures in a row are one event.
fn event_of(replan: &Replan, previous: Option<&Replan>) -> Option<EventKind> {
    match &replan.outcome {
        ReplanStatus::Late { by_s } => Some(EventKind::ReplanLate { by_s: *by_s }),
        ReplanStatus::Rejected { reason } => Some(EventKind::ReplanRejected { reason: reason.clone() }),
        ReplanStatus::Failed { .. } if previous.is_some_and(|previous| previous.outcome == replan.outcome) => None,
        ReplanStatus::Failed { reason } => Some(EventKind::ReplanFailed { reason: reason.clone() }),
        ReplanStatus::None | ReplanStatus::InTime | ReplanStatus::Kept { .. } => None,
    }
}
