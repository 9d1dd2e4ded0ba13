//! The judge as a guard: may this candidate trajectory be published to the vehicle?
//!
//! ```text
//! measured state, obstacles known now, candidate -> Guard -> pass, fail or undecided, with a margin for every check
//! ```
//!
//! The guard makes the judge's own checks of a plan before the flight (`plan.clearance`, `plan.state_limits`,
//! `plan.control_limits`, `plan.rest`), by the same functions, and compares the beginning of the candidate with the
//! measured state. It does not simulate. It keeps its work memory: after the longest candidate has been seen once,
//! [`Guard::judge`] allocates nothing.
//!
//! It differs from the judge in one respect, for the sake of time: the bounds of the clearance are 5 % of it apart (and
//! 0.1 mm at least) instead of 0.1 mm, and a search that is not over after 4000 intervals leaves them further apart. The
//! lower bound decides, so a pass is as certain as the judge's.
//!
//! # Examples
//!
//! ```
//! use std::path::Path;
//!
//! use harness::guard::{Guard, Knot};
//! use harness::verdict::Status;
//!
//! let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/multirotor/trap.toml");
//! let scenario = scenarios::load(&file)?;
//! let start_m = scenario.vehicles[0].start.position_m();
//! let mut guard = Guard::new(&scenario, &scenario.vehicles[0].name)?;
//! let hover = |t_s| Knot { t_s, position_m: start_m, velocity_mps: [0.0; 3] };
//! let assessment = guard.judge(&[hover(0.0), hover(5.0)], Some(&hover(0.0)));
//! assert_eq!(assessment.status, Status::Pass);
//! assert!(assessment.check("plan.clearance").unwrap().margin > 0.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use scenarios::{AppliedLimits, CheckSpec, Family, Scenario, World, check_spec, closest_name};
use sim::Obstacles;
use thiserror::Error;

use super::between_nodes::BetweenNodes;
use super::clearance::FRAME;
use super::limits::Limited;
use crate::verdict::Status;
use crate::verdict::compare::exceeds;
use crate::verdict::evidence::{status_at_least, status_at_most, status_inside};
use crate::verdict::motion::{KnotDefect, Motion};
use crate::verdict::obstacle_approach::search::{Approach, Body, Effort, PathLengths, Search};
use crate::verdict::worst::Worst;

pub use crate::verdict::motion::Knot;

/// Bounds of the clearance that are close enough, and the longest search, some tenths of a millisecond.
const EFFORT: Effort = Effort {
    resolution_m: |distance_m| (0.05 * distance_m.abs()).max(1e-4),
    uses_convexity: true,
    max_intervals: 4000,
};
/// Number of checks.
const CHECKS: usize = 6;

/// Why there is no guard for a vehicle.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum GuardError {
    /// The vehicles are no multirotors.
    #[error(
        "scenario {scenario}: found the family {family}, expected multirotors; only their plans can be guarded so far"
    )]
    Family {
        /// Name of the scenario.
        scenario: String,
        /// Its family.
        family: Family,
    },
    /// There is no vehicle of this name.
    #[error("scenario {scenario}: found no vehicle `{vehicle}`{}", did_you_mean(closest))]
    UnknownVehicle {
        /// Name of the scenario.
        scenario: String,
        /// What was asked for.
        vehicle: String,
        /// The closest name.
        closest: Option<String>,
    },
}

fn did_you_mean(closest: &Option<String>) -> String {
    closest.as_ref().map_or_else(String::new, |closest| format!("; did you mean `{closest}`?"))
}

/// Judges candidates for one multirotor, again and again.
#[derive(Clone, Debug)]
pub struct Guard {
    scenario: Scenario,
    vehicle: usize,
    limits: AppliedLimits,
    obstacles: Obstacles,
    motion: Motion,
    lengths: PathLengths,
}

/// What the guard says of a candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assessment {
    /// Fail if a check failed, else undecided if one is undecided, else pass.
    pub status: Status,
    /// Why the candidate is no motion; every check has then failed.
    pub defect: Option<KnotDefect>,
    /// Every check, in the order of [`Guard`]'s description: the two of the start, then those of the plan.
    pub margins: [Margin; CHECKS],
}

impl Assessment {
    /// The check of this name.
    pub fn check(&self, name: &str) -> Option<&Margin> {
        self.margins.iter().find(|margin| margin.check == name)
    }
}

