//! Where the sequence starts: everybody on a way that could be flown, at a speed that brings all there together, and no
//! crowd at one point.

use rayon::prelude::*;
use scenarios::Scenario;

use super::super::dynamics::State;
use super::super::iterate::Iterate;
use super::super::options::Options;
use super::guess::{self, Start};
use super::roundabout;
use super::rows::Rules;
use super::traffic::Traffic;

/// Share of an interval during which the controls change; then they stay.
///
/// With controls that run linearly over the whole interval, changes of alternating sign from node to node leave every
/// node's state as it is: nothing in the subproblem keeps a control from zigzagging for the rest of the flight. With
/// this, a zigzag dies down by a factor of seven from node to node.
const RAMP: f64 = 0.25;

/// The first trajectories.
pub struct FirstGuess {
    /// One per vehicle.
    pub trajectories: Vec<Iterate>,
    /// States at both ends of each; headings are those of the scenario up to full turns.
    pub boundary: Vec<[State; 2]>,
}

impl FirstGuess {
    /// Ways, speeds, and a roundabout for each crowd.
    pub fn new(scenario: &Scenario, options: &Options, rules: &Rules) -> Self {
        let mut starts = guess::starts(scenario, rules.clearance_m + rules.margin_m);
        let guess = Self::from_starts(scenario, options, &starts);
        let wanted_m = rules.separation_m + rules.margin_m;
        let crowds = roundabout::crowds(&Traffic::new(&guess.trajectories), wanted_m);
        if crowds.is_empty() {
            return guess;
        }
        roundabout::bow(&mut starts, &crowds, wanted_m);
        Self::from_starts(scenario, options, &starts)
    }

    fn from_starts(scenario: &Scenario, options: &Options, starts: &[Start]) -> Self {
        let vehicles = scenario.vehicles.par_iter().zip(starts);
        let trajectory = |(vehicle, start)| guess::trajectory(scenario, vehicle, start, options.intervals, RAMP);
        let (trajectories, boundary) = vehicles.map(trajectory).unzip();
        Self { trajectories, boundary }
    }
}
