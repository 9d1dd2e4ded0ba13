//! The optimal control problem of one aircraft, in the units of the program.

use scenarios::{Range, Scenario};

use super::neighbour::Neighbour;
use super::units::{LENGTH_M, SPEED_MPS};
use crate::pseudospectral::Duration;

/// Weight of the squared load factors beside the flight time in minimum-time problems: it selects one of the controls that
/// are equally fast.
const EFFORT_PER_TIME: f64 = 1e-2;

/// Margin of all limits, in units of the program: what a constraint may be violated by between the nodes of a refined mesh.
/// Distances 0.1 m, speeds 0.01 m/s, sines 1e-4.
pub const TOLERANCE: f64 = 1e-4;

/// Default distance kept beyond the clearance and the separation, m: that of `fleet-scp`.
const MARGIN_M: f64 = 0.5;

/// One aircraft on its way.
#[derive(Clone, Debug)]
pub struct Problem {
    /// Initial and final position and velocity.
    pub ends: [[f64; 6]; 2],
    /// Bounds of the position.
    pub position: [[f64; 2]; 3],
    /// Bounds of the speed.
    pub speed: [f64; 2],
    /// Sines of the bounds of the flight-path angle.
    pub climb: [f64; 2],
    /// Bounds of (n_x, n_y, n_z).
    pub load_factors: [[f64; 2]; 3],
    /// Cylinders: centre and distance that the aircraft keeps from it.
    pub obstacles: Vec<([f64; 2], f64)>,
    /// Aircraft that were planned before.
    pub neighbours: Vec<Neighbour>,
    /// Horizontal distance kept from them.
    pub separation: f64,
    /// Duration of the flight.
    pub duration: Duration,
}

impl Problem {
    /// The problem of a vehicle without neighbours.
    pub fn new(scenario: &Scenario, vehicle: usize, duration: Duration) -> Self {
        let own = &scenario.vehicles[vehicle];
        let model = scenario.fixed_wing_model(own);
        let limits = &model.planning_limits;
        let margin_m = scenario.planner.margin_m.unwrap_or(MARGIN_M);
        let ends: [[f64; 6]; 2] = [&own.start, &own.goal].map(|waypoint| {
            let state = waypoint.fixed_wing_state();
            let (position_m, velocity_mps) = (state.position_m(), state.velocity_mps());
            std::array::from_fn(|k| if k < 3 { position_m[k] / LENGTH_M } else { velocity_mps[k - 3] / SPEED_MPS })
        });
        let [x, y, _] = scenario.world.map.axes();
        let position = [x, y, limits.altitude_m].map(|range| scaled(range, LENGTH_M));
        let speed = |end: &[f64; 6]| end[3].hypot(end[4]).hypot(end[5]);
        let cylinders = scenario.world.cylinders.iter();
        Self {
            ends,
            position: std::array::from_fn(|axis| inset(position[axis], ends.map(|end| end[axis]))),
            speed: inset(scaled(limits.speed_mps, SPEED_MPS), ends.each_ref().map(speed)),
            climb: inset(
                scaled(limits.flight_path_deg, 1.0).map(|angle_deg| angle_deg.to_radians().sin()),
                ends.each_ref().map(|end| end[5] / speed(end)),
            ),
            load_factors: limits.controls().map(|range| scaled(range, 1.0)),
            obstacles: cylinders
                .map(|it| {
                    let distance_m = it.radius_m + model.body_radius_m + margin_m;
                    (it.center_m.map(|x| x / LENGTH_M), distance_m / LENGTH_M)
                })
                .collect(),
            neighbours: Vec::new(),
            separation: scenario
                .horizontal_separation_m()
                .map_or(0.0, |separation_m| (separation_m + margin_m) / LENGTH_M),
            duration,
        }
    }

    /// Cost per unit of time; zero where the duration is fixed.
    pub fn time_cost(&self) -> f64 {
        if matches!(self.duration, Duration::Fixed(_)) { 0.0 } else { 1.0 }
    }

    /// Weight of the squared load factors.
    pub fn effort_weight(&self) -> f64 {
        if matches!(self.duration, Duration::Fixed(_)) { 1.0 } else { EFFORT_PER_TIME }
    }
}

/// The range without a margin of [`TOLERANCE`] at either side, as far as start and goal admit it.
fn inset([min, max]: [f64; 2], ends: [f64; 2]) -> [f64; 2] {
    let (lowest, highest) = (ends[0].min(ends[1]), ends[0].max(ends[1]));
    [(min + TOLERANCE).min(lowest).max(min), (max - TOLERANCE).max(highest).min(max)]
}

fn scaled(range: Range, unit: f64) -> [f64; 2] {
    [range.min / unit, range.max / unit]
}
