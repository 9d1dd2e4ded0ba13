use scenarios::multirotor::Plant;

use super::multirotor_sim::MultirotorSim;
use super::reference::Reference;
use super::state::{MultirotorState, NavigationState};
use crate::collision::time_of_impact;
use crate::flight::{Event, EventKind, VehicleLog};
use crate::obstacles::Obstacles;
use crate::plant_steps::PlantSteps;
use crate::rapier_world::RapierWorld;
use crate::request::FlightRequest;
use crate::sensors::Measurement;

/// Maximum step of the plant of point masses, s, and of quadrotors.
const MAX_POINT_MASS_STEP_S: f64 = 0.01;
const MAX_QUADROTOR_STEP_S: f64 = 5e-4;
/// Rapier clips faster bodies.
const MAX_SPEED_MPS: f64 = 1000.0;

/// Multirotors in one world.
pub(super) struct Fleet {
    world: RapierWorld,
    obstacles: Obstacles,
    multirotors: Vec<MultirotorSim>,
    is_flying: Vec<bool>,
    pub events: Vec<Event>,
    plant_steps: PlantSteps,
}

impl Fleet {
    pub fn new(request: &FlightRequest<'_>) -> Self {
        let scenario = request.scenario;
        let has_rotors = scenario.vehicles.iter().any(|it| scenario.multirotor_model(it).plant == Plant::Quadrotor);
        let max_plant_step_s = if has_rotors { MAX_QUADROTOR_STEP_S } else { MAX_POINT_MASS_STEP_S };
        let mut world = RapierWorld::new(MAX_SPEED_MPS);
        let vehicles = scenario.vehicles.iter();
        let multirotors: Vec<_> = vehicles.map(|vehicle| MultirotorSim::new(request, vehicle, &mut world)).collect();
        Self {
            world,
            obstacles: Obstacles::new(&scenario.world),
            is_flying: vec![true; multirotors.len()],
            multirotors,
            events: Vec::new(),
            plant_steps: PlantSteps::new(request, max_plant_step_s),
        }
    }

    /// Names of the vehicles.
    pub fn names(&self) -> Vec<String> {
        self.multirotors.iter().map(|multirotor| multirotor.name().to_owned()).collect()
    }

    /// True states; `None` for a vehicle that has crashed.
    pub fn states(&self) -> Vec<Option<MultirotorState>> {
        let multirotors = self.multirotors.iter().zip(&self.is_flying);
        multirotors.map(|(multirotor, is_flying)| is_flying.then(|| multirotor.state(&self.world))).collect()
    }

    /// Measurements of the vehicles' own states, once per step.
    pub fn measure(&mut self, truths: &[Option<MultirotorState>]) -> Vec<Option<Measurement>> {
        let multirotors = self.multirotors.iter_mut().zip(truths);
        multirotors.map(|(multirotor, truth)| Some(multirotor.measure(truth.as_ref()?))).collect()
    }

    /// What the vehicles' controllers know of their motions.
    pub fn navigation(&self, measured: &[Option<Measurement>]) -> Vec<Option<NavigationState>> {
        let multirotors = self.multirotors.iter().zip(measured);
        multirotors.map(|(multirotor, measured)| Some(multirotor.navigation((*measured)?))).collect()
    }

