//! A quadrotor over an empty map.

use scenarios::Plan;
use scenarios::Scenario;
use scenarios::in_loop::Node;
use scenarios::multirotor::Trajectory;

const TEXT: &str = r#"name = "arena"
description = "Nothing in the way."

[world]
map = { x_m = [-50, 50], y_m = [-50, 50], z_m = [0, 20] }

[models.multirotor.quad]
plant = "PLANT"
mass_kg = 1.5
body_radius_m = 0.35
sensor_range_m = 8
drag_area_m2 = 0.05
limits = { speed_mps = 9, acceleration_mps2 = 6 }
planning_limits = { speed_mps = 3, acceleration_mps2 = 3 }

[models.multirotor.quad.airframe]
inertia_kgm2 = [0.0177, 0.0150, 0.0264]
arm_m = 0.16
torque_per_thrust_m = 0.016
rotor_time_constant_s = 0.03
thrust_n = [0.2, 8]
tilt_deg = 45

[[vehicles]]
name = "uav-1"
model = "quad"
start = { x_m = 0, y_m = 0, z_m = 5 }
goal = { x_m = 6, y_m = 2, z_m = 6 }

[planner]
name = "by-hand"

[simulation]
coast_s = 1
max_duration_s = 10
tracker = { natural_frequency_radps = 2.5 }
wind = { mean_mps = [2, -1, 0.5] }
"#;

/// `plant`: `point-mass` or `quadrotor`.
pub fn scenario(plant: &str) -> Scenario {
    scenarios::parse("arena.toml", &TEXT.replace("PLANT", plant)).expect("a good scenario")
}

/// A plan through nodes.
pub fn plan(scenario: &Scenario, nodes: &[Node]) -> Plan {
    Plan::new(&scenario.name, "by-hand", 0, vec![Trajectory::through("uav-1", nodes).into()])
}

/// From the start to the goal in 5 s, with a turn on the way.
pub fn nodes() -> Vec<Node> {
    let node = |(t_s, position_m, velocity_mps)| Node { t_s, position_m, velocity_mps };
    let turn = (2.5, [4.0, 0.0, 5.5], [1.5, 1.5, 0.3]);
    [(0.0, [0.0, 0.0, 5.0], [0.0; 3]), turn, (5.0, [6.0, 2.0, 6.0], [0.0; 3])].map(node).into()
}
