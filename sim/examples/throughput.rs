//! How fast does a fleet fly? Prints simulated seconds per second of wall time.
//!
//!     cargo run --release -p sim --example throughput [VEHICLES] [still]

use std::collections::BTreeMap;

use scenarios::fixed_wing::{Control, Limits, Model, State};
use scenarios::{
    Cylinder, FleetRules, Gusts, Interpolation, Map, Models, Plan, PlanStatus, PlanTimings, PlannerSettings, Range,
    Scenario, Sensors, Simulation, Trajectory, Vehicle, VerdictLimits, Waypoint, Wind, World,
};

const DURATION_S: f64 = 230.0;
const RUNS: usize = 5;

fn main() {
    let mut arguments = std::env::args().skip(1);
    let vehicles = arguments.next().map_or(7, |count| count.parse().expect("the number of vehicles"));
    let is_still = arguments.next().is_some();
    let (scenario, plan) = (scenario(vehicles, is_still), plan(vehicles));
    let walls_s = (0..RUNS).map(|_| {
        let flight = sim::fly(&scenario, &plan, 1, &mut |_| {});
        assert!(flight.events.is_empty(), "{:?}", flight.events);
        flight.wall_s
    });
    let best_s = walls_s.fold(f64::INFINITY, f64::min);
    let flown_s = DURATION_S + scenario.simulation.coast_s;
    let steps = flown_s / scenario.simulation.step_s;
    println!(
        "{vehicles} aircraft: {:.0} simulated s per wall s, best of {RUNS} ({:.2} us per step)",
        flown_s / best_s,
        best_s / steps * 1e6
    );
}

/// Aircraft abreast, 200 m apart, seven pillars to their side; wind, gusts and noise unless the air is still.
fn scenario(vehicles: usize, is_still: bool) -> Scenario {
    let wide = Range::new(-20_000.0, 20_000.0);
    let pillar =
        |i: usize| Cylinder { name: format!("pillar-{i}"), center_m: [1000.0 * i as f64, -1000.0], radius_m: 400.0 };
    let gusts = Gusts { wind_at_20ft_mps: 7.7, sigma_aloft_mps: 0.5 };
    let disturbed = Simulation {
        wind: Some(Wind { mean_mps: [2.0, 1.0, 0.0], gusts: Some(gusts) }),
        sensors: Sensors { position_noise_m: 0.5, velocity_noise_mps: 0.05 },
        ..Simulation::default()
    };
    Scenario {
        name: "throughput".into(),
        description: "Aircraft abreast.".into(),
        tags: vec![],
        world: World {
            map: Map { x_m: wide, y_m: wide, z_m: Range::new(0.0, 1000.0) },
            cylinders: (0..7).map(pillar).collect(),
        },
        models: Models { fixed_wing: BTreeMap::from([("plane".into(), model())]) },
        vehicles: (0..vehicles).map(vehicle).collect(),
        fleet: FleetRules::default(),
        planner: PlannerSettings::default(),
        simulation: if is_still { Simulation::default() } else { disturbed },
        verdict: VerdictLimits::default(),
    }
}

fn model() -> Model {
    let limits = Limits {
        altitude_m: Range::new(100.0, 900.0),
        speed_mps: Range::new(20.0, 50.0),
        flight_path_deg: Range::new(-20.0, 20.0),
        n_x: Range::new(-0.5, 0.5),
        n_y: Range::new(-1.0, 1.0),
        n_z: Range::new(0.0, 2.0),
    };
    Model { mass_kg: 13.0, body_radius_m: 1.5, limits: limits.clone(), planning_limits: limits }
}

fn vehicle(index: usize) -> Vehicle {
    let start = Waypoint {
        x_m: 0.0,
        y_m: 200.0 * index as f64,
        z_m: 400.0,
        speed_mps: 35.0,
        heading_deg: 0.0,
        flight_path_deg: 0.0,
    };
    let goal = Waypoint { x_m: 35.0 * DURATION_S, ..start };
    Vehicle { name: format!("uav-{index}"), model: "plane".into(), start, goal }
}

fn plan(vehicles: usize) -> Plan {
    Plan {
        schema: 1,
        scenario: "throughput".into(),
        planner: "by-hand".into(),
        seed: 0,
        status: PlanStatus::Solved,
        reason: None,
        objective: None,
        trajectories: (0..vehicles).map(straight).collect(),
        history: vec![],
        timings: PlanTimings::default(),
    }
}

fn straight(index: usize) -> Trajectory {
    let times_s: Vec<f64> = (0..=46).map(|node| DURATION_S * f64::from(node) / 46.0).collect();
    let at = |t_s: &f64| State {
        x_m: 35.0 * t_s,
        y_m: 200.0 * index as f64,
        z_m: 400.0,
        speed_mps: 35.0,
        heading_rad: 0.0,
        flight_path_rad: 0.0,
    };
    Trajectory {
        vehicle: format!("uav-{index}"),
        interpolation: Interpolation::FirstOrderHold,
        states: times_s.iter().map(at).collect(),
        controls: vec![Control::CRUISE; times_s.len()],
        times_s,
    }
}
