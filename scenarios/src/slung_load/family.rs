//! The family's row in the table of families.

use super::Model;
use crate::families::{FamilySpec, surplus};
use crate::{AppliedLimits, Family, Issue, Scenario, Vehicle, VehicleModel, Waypoint, World};

pub(crate) const FAMILY: FamilySpec = FamilySpec {
    key: "slung-load",
    name: "quadrotor with a slung load",
    hovers: true,
    carries_load: true,
    senses_obstacles: false,
    verdict_limits: AppliedLimits {
        tracking_max_m: 0.05,
        tracking_rms_m: 0.03,
        arrival_spread_s: 0.5,
        goal_m: 0.05,
        goal_heading_deg: 5.0,
        goal_flight_path_deg: 3.0,
        goal_speed_mps: 2.0,
        rest_mps: 0.1,
        dynamics_m: 0.01,
        rollout_m: 5.0,
        saturation: 0.05,
        switch_s: 0.02,
    },
    columns: &super::import::COLUMNS,
    flight_columns: None,
    import: super::import::trajectory,
    unsupported,
};

impl VehicleModel for Model {
    fn family(&self) -> Family {
        Family::SlungLoad
    }

    fn body_radius_m(&self) -> f64 {
        Model::body_radius_m(self)
    }

    fn missing_drag(&self) -> Option<&'static str> {
        (self.drag_area_m2 == 0.0 && self.load_drag_area_m2 == 0.0).then_some("drag_area_m2 or load_drag_area_m2")
    }

    fn has_attitude(&self) -> bool {
        true
    }

    fn issues(&self, field: &str) -> Vec<Issue> {
        super::validate::model(field, self)
    }

    fn waypoint_issues(&self, world: &World, field: &str, waypoint: &Waypoint) -> Vec<Issue> {
        super::validate::waypoint(self, world, field, waypoint)
    }
}

impl Scenario {
    /// The model of a quadrotor with a slung load.
    ///
    /// # Panics
    ///
    /// Panics if the vehicle has no such model, which validation excludes.
    pub fn slung_load_model(&self, vehicle: &Vehicle) -> &Model {
        &self.models.slung_load[&vehicle.model]
    }
}

fn unsupported(scenario: &Scenario) -> Vec<Issue> {
    let world = &scenario.world;
    let (shape, enclose) = ("none: slung loads fly among boxes and prisms", "enclose them in prisms");
    let sensing = "none: only multirotors sense obstacles";
    let (alone, split) = ("one: slung loads fly alone", "write one scenario for each");
    let rules = [
        surplus("world.cylinders", world.cylinders.len(), 0, shape, enclose),
        surplus("vehicles", scenario.vehicles.len(), 1, alone, split),
        surplus("world.hidden", world.hidden.len(), 0, sensing, ""),
        surplus("world.moving", world.moving.len(), 0, sensing, ""),
    ];
    rules.into_iter().flatten().collect()
}