    /// Computes the controls of the coming step, and logs.
    pub fn decide<'a>(
        &mut self,
        t_s: f64,
        truths: &[Option<MultirotorState>],
        measured: &[Option<Measurement>],
        reference: impl Fn(usize) -> &'a Reference,
    ) {
        for (index, multirotor) in self.multirotors.iter_mut().enumerate() {
            let (Some(truth), Some(measured)) = (&truths[index], &measured[index]) else { continue };
            let event = multirotor.decide(t_s, truth, measured, reference(index));
            self.events.extend(event.map(|event| Event::of_vehicle(multirotor.name(), event)));
        }
    }

    /// Advances the world by one step of the simulator, and removes the vehicles that collide.
    pub fn advance(&mut self, t_s: f64) {
        let (plant_steps_s, plant_step_s) = self.plant_steps.within(t_s);
        let Self { world, multirotors, is_flying, .. } = self;
        flying(multirotors, is_flying).for_each(|multirotor| multirotor.begin_step(t_s, world));
        for began_s in plant_steps_s {
            let before = self.states();
            let Self { world, multirotors, is_flying, .. } = self;
            flying(multirotors, is_flying).for_each(|multirotor| multirotor.apply_forces(world, began_s, plant_step_s));
            world.step(plant_step_s);
            let times_s = [began_s, began_s + plant_step_s];
            self.collide_with_each_other(times_s, &before);
            self.collide_with_obstacles(times_s, &before);
        }
    }

    /// Removes the vehicles that collide with each other, in the order of time.
    fn collide_with_each_other(&mut self, times_s: [f64; 2], before: &[Option<MultirotorState>]) {
        let mut collisions: Vec<(f64, [usize; 2])> = Vec::new();
        let flying: Vec<usize> = (0..self.multirotors.len()).filter(|index| self.is_flying[*index]).collect();
        for (rank, &first) in flying.iter().enumerate() {
            for &second in &flying[rank + 1..] {
                let (Some(a), Some(b)) = (before[first], before[second]) else { continue };
                let start_m = a.position_m - b.position_m;
                let end_m = self.position_m(first) - self.position_m(second);
                let reach_m = self.multirotors[first].body_radius_m() + self.multirotors[second].body_radius_m();
                let fraction = time_of_impact(&start_m, &end_m, reach_m);
                collisions.extend(fraction.map(|fraction| (fraction, [first, second])));
            }
        }
        collisions.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (fraction, pair) in collisions {
            if pair.iter().all(|index| self.is_flying[*index]) {
                self.crash(&pair, None, times_s[0] + fraction * (times_s[1] - times_s[0]));
            }
        }
    }

    fn collide_with_obstacles(&mut self, times_s: [f64; 2], before: &[Option<MultirotorState>]) {
        for (index, start) in before.iter().enumerate() {
            let Some(start) = start.filter(|_| self.is_flying[index]) else { continue };
            let ends_m = [start.position_m, self.position_m(index)];
            let radius_m = self.multirotors[index].body_radius_m();
            if let Some((fraction, obstacle)) = self.obstacles.time_of_impact(times_s, ends_m, radius_m) {
                let name = self.obstacles.name(obstacle).to_owned();
                self.crash(&[index], Some(name), times_s[0] + fraction * (times_s[1] - times_s[0]));
            }
        }
    }

    fn position_m(&self, index: usize) -> nalgebra::Vector3<f64> {
        self.world.point_state(self.multirotors[index].body()).position_m
    }

    fn crash(&mut self, indices: &[usize], obstacle: Option<String>, t_s: f64) {
        let vehicles = indices.iter().map(|index| self.multirotors[*index].name().to_owned()).collect();
        self.events.push(Event { t_s, kind: EventKind::Crash { obstacle }, vehicles });
        for &index in indices {
            self.is_flying[index] = false;
            self.world.remove_body(self.multirotors[index].body());
        }
    }

    /// Ends the flight. Returns the logs and the events.
    pub fn finish(mut self) -> (Vec<VehicleLog>, Vec<Event>) {
        let mut logs = Vec::with_capacity(self.multirotors.len());
        for multirotor in self.multirotors {
            let (log, event) = multirotor.finish();
            self.events.extend(event.map(|event| Event::of_vehicle(&log.vehicle, event)));
            logs.push(log);
        }
        (logs, self.events)
    }
}

fn flying<'a>(
    multirotors: &'a mut [MultirotorSim],
    is_flying: &'a [bool],
) -> impl Iterator<Item = &'a mut MultirotorSim> {
    multirotors.iter_mut().zip(is_flying).filter(|(_, is_flying)| **is_flying).map(|(multirotor, _)| multirotor)
}
