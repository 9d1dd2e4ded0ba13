//! The optimal control problem over one horizon (eq. 7 to 10, 18 to 21).

use crate::free_space::{FreeSpace, MovingObstacle, Obstacle, Point};
use crate::multirotor::{PlanningLimits, PointMassState, sagitta_m};
use crate::roadmap::{CostMap, CostToGoQuery};

/// Rounding error between two computations of one distance, m.
pub const CLEARANCE_TOLERANCE_M: f64 = 1e-9;

/// Rate at which the required clearance grows over the horizon if the start violates it, m/s.
const CLEARANCE_RECOVERY_MPS: f64 = 0.25;

/// Discretisation of the controls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ControlGrid {
    /// Number of steps H_p.
    pub steps: usize,
    /// Number of free coordinates: 2 in the plane, 3 in space.
    pub axes: usize,
}

impl ControlGrid {
    /// Number of unknowns.
    pub fn unknowns(&self) -> usize {
        self.steps * self.axes
    }
}

/// Repulsive potential U_rep of the obstacles (eq. 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Repulsion {
    /// k_rep, in m³ if the bracket is squared, else in m².
    pub gain: f64,
    /// d_n: distance beyond the clearance within which obstacles repel, m.
    pub reach_m: f64,
    /// Squares the bracket, as is usual (Khatib 1986); the paper prints it without the square.
    pub is_squared: bool,
    /// Every obstacle within range repels, and the frame; otherwise the nearest of them alone.
    pub is_by_all: bool,
}

/// Cost of a feasible particle.
#[derive(Clone, Copy, Debug)]
pub enum Cost<'a> {
    /// Cost-to-go at the end of the horizon and on average over the horizon (eq. 10), with an optional repulsion (eq. 16).
    CostMap {
        /// The cost map.
        map: &'a CostMap,
        /// U_rep.
        repulsion: Option<Repulsion>,
    },
    /// Potential field without a map (eq. 17): attraction by the goal (eq. 2) and repulsion.
    PotentialField {
        /// U_att.
        attraction: Attraction,
        /// U_rep.
        repulsion: Repulsion,
    },
}

/// Attractive potential U_att of the goal (eq. 2).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attraction {
    /// k_att, 1/m.
    pub gain: f64,
    /// The mean over the horizon's steps counts; otherwise the value at its end.
    pub is_along_horizon: bool,
}

impl Cost<'_> {
    /// The repulsive part.
    pub fn repulsion(&self) -> Option<Repulsion> {
        match *self {
            Self::CostMap { repulsion, .. } => repulsion,
            Self::PotentialField { repulsion, .. } => Some(repulsion),
        }
    }
}

/// Default weights w_1, w_2, w_3 of the violations of distance, speed and acceleration (eq. 12).
pub const VIOLATION_WEIGHTS: [f64; 3] = [1.0, 0.3, 0.1];

/// How particles are evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EvaluationOptions {
    /// Projects the controls onto the norm bounds, so that no particle violates them.
    pub projects_controls: bool,
    /// Requires that a stop in free space is possible after this step and after the last one. Absent: no requirement.
    pub stop_after_step: Option<usize>,
    /// Computes the cost of infeasible particles too, although it is not used.
    pub costs_infeasible: bool,
}

/// The optimal control problem of one replan.
#[derive(Clone, Debug)]
pub struct HorizonProblem<'a> {
    /// Initial state, at time 0.
    pub start: PointMassState,
    /// Acceleration that is applied until time 0, m/s².
    pub applied_acceleration: Point,
    /// Goal, m.
    pub goal: Point,
    /// The world at time 0.
    pub space: &'a FreeSpace,
    /// Norm bounds.
    pub limits: PlanningLimits,
    /// Steps and coordinates.
    pub grid: ControlGrid,
    /// Sampling time T, s.
    pub step_s: f64,
    /// Required distance from obstacles and bounds, m.
    pub clearance_m: f64,
    /// Cost of a feasible particle.
    pub cost: Cost<'a>,
    /// Weights w_1, w_2, w_3 of the violations of distance, speed and acceleration (eq. 12).
    pub violation_weights: [f64; 3],
    /// Weight of the squared changes of acceleration, m per (m/s²)².
    pub smoothness_weight: f64,
    /// Weight of the mean over the horizon relative to the value at its end, -.
    pub stage_weight: f64,
    /// Adds the stopping distance from the speed at the horizon's end to the cost: for arrivals without a required stop.
    pub costs_final_speed: bool,
    /// How particles are evaluated.
    pub options: EvaluationOptions,
}

