//! A scenario with one quadrotor and its load, and plans for it.

use std::collections::BTreeMap;

use scenarios::slung_load::{Cable, Control, Limits, Model, State, Trajectory};
use scenarios::{
    FleetRules, Interpolation, Map, Models, Plan, PlannerSettings, Range, Scenario, Simulation, Vehicle, VerdictLimits,
    Waypoint, World,
};

/// The vehicle of Kang, Huang, Wen (2020), with a physically plausible k.
pub fn model() -> Model {
    let limits = |thrust_n, attitude_deg: f64, cable_deg: f64, tension_n| Limits {
        thrust_n,
        attitude_deg: Range::new(-attitude_deg, attitude_deg),
        cable_deg: Range::new(-cable_deg, cable_deg),
        tension_n,
    };
    Model {
        mass_kg: 1.32,
        inertia_kgm2: [0.01768, 0.01764, 0.026432],
        arm_m: 0.225,
        torque_per_thrust_m: 0.016,
        propeller_radius_m: 0.127,
        load_mass_kg: 0.2,
        load_radius_m: 0.03,
        cable_length_m: 0.65,
        drag_area_m2: 0.0,
        load_drag_area_m2: 0.0,
        rotor_time_constant_s: None,
        limits: limits(Range::new(0.2, 7.0), 70.0, 89.0, 60.0),
        planning_limits: limits(Range::new(1.0, 5.0), 45.0, 60.0, 40.0),
    }
}

/// An empty map with ground at z = -0.03 m, so that a load lies with its centre at z = 0.
pub fn scenario() -> Scenario {
    let wide = Range::new(-50.0, 50.0);
    Scenario {
        name: "arena".into(),
        description: "Built in code.".into(),
        tags: vec![],
        world: World { ground_m: Some(-0.03), ..World::empty(Map { x_m: wide, y_m: wide, z_m: wide }) },
        models: Models { slung_load: BTreeMap::from([("quad".into(), model())]), ..Models::default() },
        vehicles: vec![Vehicle {
            name: "quad-1".into(),
            model: "quad".into(),
            start: Waypoint::at_rest([0.0; 3]),
            goal: Waypoint::at_rest([0.0; 3]),
            via: Vec::new(),
        }],
        fleet: FleetRules::default(),
        planner: PlannerSettings::default(),
        simulation: Simulation { step_s: 0.002, ..Simulation::default() },
        verdict: VerdictLimits::default(),
        requirements: Vec::new(),
    }
}

/// A trajectory with these nodes: time, state, thrust of each rotor, cable.
pub fn trajectory(nodes: &[(f64, State, [f64; 4], Cable)]) -> Trajectory {
    Trajectory {
        vehicle: "quad-1".into(),
        interpolation: Interpolation::FirstOrderHold,
        times_s: nodes.iter().map(|node| node.0).collect(),
        states: nodes.iter().map(|node| node.1).collect(),
        controls: nodes.iter().map(|node| Control { thrust_n: node.2 }).collect(),
        cable: nodes.iter().map(|node| node.3).collect(),
        planner_nodes: vec![],
    }
}

/// A plan of this trajectory.
pub fn plan(trajectory: Trajectory) -> Plan {
    Plan::new("arena", "by-hand", 0, vec![trajectory.into()])
}

/// Ignores the progress.
pub fn silent(_: f64) {}
