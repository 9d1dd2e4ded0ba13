//! Holding: what an aircraft does between its arrival and that of the last one.
//!
//! An aircraft that has arrived cannot stop. Its plan goes on beyond the goal, level and at constant speed, in turns that stay
//! clear of obstacles and of all others until the last aircraft has arrived. Every vehicle is searched for in turn
//! ([`search`]); one that finds no way precedes the others in the next order.

mod search;
mod track;

use std::fmt;

use scenarios::{Range, Scenario};

use super::super::dynamics::State;
use super::super::iterate::{Iterate, max_flight_time_s};
use super::super::shooting::{self, SUBSTEPS};
use super::acceptance::MAX_ROLLOUT_FRACTION;
use super::avoidance_rows::AvoidanceConstraints;
use super::refined_motion::RefinedMotion;
use crate::convex::STAGE_LEN;
use search::HoldSearch;
use track::Track;

/// Shorter waits are no part of the plan, s.
const MIN_HOLD_S: f64 = 1e-6;
/// Number of orders in which the vehicles are searched for.
const MAX_ORDERS: usize = 6;
/// Distances beyond what the planner keeps, m, from the one that is wished for to the one that suffices.
const SPARE_M: [f64; 3] = [5.0, 0.5, 0.0];

/// A vehicle that cannot stay clear after its arrival.
#[derive(Clone, Debug, PartialEq)]
pub struct Blocked {
    /// Its name.
    pub vehicle: String,
    /// Its arrival, s.
    pub arrival_s: f64,
    /// Arrival of the last vehicle, s.
    pub end_s: f64,
}

impl fmt::Display for Blocked {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { vehicle, arrival_s, end_s } = self;
        write!(
            f,
            "{vehicle} arrives at {arrival_s:.1} s and is not clear of obstacles and others until the last arrival at {end_s:.1} s"
        )
    }
}

/// The motion of every vehicle after its arrival, from the state at the goal on; `None` for those that arrive last.
///
/// - `bounds`: planning limits of every vehicle
///
/// # Errors
///
/// The vehicle that cannot stay clear of the others after its arrival.
pub fn holds(
    scenario: &Scenario,
    constraints: &AvoidanceConstraints,
    trajectories: &[Iterate],
    bounds: &[[Range; STAGE_LEN]],
) -> Result<Vec<Option<Iterate>>, Blocked> {
    let end_s = max_flight_time_s(trajectories);
    let mut order: Vec<usize> =
        (0..trajectories.len()).filter(|&i| end_s - trajectories[i].flight_time_s() > MIN_HOLD_S).collect();
    order.sort_by(|a, b| trajectories[*a].flight_time_s().total_cmp(&trajectories[*b].flight_time_s()));
    if order.is_empty() {
        return Ok(vec![None; trajectories.len()]);
    }
    let missions: Vec<Track> = trajectories.iter().map(Track::new).collect();
    let mut blocked = 0;
    for _ in 0..MAX_ORDERS {
        let (mut tracks, mut holds) = (missions.clone(), vec![None; trajectories.len()]);
        let position = order.iter().position(|&vehicle| {
            let search = HoldSearch { scenario, constraints, vehicle, bounds: &bounds[vehicle], end_s };
            let found = SPARE_M.iter().find_map(|spare_m| search.run(&trajectories[vehicle], &tracks, *spare_m));
            let hold = found.filter(|hold| can_be_flown_open_loop(scenario, &trajectories[vehicle], hold));
            if let Some(hold) = &hold {
                tracks[vehicle].go_on(hold);
            }
            holds[vehicle] = hold;
            holds[vehicle].is_none()
        });
        let Some(position) = position else { return Ok(holds) };
        blocked = order[position];
        if position == 0 {
            break;
        }
        order[..=position].rotate_right(1);
    }
    let (vehicle, arrival_s) = (scenario.vehicles[blocked].name.clone(), trajectories[blocked].flight_time_s());
    Err(Blocked { vehicle, arrival_s, end_s })
}

/// Whether the controls lead, from the start on and without a restart, to the end of the hold.
fn can_be_flown_open_loop(scenario: &Scenario, mission: &Iterate, hold: &Iterate) -> bool {
    let flow = |state: State, k: usize| shooting::flow_within(&hold.interval(k), state, [0.0, 1.0])[SUBSTEPS];
    let end = (0..hold.intervals()).fold(RefinedMotion::new(mission).open_loop_end, flow);
    let error_m = (hold.states[hold.intervals()] - end).fixed_rows::<3>(0).norm();
    error_m <= MAX_ROLLOUT_FRACTION * scenario.limits().rollout_m
}
