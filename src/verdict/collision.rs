//! Contacts of airframes with each other and with obstacles.

use scenarios::Scenario;

use crate::verdict::closest::{self, ClosestApproach};
use crate::verdict::evidence::Measurement;
use crate::verdict::motion::Motion;

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
    let radii_m: Vec<f64> = scenario.vehicles.iter().map(|vehicle| scenario.model(vehicle).body_radius_m()).collect();
    let contact = closest::overlap(motions, &radii_m).filter(is_contact);
    let names = |contact: ClosestApproach| contact.who.map(|vehicle| scenario.vehicles[vehicle].name.as_str());
    contact.map(|contact| crash(contact.at_s, names(contact))).or_else(|| obstacle(scenario, motions))
}

/// Whether two shapes overlap at their closest approach.
pub fn is_contact(approach: &ClosestApproach) -> bool {
    approach.upper_m < -GRAZE_M
}

/// One crash, at a time, s, between two vehicles or a vehicle and an obstacle.
pub fn crash(at_s: f64, between: [&str; 2]) -> Measurement {
    Measurement::value(1.0).at(at_s).with(between[0]).with(between[1])
}
