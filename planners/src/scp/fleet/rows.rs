//! Avoidance rows at instants between the nodes.
//!
//! The position at a share τ of interval k moves with its nodes, δp(τ) = (1 - τ) δp_k + τ δp_{k+1}, and the row asks for
//! room along a normal n: n · δp(τ) >= -room. Two vehicles take half of what is missing each, so that both together keep
//! the whole: neither relies on where the other was.

use scenarios::{Cylinder, Scenario};

use super::super::scaling::POSITION_M;
use super::closest::Approach;
use super::traffic::Traffic;
use crate::convex::HalfspaceConstraint;

/// Nearer than this share of the wanted distance the way out leads sideways instead of straight away.
const SIDEWAYS_BELOW: f64 = 0.6;

/// Nearer than this share of the wanted distance the side is a matter of rounding, and everybody keeps to the right.
const NO_SIDE_BELOW: f64 = 0.02;

/// A direction to move in, and how far one may still move against it.
#[derive(Clone, Copy, Debug)]
pub struct Room {
    /// Unit normal.
    pub normal: [f64; 2],
    /// Room along it, m; negative where it is missing.
    pub room_m: f64,
}

/// The room that an approach leaves when `wanted_m` is the distance to keep.
///
/// Far enough out the normal points straight away from the other. Deep inside, that would push somebody who flies
/// towards the other back along his way: there the normal is perpendicular to the relative velocity, and the wanted
/// distance along it is that of the circle at the place along the way.
pub fn room(approach: &Approach, wanted_m: f64) -> Room {
    let Approach { relative, distance_m, .. } = *approach;
    let ([x, y], [vx, vy]) = (relative.position_m, relative.velocity_mps);
    let speed_mps = vx.hypot(vy);
    if distance_m >= SIDEWAYS_BELOW * wanted_m || (speed_mps < 1e-3 && distance_m > 0.0) {
        return Room { normal: [x / distance_m, y / distance_m], room_m: distance_m - wanted_m };
    }
    let right = if speed_mps < 1e-3 { [1.0, 0.0] } else { [vy / speed_mps, -vx / speed_mps] };
    let to_right_m = right[0] * x + right[1] * y;
    let side = if to_right_m < -NO_SIDE_BELOW * wanted_m { -1.0 } else { 1.0 };
    let along_m = (distance_m * distance_m - to_right_m * to_right_m).max(0.0).sqrt();
    let needed_m = (wanted_m * wanted_m - along_m * along_m).sqrt();
    Room { normal: right.map(|n| side * n), room_m: side * to_right_m - needed_m }
}

/// The row `n · δp(τ) >= -room` of an interval.
pub fn plane(interval: usize, share: f64, Room { normal, room_m }: Room) -> HalfspaceConstraint {
    let weighted = |weight: f64| normal.map(|n| -weight * n);
    let next = if share > 0.0 { weighted(share) } else { [0.0; 2] };
    HalfspaceConstraint { stage: interval, current: weighted(1.0 - share), next, bound: room_m / POSITION_M }
}

/// Rows of every vehicle.
pub struct Rows {
    /// One list per vehicle.
    pub planes: Vec<Vec<HalfspaceConstraint>>,
}

impl Rows {
    /// The rows that can bind when nobody moves farther than `trust_region_m` in x and in y.
    pub fn new(traffic: &Traffic, rules: &Rules, trust_region_m: f64) -> Self {
        let mut planes = vec![Vec::new(); traffic.tracks.len()];
        let farthest_m = std::f64::consts::SQRT_2 * trust_region_m;
        let clearance_m = rules.clearance_m + rules.margin_m;
        for passage in traffic.passages(rules.cylinders, clearance_m + farthest_m) {
            let wanted_m = rules.cylinders[passage.obstacle].radius_m + clearance_m;
            let row = plane(passage.interval, passage.approach.share, room(&passage.approach, wanted_m));
            planes[passage.who].push(row);
        }
        let wanted_m = rules.separation_m + rules.margin_m;
        for encounter in traffic.encounters(wanted_m + 2.0 * farthest_m) {
            let Room { normal, room_m } = room(&encounter.approach, wanted_m);
            for (who, sign) in encounter.who.into_iter().zip([1.0, -1.0]) {
                let (interval, share) = traffic.place(who, encounter.at_s);
                let half = Room { normal: normal.map(|n| sign * n), room_m: 0.5 * room_m };
                planes[who].push(plane(interval, share, half));
            }
        }
        Self { planes }
    }
}

