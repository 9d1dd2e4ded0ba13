//! The family's row in the table of families.

use super::{Model, Plant};
use crate::families::{FamilySpec, surplus};
use crate::{AppliedLimits, Family, Issue, Scenario, Vehicle, VehicleModel, Waypoint, World};

pub(crate) const FAMILY: FamilySpec = FamilySpec {
    key: "multirotor",
    name: "multirotor",
    hovers: true,
    carries_load: false,
    senses_obstacles: true,
    verdict_limits: AppliedLimits {
        tracking_max_m: 0.5,
        tracking_rms_m: 0.2,
        arrival_spread_s: 0.5,
        goal_m: 0.5,
        goal_heading_deg: 5.0,
        goal_flight_path_deg: 3.0,
        goal_speed_mps: 2.0,
        rest_mps: 0.2,
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
        Family::Multirotor
    }

    fn body_radius_m(&self) -> f64 {
        self.body_radius_m
    }

    fn missing_drag(&self) -> Option<&'static str> {
        (self.drag_area_m2 == 0.0).then_some("drag_area_m2")
    }

    fn has_attitude(&self) -> bool {
        self.plant == Plant::Quadrotor
    }

    fn issues(&self, field: &str) -> Vec<Issue> {
        super::validate::model(field, self)
    }

    fn waypoint_issues(&self, world: &World, field: &str, waypoint: &Waypoint) -> Vec<Issue> {
        super::validate::waypoint(self, world, field, waypoint)
    }
}

impl Scenario {
    /// The model of a multirotor.
    ///
    /// # Panics
    ///
    /// Panics if the vehicle has no such model, which validation excludes.
    pub fn multirotor_model(&self, vehicle: &Vehicle) -> &Model {
        &self.models.multirotor[&vehicle.model]
    }
}

fn unsupported(scenario: &Scenario) -> Vec<Issue> {
    let gates = "none: gates are for quadrotors with slung loads";
    let gates = surplus("world.gates", scenario.world.gates.len(), 0, gates, "");
    let ground = scenario.world.ground_m.map(|ground_m| {
        let expected = "nothing: multirotors stay above the map's lowest altitude";
        Issue::new("world.ground_m", ground_m.to_string(), expected).remedy("remove it and raise world.map.z_m")
    });
    let rules = ground.into_iter().chain(gates);
    rules.chain(super::validate::sensing(scenario)).collect()
}
