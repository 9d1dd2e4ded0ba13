//! Contacts of airframes with each other and with obstacles.

use scenarios::Scenario;

use crate::verdict::case::Case;
use crate::verdict::closest::{self, ClosestApproach};
use crate::verdict::evidence::Measurement;
use crate::verdict::flight_integrity::obstacle_crash;
use crate::verdict::motion::Motion;
use crate::verdict::{Check, Status};

/// Smaller overlaps are no contact, m: the simulator takes the path between its steps for a line, the judge for a curve.
pub const GRAZE_M: f64 = 1e-3;

/// One crash, at the deepest overlap of two airframes or, if none overlap, in an obstacle; `None` without a contact.
///
/// - `motions`: those of the vehicles' centres
/// - `obstacle`: the family's search for a contact with an obstacle
pub fn deepest(
    scenario: &Scenario,
    motions: &[Motion],
    obstacle: fn(&Scenario, &[Motion]) -> Option<Measurement>,
) -> Option<Measurement> {
    let contact = closest::overlap(motions, &body_radii_m(scenario)).filter(is_contact);
    let names = |contact: ClosestApproach| contact.who.map(|vehicle| scenario.vehicles[vehicle].name.as_str());
    contact.map(|contact| crash(contact.at_s, names(contact))).or_else(|| obstacle(scenario, motions))
}

/// A flight that crashes into an obstacle does not clear it, however close to the surface its log ends.
pub fn mark_crashed(case: &Case<'_>, checks: &mut [Check]) {
    let crash = case.flight().ok().and_then(|flight| obstacle_crash(flight, case.mission_end_s()));
    let clearance = checks.iter_mut().find(|check| check.name == "flight.clearance");
    let (Some((t_s, between)), Some(clearance)) = (crash, clearance) else { return };
    if matches!(clearance.status, Status::Pass | Status::Undecided) {
        let distance_m = clearance.value.map(|value_m| value_m.min(0.0));
        *clearance = Check {
            status: Status::Fail,
            value: distance_m,
            margin: distance_m,
            lower: None,
            upper: None,
            at_s: Some(t_s),
            between: between.map(str::to_owned).to_vec(),
            reason: Some("the flight ends at the obstacle: see flight.crash".to_owned()),
            ..clearance.clone()
        };
    }
}

/// Radius of the sphere that encloses each vehicle, m.
pub fn body_radii_m(scenario: &Scenario) -> Vec<f64> {
    scenario.vehicles.iter().map(|vehicle| scenario.model(vehicle).body_radius_m()).collect()
}

/// Whether two shapes overlap at their closest approach.
pub fn is_contact(approach: &ClosestApproach) -> bool {
    approach.upper_m < -GRAZE_M
}

/// One crash, at a time, s, between two vehicles or a vehicle and an obstacle.
pub fn crash(at_s: f64, between: [&str; 2]) -> Measurement {
    Measurement::value(1.0).at(at_s).with(between[0]).with(between[1])
}
