//! Points that a vehicle passes on its way.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::requirement::{AppliesTo, Requirement};
use crate::{Range, Scenario, Vehicle};

/// A ball that the centre of a vehicle passes through on its way to the goal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ViaPoint {
    /// East, m.
    pub x_m: f64,
    /// North, m.
    pub y_m: f64,
    /// Up, m.
    pub z_m: f64,
    /// Radius of the ball, m.
    pub radius_m: f64,
    /// The earliest and the latest time at which it is passed, s. Absent: at any time.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub window_s: Option<Range>,
}

impl ViaPoint {
    /// Its centre in the world frame, m.
    pub fn position_m(&self) -> [f64; 3] {
        [self.x_m, self.y_m, self.z_m]
    }
}

impl Vehicle {
    /// The requirement that it passes its via-points in their order; none without via-points.
    pub fn via_requirement(&self) -> Option<Requirement> {
        let passed = |later: Option<String>, via: &ViaPoint| {
            let ViaPoint { x_m, y_m, z_m, radius_m, window_s } = via;
            let mut parts = vec![format!("distance({}, point({x_m} m, {y_m} m, {z_m} m)) < {radius_m} m", self.name)];
            parts.extend(window_s.map(|Range { min, max }| format!("time > {min} s and time < {max} s")));
            parts.extend(later);
            Some(format!("eventually ({})", parts.join(" and ")))
        };
        let formula = self.via.iter().rev().fold(None, passed)?;
        Some(Requirement {
            name: format!("via-{}", self.name),
            formula,
            description: "The via-points are passed in their order.".to_owned(),
            advisory: false,
            applies_to: AppliesTo::Both,
        })
    }
}

impl Scenario {
    /// The requirements of the file, then one for each vehicle with via-points, `via-VEHICLE`.
    pub fn all_requirements(&self) -> Vec<Requirement> {
        let of_vehicles = self.vehicles.iter().filter_map(Vehicle::via_requirement);
        self.requirements.iter().cloned().chain(of_vehicles).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::ViaPoint;
    use crate::{Range, Vehicle, Waypoint};

    #[test]
    fn via_points_are_passed_in_their_order() {
        let via = |x_m: f64, window_s| ViaPoint { x_m, y_m: -2.0, z_m: 1.5, radius_m: 0.5, window_s };
        let at = Waypoint::at_rest([0.0; 3]);
        let mut vehicle = Vehicle {
            name: "uav-1".into(),
            model: "quad".into(),
            start: at,
            goal: at,
            via: vec![via(1.0, None), via(1e-7, Some(Range::new(5.0, 1e3)))],
        };
        let requirement = vehicle.via_requirement().expect("via-points");
        assert_eq!(requirement.name, "via-uav-1");
        assert_eq!(
            requirement.formula,
            "eventually (distance(uav-1, point(1 m, -2 m, 1.5 m)) < 0.5 m and eventually (distance(uav-1, \
             point(0.0000001 m, -2 m, 1.5 m)) < 0.5 m and time > 5 s and time < 1000 s))"
        );
        vehicle.via.clear();
        assert_eq!(vehicle.via_requirement(), None);
    }
}
