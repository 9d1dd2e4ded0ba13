//! The family's row in the table of families.

use super::Model;
use crate::families::{FamilySpec, surplus};
use crate::{AppliedLimits, Family, Issue, Scenario, Vehicle, VehicleModel, Waypoint, World};

pub(crate) const FAMILY: FamilySpec = FamilySpec {
    key: "fixed-wing",
    name: "fixed wing",
    hovers: false,
    carries_load: false,
    senses_obstacles: false,
    verdict_limits: AppliedLimits {
        tracking_max_m: 5.0,
        tracking_rms_m: 2.0,
        arrival_spread_s: 0.5,
        goal_m: 5.0,
        goal_heading_deg: 5.0,
        goal_flight_path_deg: 3.0,
        goal_speed_mps: 2.0,
        rest_mps: 0.1,
        dynamics_m: 1.0,
        rollout_m: 5.0,
        saturation: 0.05,
        switch_s: 0.02,
    },
    columns: &super::import::COLUMNS,
    flight_columns: Some(&super::import::FLIGHT_COLUMNS),
    import: super::import::trajectory,
    unsupported,
};

impl VehicleModel for Model {
    fn family(&self) -> Family {
        Family::FixedWing
    }

    fn body_radius_m(&self) -> f64 {
        self.body_radius_m
    }

    fn missing_drag(&self) -> Option<&'static str> {
        None
    }

    fn has_attitude(&self) -> bool {
        false
    }

    fn issues(&self, field: &str) -> Vec<Issue> {
        super::validate::model(field, self)
    }

    fn waypoint_issues(&self, world: &World, field: &str, waypoint: &Waypoint) -> Vec<Issue> {
        super::validate::waypoint(self, world, field, waypoint)
    }
}

impl Scenario {
    /// The fixed-wing model of a vehicle.
    ///
    /// # Panics
    ///
    /// Panics if the vehicle has no such model, which validation excludes.
    pub fn fixed_wing_model(&self, vehicle: &Vehicle) -> &Model {
        &self.models.fixed_wing[&vehicle.model]
    }
}

fn unsupported(scenario: &Scenario) -> Vec<Issue> {
    let world = &scenario.world;
    let sensing = "none: only multirotors sense obstacles";
    let gates = "none: gates are for quadrotors with slung loads";
    let rules = [
        surplus("world.hidden", world.hidden.len(), 0, sensing, ""),
        surplus("world.moving", world.moving.len(), 0, sensing, ""),
        surplus("world.gates", world.gates.len(), 0, gates, ""),
    ];
    rules.into_iter().flatten().chain(super::validate::above_ground(scenario)).collect()
}
