use nalgebra::Vector3;
use scenarios::{AppliedLimits, Scenario};

use super::fleet::Fleet;
use super::in_loop::PlanningLoop;
use super::recorded::RecordedReferences;
use super::reference::Reference;
use super::state::{MultirotorState, NavigationState};
use crate::flight::{Event, EventKind, FleetLog, InLoopLog};
use crate::request::{FlightRequest, ReferenceSource};

/// Simulates multirotors that fly a plan, or replan in the loop until all have arrived and coasted.
pub(crate) fn simulate(
    request: &FlightRequest<'_>,
    source: ReferenceSource<'_>,
    progress: &mut dyn FnMut(f64),
) -> FleetLog {
    let mut fleet = Fleet::new(request);
    let mut references = References::new(request, source);
    let (mut last_step, mut arrived_s) = (request.steps, None);
    let mut step = 0;
    while step <= last_step {
        let t_s = request.time_s(step);
        let truths = fleet.states();
        let measured = fleet.measure(&truths);
        fleet.events.extend(references.advance(t_s, &truths, || fleet.navigation(&measured)));
        fleet.decide(t_s, &truths, &measured, |index| references.of(index));
        if references.are_in_loop() && arrived_s.is_none() && have_arrived(request.scenario, &truths) {
            arrived_s = Some(t_s);
            fleet.events.push(Event { t_s, kind: EventKind::Arrived, vehicles: fleet.names() });
            last_step = last_step.min(step + coast_steps(request.scenario));
        }
        if truths.iter().all(Option::is_none) {
            break;
        }
        if step < last_step {
            fleet.advance(t_s);
        }
        request.report_second(t_s, progress);
        step += 1;
    }
    let end_s = arrived_s.unwrap_or(request.time_s(step.min(last_step)));
    let in_loop = references.into_planning().map(|planning| {
        let (planning, events) = planning.finish(end_s);
        fleet.events.extend(events);
        InLoopLog { end_s, planning }
    });
    let (vehicles, events) = fleet.finish();
    FleetLog { vehicles, events, in_loop }
}

/// What the vehicles follow.
enum References {
    /// One reference per vehicle, from a plan.
    Planned(Vec<Reference>),
    /// Those that the planners give.
    InLoop(PlanningLoop),
    /// Those that the planners gave in an earlier flight.
    Recorded(RecordedReferences),
}

impl References {
    fn new(request: &FlightRequest<'_>, source: ReferenceSource<'_>) -> Self {
        match source {
            ReferenceSource::Plan(plan) => {
                let trajectories = plan.trajectories.iter();
                Self::Planned(trajectories.map(|it| Reference::new(it.multirotor().nodes())).collect())
            }
            ReferenceSource::InLoop(planners) => Self::InLoop(PlanningLoop::new(request, planners)),
            ReferenceSource::Recorded(flight) => {
                let planning = flight.planning.as_ref().expect("a flight that was planned in the loop");
                Self::Recorded(RecordedReferences::new(request, planning))
            }
        }
    }

    /// Brings the references up to date at the beginning of a step. Returns what happened.
    fn advance(
        &mut self,
        t_s: f64,
        truths: &[Option<MultirotorState>],
        navigation: impl FnOnce() -> Vec<Option<NavigationState>>,
    ) -> Vec<Event> {
        match self {
            Self::Planned(_) => Vec::new(),
            Self::InLoop(planning) => planning.advance(t_s, truths, &navigation()),
            Self::Recorded(recorded) => {
                recorded.update(t_s);
                Vec::new()
            }
        }
    }

    fn of(&self, index: usize) -> &Reference {
        match self {
            Self::Planned(references) => &references[index],
            Self::InLoop(planning) => planning.reference(index),
            Self::Recorded(recorded) => recorded.of(index),
        }
    }

    fn are_in_loop(&self) -> bool {
        matches!(self, Self::InLoop(_))
    }

    fn into_planning(self) -> Option<PlanningLoop> {
        match self {
            Self::Planned(_) | Self::Recorded(_) => None,
            Self::InLoop(planning) => Some(planning),
        }
    }
}

/// Do all vehicles rest at their goals?
fn have_arrived(scenario: &Scenario, truths: &[Option<MultirotorState>]) -> bool {
    let AppliedLimits { goal_m, rest_mps, .. } = scenario.limits();
    scenario.vehicles.iter().zip(truths).all(|(vehicle, truth)| {
        truth.is_some_and(|truth| {
            let distance_m = (truth.position_m - Vector3::from(vehicle.goal.position_m())).norm();
            distance_m <= goal_m && truth.velocity_mps.norm() <= rest_mps
        })
    })
}

/// Steps after the arrival: at least one, so that the log extends beyond it.
fn coast_steps(scenario: &Scenario) -> usize {
    let settings = &scenario.simulation;
    ((settings.coast_s / settings.step_s).ceil() as usize).max(1)
}
