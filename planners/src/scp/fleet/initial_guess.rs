//! The initial trajectories: nearly flyable routes, flown at speeds with which all vehicles arrive together, and with a
//! roundabout where many would meet at one point.

use rayon::prelude::*;
use scenarios::{Scenario, Vehicle};

use super::super::dynamics::State;
use super::super::iterate::Iterate;
use super::agility::Agility;
use super::avoidance_rows::AvoidanceConstraints;
use super::conflict_detection::FleetMotion;
use super::initial_route::{self, InitialRoute};
use super::roundabout;

/// Fraction of an interval during which the controls change; they are constant afterwards.
///
/// With controls linear over the whole interval, changes of alternating sign from node to node leave the state at every
/// node unchanged, so that nothing in the subproblem prevents a zigzag of the controls over the rest of the flight.
/// With a short ramp, a zigzag decays by a factor of seven from node to node.
const RAMP_FRACTION: f64 = 0.25;

/// The initial trajectories.
pub struct InitialGuess {
    /// One per vehicle.
    pub trajectories: Vec<Iterate>,
    /// Initial and final state of each vehicle; headings are those of the scenario up to full turns.
    pub boundary: Vec<[State; 2]>,
}

impl InitialGuess {
    /// Routes, speeds, and a roundabout for each crowd. A vehicle has other ones in each of its `attempts`.
    pub fn new(scenario: &Scenario, constraints: &AvoidanceConstraints, attempts: &[usize]) -> Self {
        let mut routes =
            initial_route::initial_routes(scenario, constraints.clearance_m + constraints.margin_m, attempts);
        let guess = Self::from_routes(scenario, &routes);
        let required_m = constraints.separation_m + constraints.margin_m;
        let crowds = roundabout::crowds(&FleetMotion::new(&guess.trajectories), required_m);
        if crowds.is_empty() {
            return guess;
        }
        roundabout::displace(&mut routes, &crowds, required_m);
        Self::from_routes(scenario, &routes)
    }

    fn from_routes(scenario: &Scenario, routes: &[InitialRoute]) -> Self {
        let vehicles = scenario.vehicles.par_iter().zip(routes).zip(intervals(scenario, routes));
        let trajectory = |((vehicle, route), intervals)| {
            initial_route::trajectory(scenario, vehicle, route, intervals, RAMP_FRACTION)
        };
        let (trajectories, boundary) = vehicles.map(trajectory).unzip();
        Self { trajectories, boundary }
    }
}

/// Number of intervals of every vehicle: that of the scenario, or what its agility asks for. Vehicles that arrive
/// together share their nodes.
fn intervals(scenario: &Scenario, routes: &[InitialRoute]) -> Vec<usize> {
    let own = |(vehicle, route): (&Vehicle, &InitialRoute)| {
        let limits = &scenario.fixed_wing_model(vehicle).planning_limits;
        scenario.planner.intervals.unwrap_or_else(|| Agility::new(limits).intervals(route.flight_time_s))
    };
    let mut intervals: Vec<usize> = scenario.vehicles.iter().zip(routes).map(own).collect();
    if scenario.fleet.simultaneous_arrival {
        let most = intervals.iter().max().copied().unwrap_or(0);
        intervals.fill(most);
    }
    intervals
}
