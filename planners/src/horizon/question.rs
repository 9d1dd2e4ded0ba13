//! What is asked at one instant: the optimal control problem over one horizon (eq. 7 to 10, 18 to 21).

use super::cost_map::CostMap;
use super::motion::{State, sagitta_m};
use super::outlook::Outlook;
use crate::free_space::vector::{Point, distance, norm};
use crate::free_space::{FreeSpace, Mover, Obstacle};

/// Once too near, a vehicle need not be clear at once: the clearance asked for grows at this rate, m/s.
const REGAIN_MPS: f64 = 0.25;

/// What a vehicle keeps to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// |v| <= v_max, m/s (eq. 20).
    pub speed_mps: f64,
    /// |a| <= a_max, m/s² (eq. 21).
    pub acceleration_mps2: f64,
}

impl Limits {
    /// Way to a stop from full speed, m.
    pub fn stopping_distance_m(&self) -> f64 {
        0.5 * self.speed_mps * self.speed_mps / self.acceleration_mps2
    }

    /// Time to a stop from full speed, s.
    pub fn stopping_time_s(&self) -> f64 {
        self.speed_mps / self.acceleration_mps2
    }
}

/// The horizon's grid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Steps H_p.
    pub steps: usize,
    /// Coordinates that are free: 2 in the plane, 3 in space.
    pub axes: usize,
}

impl Grid {
    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.steps * self.axes
    }
}

/// Repulsion from obstacles within d_n (eq. 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repulsion {
    /// k_rep, m² where the bracket is squared, else m·m.
    pub gain: f64,
    /// d_n: distance beyond the clearance at which it begins, m.
    pub reach_m: f64,
    /// The usual form (Khatib 1986) squares the bracket; the paper prints it without the square.
    pub is_squared: bool,
}

/// What a feasible particle costs.
#[derive(Clone, Copy, Debug)]
pub enum Cost<'a> {
    /// The way left by the cost map, from the horizon's end and on the average over the horizon (eq. 10), plus repulsion
    /// where there is one (eq. 16).
    Map {
        /// The map.
        map: &'a CostMap,
        /// U_rep.
        repulsion: Option<Repulsion>,
    },
    /// Attraction by the goal (eq. 2) with gain k_att, and repulsion; no map (eq. 17).
    Field {
        /// k_att, 1/m.
        attraction: f64,
        /// U_rep.
        repulsion: Repulsion,
    },
}

impl Cost<'_> {
    /// The repulsion in it.
    pub fn repulsion(&self) -> Option<Repulsion> {
        match *self {
            Self::Map { repulsion, .. } => repulsion,
            Self::Field { repulsion, .. } => Some(repulsion),
        }
    }
}

/// Weights of the violation (eq. 12): of distances, speeds, accelerations.
pub const VIOLATION: [f64; 3] = [1.0, 0.3, 0.1];

/// Rules of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules {
    /// Controls are projected onto the norm bounds, so that no particle violates them.
    pub is_projected: bool,
    /// Coming to a stop in free space must be possible after this step, and after the last; without it there is no such
    /// rule.
    pub stops_after: Option<usize>,
    /// The cost of infeasible particles is computed too, though nobody looks at it.
    pub costs_infeasible: bool,
}

/// One replan.
#[derive(Clone, Debug)]
pub struct Question<'a> {
    /// State from which the horizon begins, at time 0.
    pub start: State,
    /// Acceleration that is applied until then, m/s².
    pub applied: Point,
    /// Where to.
    pub goal: Point,
    /// The world at time 0.
    pub space: &'a FreeSpace,
    /// Bounds.
    pub limits: Limits,
    /// Steps and coordinates.
    pub grid: Grid,
    /// Sampling time T, s.
    pub step_s: f64,
    /// Distance to keep, m.
    pub clearance_m: f64,
    /// What a feasible particle costs.
    pub cost: Cost<'a>,
    /// Weight of the squared changes of acceleration, m per (m/s²)².
    pub smoothness: f64,
    /// Weight of the mean over the horizon beside the value at its end, -.
    pub stage_weight: f64,
    /// The speed at the horizon's end is charged with its stopping distance: for arrivals without the stopping rule.
    pub charges_speed: bool,
    /// Rules of the search.
    pub rules: Rules,
}

/// What a question's answers are measured against: obstacles in reach, and the distance to keep at each step.
#[derive(Clone, Debug)]
pub struct Surroundings<'a> {
    /// Obstacles in reach that stand still.
    pub standing: Vec<&'a Obstacle>,
    /// Obstacles in reach that move, with their displacement at the end of each step (the first: at time 0), m.
    pub moving: Vec<(&'a Mover, Vec<Point>)>,
    /// Distance that chords must keep, arcs included, at each step, m.
    pub required_m: Vec<f64>,
    /// Ways to the goal, where the cost is by a map.
    pub outlook: Option<Outlook<'a>>,
}

impl<'a> Question<'a> {
    /// What is in reach of the horizon.
    pub fn surroundings(&self) -> Surroundings<'a> {
        let duration_s = self.grid.steps as f64 * self.step_s;
        let asked_m = self.clearance_m + sagitta_m(self.limits.acceleration_mps2, self.step_s);
        let noticed_m = self.noticed_m();
        let speed_mps = self.limits.speed_mps.max(norm(self.start.velocity));
        let reach_m = speed_mps * duration_s + self.limits.stopping_distance_m() + noticed_m;
        let standing = self.space.standing.iter();
        let now_m =
            self.space.distance_m(self.start.position).min(self.space.distance_to_moving_m(self.start.position, 0.0));
        let required_m = |step: usize| asked_m.min(now_m + REGAIN_MPS * step as f64 * self.step_s).max(0.0);
        Surroundings {
            standing: standing.filter(|obstacle| obstacle.distance_m(self.start.position) <= reach_m).collect(),
            moving: self.space.moving.iter().map(|mover| (mover, self.displacements(mover))).collect(),
            required_m: (0..=self.grid.steps).map(required_m).collect(),
            outlook: match self.cost {
                Cost::Map { map, .. } => Some(map.outlook(self.space, self.start.position)),
                Cost::Field { .. } => None,
            },
        }
    }

    /// Distance from which on nothing depends on an obstacle, m.
    pub fn noticed_m(&self) -> f64 {
        let asked_m = self.clearance_m + sagitta_m(self.limits.acceleration_mps2, self.step_s);
        asked_m + self.cost.repulsion().map_or(0.0, |repulsion| repulsion.reach_m)
    }

    fn displacements(&self, mover: &Mover) -> Vec<Point> {
        (0..=self.grid.steps).map(|step| mover.offset_m(step as f64 * self.step_s)).collect()
    }

    /// Can the goal be reached within the horizon, as the crow flies?
    pub fn is_near_goal(&self) -> bool {
        let reach_m = self.limits.speed_mps * self.grid.steps as f64 * self.step_s;
        distance(self.start.position, self.goal) <= reach_m
    }
}