/// What has to be kept clear of.
#[derive(Clone, Copy, Debug)]
pub struct Rules<'a> {
    /// Obstacles.
    pub cylinders: &'a [Cylinder],
    /// Distance from the surface of an obstacle, m: half of the largest airframe.
    pub clearance_m: f64,
    /// Distance between two vehicles, m: the fleet's rule, or that of two airframes that touch.
    pub separation_m: f64,
    /// Distance kept beyond both, m.
    pub margin_m: f64,
}

impl<'a> Rules<'a> {
    /// What the scenario asks for.
    pub fn new(scenario: &'a Scenario, margin_m: f64) -> Self {
        let radius_m = |vehicle| scenario.fixed_wing_model(vehicle).body_radius_m;
        let clearance_m = scenario.vehicles.iter().map(radius_m).fold(0.0, f64::max);
        Self {
            cylinders: &scenario.world.cylinders,
            clearance_m,
            separation_m: scenario.fleet.separation_m.unwrap_or(0.0).max(2.0 * clearance_m),
            margin_m,
        }
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::super::super::dynamics::{Control, State};
    use super::super::super::iterate::Iterate;
    use super::super::track::Instant;
    use super::*;

    fn approach(position_m: [f64; 2], velocity_mps: [f64; 2]) -> Approach {
        let distance_m = position_m[0].hypot(position_m[1]);
        Approach { share: 0.5, relative: Instant { position_m, velocity_mps }, distance_m }
    }

    #[test]
    fn far_out_the_way_out_is_straight_away() {
        let Room { normal, room_m } = room(&approach([9.0, 12.0], [-60.0, 0.0]), 20.0);
        assert_eq!((normal, room_m), ([0.6, 0.8], -5.0));
    }

    #[test]
    fn deep_inside_the_way_out_is_sideways() {
        let Room { normal, room_m } = room(&approach([3.0, 4.0], [-60.0, 0.0]), 20.0);
        assert_eq!(normal, [0.0, 1.0]);
        // at 3 m along the way the circle is sqrt(400 - 9) m wide
        assert!((room_m - (4.0 - 391_f64.sqrt())).abs() < 1e-12);
    }

    #[test]
    fn two_who_meet_head_on_both_turn_right() {
        let eastbound = room(&approach([0.0, 0.0], [70.0, 0.0]), 20.0);
        let westbound = room(&approach([0.0, 0.0], [-70.0, 0.0]), 20.0);
        assert_eq!((eastbound.normal, westbound.normal), ([0.0, -1.0], [0.0, 1.0]));
        assert_eq!(eastbound.room_m, -20.0);
    }

    /// Straight flights in all directions through a square.
    fn traffic() -> Traffic {
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
        Traffic::new(&trajectories.collect::<Vec<_>>())
    }

    #[test]
    fn rows_that_are_left_out_cannot_bind() {
        let cylinders = [[-500.0, 300.0], [600.0, -200.0]].map(|center_m| Cylinder {
            name: "threat".into(),
            center_m,
            radius_m: 250.0,
        });
        let rules = Rules { cylinders: &cylinders, clearance_m: 1.5, separation_m: 50.0, margin_m: 0.5 };
        let traffic = traffic();
        let everything = Rows::new(&traffic, &rules, 1e5);
        for half_width_m in [5.0, 40.0, 200.0] {
            let kept = Rows::new(&traffic, &rules, half_width_m);
            let (mut left_out, mut binding) = (0, 0);
            for (all, kept) in everything.planes.iter().zip(&kept.planes) {
                assert!(kept.iter().all(|plane| all.contains(plane)));
                for plane in all.iter().filter(|plane| !kept.contains(plane)) {
                    let coefficients = plane.current.iter().chain(&plane.next).map(|c| c.abs()).sum::<f64>();
                    let most = coefficients * half_width_m / POSITION_M;
                    assert!(most <= plane.bound + 1e-12, "a row with {} of room can move by {most}", plane.bound);
                    left_out += 1;
                }
                binding += kept.len();
            }
            assert!(left_out > 0 && binding > 0, "{left_out} rows left out, {binding} kept");
        }
    }
}