/// One check of a candidate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// `start.position`, `start.velocity`, or the judge's name of the check.
    pub check: &'static str,
    /// Its answer; skipped if there is nothing to compare with.
    pub status: Status,
    /// What was found, in `unit`: of a clearance the lower bound. NaN if nothing was.
    pub value: f64,
    /// What it is held against, in `unit`.
    pub limit: f64,
    /// Distance to the limit, positive when it is kept, in `unit`.
    pub margin: f64,
    /// Unit of the three.
    pub unit: &'static str,
    /// When, s.
    pub at_s: f64,
    /// The limited quantity, of `plan.state_limits` and `plan.control_limits`.
    pub quantity: Option<&'static str>,
    /// The obstacle, of `plan.clearance`: see [`Guard::obstacle_name`]. `None` for the frame of the map.
    pub obstacle: Option<usize>,
}

impl Margin {
    fn without_value(check: &'static str, unit: &'static str, status: Status) -> Self {
        let nan = f64::NAN;
        let (quantity, obstacle) = (None, None);
        Self { check, status, value: nan, limit: nan, margin: nan, unit, at_s: nan, quantity, obstacle }
    }

    /// Keeps `status` only if all numbers are finite: what cannot be measured fails.
    fn new(
        check: &'static str,
        unit: &'static str,
        status: Status,
        [value, limit, margin]: [f64; 3],
        at_s: f64,
    ) -> Self {
        let is_measured = value.is_finite() && limit.is_finite() && margin.is_finite();
        let status = if is_measured { status } else { Status::Fail };
        Self { value, limit, margin, at_s, ..Self::without_value(check, unit, status) }
    }

    /// At most `limit`.
    fn at_most(check: &'static str, unit: &'static str, value: f64, limit: f64, at_s: f64) -> Self {
        let status = if exceeds(value, limit) { Status::Fail } else { Status::Pass };
        Self::new(check, unit, status, [value, limit, limit - value], at_s)
    }
}

impl Guard {
    /// A guard for one vehicle of a scenario, which knows all of its obstacles.
    ///
    /// # Errors
    ///
    /// The scenario is not one of multirotors, or has no such vehicle.
    pub fn new(scenario: &Scenario, vehicle: &str) -> Result<Self, GuardError> {
        let name = scenario.name.clone();
        if scenario.family() != Family::Multirotor {
            return Err(GuardError::Family { scenario: name, family: scenario.family() });
        }
        let names = || scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str());
        let unknown = || GuardError::UnknownVehicle {
            scenario: name,
            vehicle: vehicle.to_owned(),
            closest: closest_name(vehicle, names()).map(str::to_owned),
        };
        let index = names().position(|name| name == vehicle).ok_or_else(unknown)?;
        let at_rest = |t_s| Knot { t_s, position_m: [0.0; 3], velocity_mps: [0.0; 3] };
        let motion = Motion::new(vehicle, vec![at_rest(0.0), at_rest(1.0)]).expect("a motion at rest");
        Ok(Self {
            scenario: scenario.clone(),
            vehicle: index,
            limits: scenario.limits(),
            obstacles: Obstacles::new(&scenario.world),
            motion,
            lengths: PathLengths::default(),
        })
    }

    /// Replaces the map and the obstacles by what is known now. Moving obstacles count at the times of the candidate.
    pub fn set_world(&mut self, world: &World) {
        self.obstacles = Obstacles::new(world);
        self.scenario.world = world.clone();
    }

    /// Name of an obstacle; of `None`, the frame of the map.
    pub fn obstacle_name(&self, obstacle: Option<usize>) -> &str {
        obstacle.map_or(FRAME, |obstacle| self.obstacles.name(obstacle))
    }

    /// Judges a candidate: the cubics through `knots`, world frame, after which the vehicle hovers.
    ///
    /// - `knots`: at least two, in the order of time; two at one time are a jump, which fails
    /// - `measured`: state of the vehicle at its time; the candidate has to be within `verdict.tracking_max_m` of its
    ///   position, and within the change of velocity that the vehicle can make in one planning period
    ///
    /// Whatever the numbers are, the result is an assessment; what is not finite fails.
    pub fn judge(&mut self, knots: &[Knot], measured: Option<&Knot>) -> Assessment {
        if let Err(defect) = self.motion.refill(knots) {
            return Assessment { status: Status::Fail, defect: Some(defect), margins: FAILED };
        }
        self.lengths.measure(&self.motion);
        let [position, velocity] = self.start(measured);
        let margins =
            [position, velocity, self.clearance(), self.state_limits(), self.control_limits(), self.rest(knots)];
        let any = |status| margins.iter().any(|margin| margin.status == status);
        let status = match () {
            () if any(Status::Fail) => Status::Fail,
            () if any(Status::Undecided) => Status::Undecided,
            () => Status::Pass,
        };
        Assessment { status, defect: None, margins }
    }

    fn start(&self, measured: Option<&Knot>) -> [Margin; 2] {
        let Some(measured) = measured else { return START.map(|(name, unit)| skipped(name, unit)) };
        let acceleration_mps2 = self.limited().physical().acceleration_mps2;
        let velocity_mps = acceleration_mps2 * self.scenario.simulation.planning.period_s;
        let [position, velocity] = START;
        let (off_m, off_mps) = match self.motion.state(measured.t_s) {
            None => (f64::NAN, f64::NAN),
            Some(expected) => (
                distance(expected.position_m, measured.position_m),
                distance(expected.velocity_mps, measured.velocity_mps),
            ),
        };
        [
            Margin::at_most(position.0, position.1, off_m, self.limits.tracking_max_m, measured.t_s),
            Margin::at_most(velocity.0, velocity.1, off_mps, velocity_mps, measured.t_s),
        ]
    }

    fn clearance(&self) -> Margin {
        let spec = spec("plan.clearance");
        let vehicle = &self.scenario.vehicles[self.vehicle];
        let reach_m = self.scenario.multirotor_model(vehicle).body_radius_m;
        let mut search = Search::new(&self.obstacles, EFFORT);
        let (vehicle, motion, lengths) = (self.vehicle, &self.motion, &self.lengths);
        let body = Body { vehicle, motion, lengths, reach_m };
        search.add_frame(&self.scenario.world.map, body);
        search.add_obstacles(body);
        let Some((Approach { distance_m, at_s, obstacle, .. }, lower_m)) = search.found() else {
            return Margin::without_value(spec.name, spec.unit, Status::Fail);
        };
        let status = status_at_least(spec, [lower_m, distance_m], 0.0);
        Margin { obstacle, ..Margin::new(spec.name, spec.unit, status, [lower_m, 0.0, lower_m], at_s) }
    }

    fn state_limits(&self) -> Margin {
        let limited = self.limited();
        limits_margin("plan.state_limits", |worst| limited.planned_states(worst, &self.motion, &BetweenNodes::EXACT))
    }

    fn control_limits(&self) -> Margin {
        let limited = self.limited();
        let limit_mps2 = limited.physical().acceleration_mps2;
        limits_margin("plan.control_limits", |worst| {
            limited.planned_accelerations(worst, &self.motion, &BetweenNodes::EXACT, limit_mps2);
        })
    }

    fn rest(&self, knots: &[Knot]) -> Margin {
        let spec = spec("plan.rest");
        let Some(last) = knots.last() else { return Margin::without_value(spec.name, spec.unit, Status::Fail) };
        let speed_mps = distance(last.velocity_mps, [0.0; 3]);
        let limit_mps = self.limits.rest_mps;
        let status = status_at_most(spec, [speed_mps; 2], limit_mps);
        Margin::new(spec.name, spec.unit, status, [speed_mps, limit_mps, limit_mps - speed_mps], last.t_s)
    }

    fn limited(&self) -> Limited<'_> {
        Limited::new(&self.scenario, &self.scenario.vehicles[self.vehicle])
    }
}

