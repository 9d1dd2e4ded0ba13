//! The flight-path angles that a plan uses.
//!
//! Separation and obstacles are horizontal. A change of altitude therefore saves no time, and the subproblems leave the
//! vertical motion undetermined within its limits: their solutions would climb and descend from node to node. The bounds
//! of the flight-path angle are those that the change of altitude from start to goal needs.

use scenarios::Range;

use super::super::iterate::Iterate;
use crate::convex::STAGE_LEN;

/// Indices of altitude and flight-path angle.
const ALTITUDE: usize = 2;
const CLIMB: usize = 5;

/// Flight-path angle in use relative to that of a uniform climb.
const CLIMB_FACTOR: f64 = 1.4;

/// Additional range of the flight-path angle on both sides, as a fraction of that of its limits.
const CLIMB_MARGIN: f64 = 0.15;

/// The limits, with the flight-path angles that a plan near the initial trajectory needs.
pub fn bounds_in_use(limits: &[Range; STAGE_LEN], initial: &Iterate) -> [Range; STAGE_LEN] {
    let states = &initial.states;
    let steps = states.windows(2).map(|pair| (pair[1] - pair[0]).fixed_rows::<2>(0).norm());
    let [start, goal] = [&states[0], &states[states.len() - 1]];
    let needed = CLIMB_FACTOR * ((goal[ALTITUDE] - start[ALTITUDE]) / steps.sum::<f64>()).atan();
    let margin = CLIMB_MARGIN * limits[CLIMB].width();
    let angles = [0.0, needed, start[CLIMB], goal[CLIMB]];
    let (min, max) = angles.into_iter().fold((0.0_f64, 0.0_f64), |(min, max), angle| (min.min(angle), max.max(angle)));
    let mut bounds = *limits;
    bounds[CLIMB] = Range::new(limits[CLIMB].min.max(min - margin), limits[CLIMB].max.min(max + margin));
    bounds
}

#[cfg(test)]
mod tests {
    use super::super::super::dynamics::{Control, State};
    use super::*;

    fn in_use(goal_z_m: f64, start_rad: f64) -> Range {
        let mut limits = [Range::new(-1e4, 1e4); STAGE_LEN];
        limits[CLIMB] = Range::new(-0.1, 0.1);
        let states =
            vec![State::new(0.0, 0.0, 400.0, 35.0, 0.0, start_rad), State::new(2000.0, 0.0, goal_z_m, 35.0, 0.0, 0.0)];
        let controls = vec![Control::new(0.0, 0.0, 1.0); 2];
        bounds_in_use(&limits, &Iterate { states, controls, dt_s: 57.0, ramp: 0.25 })[CLIMB]
    }

    #[test]
    fn level_flights_stay_nearly_level_and_climbs_climb() {
        assert_eq!(in_use(400.0, 0.0), Range::new(-0.03, 0.03));
        let climb = in_use(480.0, 0.0);
        assert!(climb.min == -0.03 && (0.08..0.09).contains(&climb.max), "{climb:?}");
        assert_eq!(in_use(590.0, 0.0).max, 0.1);
        assert!(in_use(400.0, -0.09).min == -0.1);
    }
}
