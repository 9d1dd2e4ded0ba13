use super::arrival::Arrival;
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
    let mut arrival = Arrival::new(request.scenario);
    let mut step = 0;
    let last_step = loop {
        let t_s = request.time_s(step);
        let truths = fleet.states();
        let measured = fleet.measure(&truths);
        fleet.events.extend(references.advance(t_s, &truths, || fleet.navigation(&measured)));
        fleet.decide(t_s, &truths, &measured, |index| references.of(index));
        if let References::InLoop(planning) = &references {
            arrival.update((step, t_s), &truths, |index| planning.accepted(index));
        }
        request.report_second(t_s, progress);
        let last_step = arrival.last_step().map_or(request.steps, |last_step| last_step.min(request.steps));
        if step >= last_step || truths.iter().all(Option::is_none) {
            break step;
        }
        fleet.advance(t_s);
        step += 1;
    };
    if let Some(step) = arrival.since() {
        fleet.events.push(Event { t_s: request.time_s(step), kind: EventKind::Arrived, vehicles: fleet.names() });
    }
    let end_s = request.time_s(arrival.since().unwrap_or(last_step));
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

    fn into_planning(self) -> Option<PlanningLoop> {
        match self {
            Self::Planned(_) | Self::Recorded(_) => None,
            Self::InLoop(planning) => Some(planning),
        }
    }
}