/// Names and units of the checks of the start.
const START: [(&str, &str); 2] = [("start.position", "m"), ("start.velocity", "m/s")];

/// The margins of what is no motion.
const FAILED: [Margin; CHECKS] = [
    failed(START[0].0, START[0].1),
    failed(START[1].0, START[1].1),
    failed("plan.clearance", "m"),
    failed("plan.state_limits", "-"),
    failed("plan.control_limits", "-"),
    failed("plan.rest", "m/s"),
];

const fn failed(check: &'static str, unit: &'static str) -> Margin {
    let nan = f64::NAN;
    let (quantity, obstacle) = (None, None);
    Margin { check, status: Status::Fail, value: nan, limit: nan, margin: nan, unit, at_s: nan, quantity, obstacle }
}

fn skipped(check: &'static str, unit: &'static str) -> Margin {
    Margin::without_value(check, unit, Status::Skip)
}

fn spec(name: &str) -> &'static CheckSpec {
    check_spec(name).expect("a declared check")
}

/// The limited quantity that uses most of its range.
fn limits_margin<'a>(name: &str, consider: impl FnOnce(&mut Worst<'a>)) -> Margin {
    let spec = spec(name);
    let mut worst = Worst::new();
    consider(&mut worst);
    let Some(found) = worst.into_deciding() else { return Margin::without_value(spec.name, spec.unit, Status::Fail) };
    let (limit, margin) = (found.limit(), found.quantity.range.margin(found.value));
    let spec = &CheckSpec { unit: found.quantity.unit, ..*spec };
    let status = status_inside(spec, limit, margin);
    let numbers = [found.value, limit, margin];
    Margin { quantity: Some(found.quantity.name), ..Margin::new(spec.name, spec.unit, status, numbers, found.t_s) }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}
