//! Linearised avoidance constraints at instants between the nodes.
//!
//! The position at a fraction τ of interval k moves with the nodes, δp(τ) = (1 - τ) δp_k + τ δp_{k+1}, and a row bounds
//! the motion against a normal n: n · δp(τ) >= -slack. Each of two vehicles makes up half of the missing distance, so
//! that they keep the full distance together, whatever the other one does.

use nalgebra::Vector2;
use scenarios::{Cylinder, Scenario};

use super::super::scaling::POSITION_M;
use super::closest_approach::ClosestApproach;
use super::conflict_detection::FleetMotion;
use crate::convex::HalfspaceConstraint;

/// Fraction of the required distance below which the normal is perpendicular to the relative velocity.
const PERPENDICULAR_BELOW: f64 = 0.6;

/// Fraction of the required distance below which the side is ambiguous, and every vehicle passes on the right.
const AMBIGUOUS_SIDE_BELOW: f64 = 0.02;

/// Relative speed below which its direction is undefined, m/s.
const MIN_RELATIVE_SPEED_MPS: f64 = 1e-3;

/// The row `normal · δp >= -slack`.
#[derive(Clone, Copy, Debug)]
pub struct AvoidanceRow {
    /// Unit normal, pointing away from the other.
    pub normal: Vector2<f64>,
    /// Distance that may be given up along the normal, m; negative if distance is missing.
    pub slack_m: f64,
}

impl AvoidanceRow {
    /// Linearises the distance at a closest approach, for the required distance `required_m`.
    ///
    /// At larger distances the normal points straight away from the other. Closer than [`PERPENDICULAR_BELOW`], such a
    /// row would push a vehicle that flies towards the other backwards. There the normal is perpendicular to the
    /// relative velocity, and the required distance along it is that of the circle around the other.
    pub fn new(approach: &ClosestApproach, required_m: f64) -> Self {
        let ClosestApproach { relative, distance_m, .. } = *approach;
        let (position_m, velocity_mps) = (relative.position_m, relative.velocity_mps);
        let speed_mps = velocity_mps.x.hypot(velocity_mps.y);
        let is_slow = speed_mps < MIN_RELATIVE_SPEED_MPS;
        if distance_m >= PERPENDICULAR_BELOW * required_m || (is_slow && distance_m > 0.0) {
            return Self { normal: position_m / distance_m, slack_m: distance_m - required_m };
        }
        let right = if is_slow { Vector2::x() } else { Vector2::new(velocity_mps.y, -velocity_mps.x) / speed_mps };
        let to_right_m = right.dot(&position_m);
        let side = if to_right_m < -AMBIGUOUS_SIDE_BELOW * required_m { -1.0 } else { 1.0 };
        let along_m = (distance_m * distance_m - to_right_m * to_right_m).max(0.0).sqrt();
        let needed_m = (required_m * required_m - along_m * along_m).sqrt();
        Self { normal: right * side, slack_m: side * to_right_m - needed_m }
    }

    /// The row in the variables of a subproblem, at a fraction of an interval.
    pub fn halfspace(&self, interval: usize, fraction: f64) -> HalfspaceConstraint {
        let weighted = |weight: f64| (self.normal * -weight).into();
        HalfspaceConstraint {
            stage: interval,
            current: weighted(1.0 - fraction),
            next: if fraction > 0.0 { weighted(fraction) } else { [0.0; 2] },
            bound: self.slack_m / POSITION_M,
        }
    }
}

/// The rows of every vehicle that can bind when no vehicle moves by more than `trust_region_m` in x and in y.
pub fn avoidance_rows(
    motion: &FleetMotion,
    constraints: &AvoidanceConstraints,
    trust_region_m: f64,
) -> Vec<Vec<HalfspaceConstraint>> {
    let mut rows = vec![Vec::new(); motion.vehicles.len()];
    let max_move_m = std::f64::consts::SQRT_2 * trust_region_m;
    let clearance_m = constraints.clearance_m + constraints.margin_m;
    for conflict in motion.obstacle_conflicts(constraints.cylinders, clearance_m + max_move_m) {
        let required_m = constraints.cylinders[conflict.obstacle].radius_m + clearance_m;
        let row = AvoidanceRow::new(&conflict.approach, required_m);
        rows[conflict.vehicle].push(row.halfspace(conflict.interval, conflict.approach.fraction));
    }
    let required_m = constraints.separation_m + constraints.margin_m;
    for conflict in motion.conflicts(required_m + 2.0 * max_move_m) {
        let AvoidanceRow { normal, slack_m } = AvoidanceRow::new(&conflict.approach, required_m);
        for (vehicle, sign) in conflict.vehicles.into_iter().zip([1.0, -1.0]) {
            let (interval, fraction) = motion.locate(vehicle, conflict.at_s);
            let half = AvoidanceRow { normal: normal * sign, slack_m: 0.5 * slack_m };
            rows[vehicle].push(half.halfspace(interval, fraction));
        }
    }
    rows
}