/// What all evaluations of one problem share.
#[derive(Clone, Debug)]
pub struct EvaluationContext<'a> {
    /// Static obstacles within reach of the horizon.
    pub static_obstacles: Vec<&'a Obstacle>,
    /// Moving obstacles, with their displacements at the times of the samples 0 ..= H_p, m.
    pub moving_obstacles: Vec<(&'a MovingObstacle, Vec<Point>)>,
    /// Distance that the chord of each step must keep, the sagitta of its arc included, m.
    pub required_clearance_m: Vec<f64>,
    /// Cost-to-go near the start, if the cost is by a map.
    pub cost_to_go: Option<CostToGoQuery<'a>>,
}

impl<'a> HorizonProblem<'a> {
    /// The data that all evaluations share.
    pub fn evaluation_context(&self) -> EvaluationContext<'a> {
        let start = self.start.position;
        let duration_s = self.grid.steps as f64 * self.step_s;
        let influence_m = self.influence_distance_m();
        let speed_mps = self.limits.speed_mps.max(self.start.velocity.norm());
        let reach_m = speed_mps * duration_s + self.limits.stopping_distance_m() + influence_m;
        let chord_clearance_m = self.chord_clearance_m();
        let start_clearance_m = self.start_clearance_m();
        let required_m = |step: usize| {
            chord_clearance_m.min(start_clearance_m + CLEARANCE_RECOVERY_MPS * step as f64 * self.step_s).max(0.0)
        };
        let static_obstacles = self.space.static_obstacles.iter();
        let moving_obstacles = self.space.moving_obstacles.iter();
        EvaluationContext {
            static_obstacles: static_obstacles.filter(|obstacle| obstacle.distance_m(start) <= reach_m).collect(),
            moving_obstacles: moving_obstacles.map(|obstacle| (obstacle, self.displacements(obstacle))).collect(),
            required_clearance_m: (0..=self.grid.steps).map(required_m).collect(),
            cost_to_go: match self.cost {
                Cost::CostMap { map, .. } => Some(map.query_near(start, self.space)),
                Cost::PotentialField { .. } => None,
            },
        }
    }

    /// Distance beyond which an obstacle affects neither violation nor cost, m.
    pub fn influence_distance_m(&self) -> f64 {
        self.chord_clearance_m() + self.cost.repulsion().map_or(0.0, |repulsion| repulsion.reach_m)
    }

    /// Signed distance from the start to the nearest obstacle or bound at time 0, m.
    pub fn start_clearance_m(&self) -> f64 {
        let start = self.start.position;
        self.space.distance_m(start).min(self.space.distance_to_moving_m(start, 0.0))
    }

    /// Is the goal within the distance that can be flown in the horizon?
    pub fn is_goal_within_reach(&self) -> bool {
        let reach_m = self.limits.speed_mps * self.grid.steps as f64 * self.step_s;
        (self.start.position - self.goal).norm() <= reach_m
    }

    /// Distance that chords keep so that the arcs keep the clearance, m.
    fn chord_clearance_m(&self) -> f64 {
        self.clearance_m + sagitta_m(self.limits.acceleration_mps2, self.step_s)
    }

    fn displacements(&self, obstacle: &MovingObstacle) -> Vec<Point> {
        (0..=self.grid.steps).map(|step| obstacle.displacement_m(step as f64 * self.step_s)).collect()
    }
}
