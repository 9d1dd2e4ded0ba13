//! Do airframes touch each other or an obstacle?

use scenarios::{Family, Scenario};
use sim::multirotor::Obstacles;

use crate::verdict::closest::{self, ClosestApproach};
use crate::verdict::evidence::Measurement;
use crate::verdict::motion::Motion;

/// Overlaps below this are none, m: the simulator looks along straight lines between its steps, the judge along curves.
const GRAZE_M: f64 = 1e-3;

/// One crash, where airframes overlap each other or an obstacle most; `None` if nothing touches.
///
/// - `motions`: one per vehicle, of their centres
pub fn deepest(scenario: &Scenario, motions: &[Motion]) -> Option<Measurement> {
    let radii_m: Vec<f64> = scenario.vehicles.iter().map(|vehicle| scenario.model(vehicle).body_radius_m()).collect();
    let name = |vehicle: usize| scenario.vehicles[vehicle].name.as_str();
    let is_touch = |approach: &ClosestApproach| approach.upper_m < -GRAZE_M;
    let crash = |approach: &ClosestApproach| Measurement::value(1.0).at(approach.at_s).with(name(approach.who[0]));
    if let Some(touch) = closest::overlap(motions, &radii_m).filter(is_touch) {
        return Some(crash(&touch).with(name(touch.who[1])));
    }
    if scenario.family() == Family::Multirotor {
        return sampled(scenario, motions);
    }
    let cylinders = &scenario.world.cylinders;
    let entered = motions.iter().zip(&radii_m).enumerate().find_map(|(vehicle, (motion, radius_m))| {
        let nearest = closest::to_cylinders(std::slice::from_ref(motion), cylinders)?;
        let touch = ClosestApproach { upper_m: nearest.upper_m - radius_m, who: [vehicle, nearest.who[1]], ..nearest };
        is_touch(&touch).then_some(touch)
    })?;
    Some(crash(&entered).with(&cylinders[entered.who[1]].name))
}

/// The first sample of a multirotor inside an obstacle, one that moves included. What lies between two samples is a matter
/// for the clearance.
fn sampled(scenario: &Scenario, motions: &[Motion]) -> Option<Measurement> {
    let surroundings = Obstacles::new(&scenario.world);
    scenario.vehicles.iter().zip(motions).find_map(|(vehicle, motion)| {
        let radius_m = scenario.multirotor_model(vehicle).body_radius_m;
        motion.knots().iter().find_map(|knot| {
            let distance_m = |obstacle| surroundings.distance_m(obstacle, knot.t_s, knot.position_m) - radius_m;
            let entered = (0..surroundings.count()).find(|obstacle| distance_m(*obstacle) < -GRAZE_M)?;
            Some(Measurement::value(1.0).at(knot.t_s).with(&vehicle.name).with(surroundings.name(entered)))
        })
    })
}