/// The distances that a plan must keep.
#[derive(Clone, Copy, Debug)]
pub struct AvoidanceConstraints<'a> {
    /// Obstacles.
    pub cylinders: &'a [Cylinder],
    /// Distance from the surface of an obstacle, m: the largest body radius of a vehicle.
    pub clearance_m: f64,
    /// Distance between two vehicles, m: the separation of the fleet, at least two body radii.
    pub separation_m: f64,
    /// Additional margin of the planner, m.
    pub margin_m: f64,
}

impl<'a> AvoidanceConstraints<'a> {
    /// The constraints of a scenario.
    pub fn new(scenario: &'a Scenario, margin_m: f64) -> Self {
        let radius_m = |vehicle| scenario.fixed_wing_model(vehicle).body_radius_m;
        let clearance_m = scenario.vehicles.iter().map(radius_m).fold(0.0, f64::max);
        Self {
            cylinders: &scenario.world.cylinders,
            clearance_m,
            separation_m: scenario.horizontal_separation_m().unwrap_or(0.0).max(2.0 * clearance_m),
            margin_m,
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::super::super::dynamics::{Control, State};
    use super::super::super::iterate::Iterate;
    use super::super::motion::MotionSample;
    use super::*;

    fn approach(position_m: [f64; 2], velocity_mps: [f64; 2]) -> ClosestApproach {
        let [position_m, velocity_mps] = [position_m, velocity_mps].map(Vector2::from);
        let distance_m = position_m.x.hypot(position_m.y);
        ClosestApproach { fraction: 0.5, relative: MotionSample { position_m, velocity_mps }, distance_m }
    }

    #[test]
    fn at_larger_distances_the_normal_points_straight_away() {
        let AvoidanceRow { normal, slack_m } = AvoidanceRow::new(&approach([9.0, 12.0], [-60.0, 0.0]), 20.0);
        assert_eq!((normal, slack_m), (Vector2::new(0.6, 0.8), -5.0));
    }

    #[test]
    fn at_small_distances_the_normal_is_perpendicular_to_the_relative_velocity() {
        let AvoidanceRow { normal, slack_m } = AvoidanceRow::new(&approach([3.0, 4.0], [-60.0, 0.0]), 20.0);
        assert_eq!(normal, Vector2::y());
        // 3 m from the centre, the circle has a half-width of sqrt(400 - 9) m
        assert!((slack_m - (4.0 - 391_f64.sqrt())).abs() < 1e-12);
    }

    #[test]
    fn two_vehicles_head_on_both_turn_right() {
        let eastbound = AvoidanceRow::new(&approach([0.0, 0.0], [70.0, 0.0]), 20.0);
        let westbound = AvoidanceRow::new(&approach([0.0, 0.0], [-70.0, 0.0]), 20.0);
        assert_eq!((eastbound.normal, westbound.normal), (-Vector2::y(), Vector2::y()));
        assert_eq!(eastbound.slack_m, -20.0);
    }

    /// Straight flights in all directions through a square.
    fn motion() -> FleetMotion {
        let mut rng = scenarios::stream(3, "test/rows");
        let trajectories = (0..25).map(|_| {
            let [x, y, χ] = [2000.0, 2000.0, 6.0].map(|width| width * (rng.random::<f64>() - 0.5));
            let at = |k: usize| {
                let along_m = 35.0 * 4.0 * k as f64;
                State::new(x + along_m * χ.cos(), y + along_m * χ.sin(), 400.0, 35.0, χ, 0.0)
            };
            let controls = vec![Control::new(0.0, 0.0, 1.0); 9];
            Iterate { states: (0..9).map(at).collect(), controls, dt_s: 4.0, ramp: 0.25 }
        });
        FleetMotion::new(&trajectories.collect::<Vec<_>>())
    }

    #[test]
    fn omitted_rows_cannot_bind() {
        let cylinders = [[-500.0, 300.0], [600.0, -200.0]].map(|center_m| Cylinder {
            name: "threat".into(),
            center_m,
            radius_m: 250.0,
        });
        let constraints =
            AvoidanceConstraints { cylinders: &cylinders, clearance_m: 1.5, separation_m: 50.0, margin_m: 0.5 };
        let motion = motion();
        let everything = avoidance_rows(&motion, &constraints, 1e5);
        for half_width_m in [5.0, 40.0, 200.0] {
            let kept = avoidance_rows(&motion, &constraints, half_width_m);
            let (mut omitted, mut binding) = (0, 0);
            for (all, kept) in everything.iter().zip(&kept) {
                assert!(kept.iter().all(|row| all.contains(row)));
                for row in all.iter().filter(|row| !kept.contains(row)) {
                    let coefficients = row.current.iter().chain(&row.next).map(|c| c.abs()).sum::<f64>();
                    let max_change = coefficients * half_width_m / POSITION_M;
                    assert!(
                        max_change <= row.bound + 1e-12,
                        "bound {}, but the row can change by {max_change}",
                        row.bound
                    );
                    omitted += 1;
                }
                binding += kept.len();
            }
            assert!(omitted > 0 && binding > 0, "{omitted} rows omitted, {binding} kept");
        }
    }
}
