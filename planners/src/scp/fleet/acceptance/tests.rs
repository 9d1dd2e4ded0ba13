//! Every kind of violation is found, and a plan without one is accepted.

use super::super::super::dynamics::Control;
use super::*;

/// The smallest shipped fleet, with all vehicles on straight flights east that obey the equations of motion.
fn fleet() -> (Scenario, Vec<Iterate>) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/fixed-wing/rendezvous-2.toml");
    let mut scenario = scenarios::load(&path).expect("a shipped scenario");
    scenario.world.cylinders.truncate(1);
    scenario.world.cylinders[0].center_m = [1000.0, 2000.0];
    let straight = |y_m: f64| {
        let at = |k: usize| State::new(35.0 * 5.0 * k as f64, y_m, 400.0, 35.0, 0.0, 0.0);
        Iterate {
            states: (0..=10).map(at).collect(),
            controls: vec![Control::new(0.0, 0.0, 1.0); 11],
            dt_s: 5.0,
            ramp: 0.25,
        }
    };
    (scenario, vec![straight(0.0), straight(150.0)])
}

fn violation(scenario: &Scenario, trajectories: &[Iterate]) -> Option<ConstraintViolation> {
    let (_, expected) = fleet();
    let boundary: Vec<[State; 2]> =
        expected.iter().map(|trajectory| [trajectory.states[0], trajectory.states[10]]).collect();
    let bounds = |vehicle| {
        let limits = &scenario.fixed_wing_model(vehicle).planning_limits;
        super::super::super::subproblem::node_bounds(limits, &scenario.world.map)
    };
    let bounds: Vec<_> = scenario.vehicles.iter().map(bounds).collect();
    first_violation(scenario, &AvoidanceConstraints::new(scenario, 0.5), trajectories, &bounds, &boundary)
}

#[test]
fn a_plan_that_keeps_every_constraint_is_accepted() {
    let (scenario, trajectories) = fleet();
    assert_eq!(violation(&scenario, &trajectories), None);
}

#[test]
fn every_kind_of_violation_is_found() {
    type Mutation = fn(&mut Scenario, &mut Vec<Iterate>);
    let cases: [(&str, Mutation); 13] = [
        ("separation", |scenario, _| scenario.fleet.separation_m = Some(151.0)),
        ("clearance", |scenario, _| scenario.world.cylinders[0].center_m = [875.0, 551.0]),
        ("simultaneous arrival", |_, trajectories| trajectories[1].dt_s += 1e-3),
        ("start or goal", |_, trajectories| trajectories[0].states.iter_mut().for_each(|state| state[1] -= 0.1)),
        ("start or goal", |_, trajectories| trajectories[0].states[0][3] = 35.002),
        ("start or goal", |_, trajectories| trajectories[1].states[10][4] += 1e-3),
        ("simulation.max_duration_s", |scenario, _| scenario.simulation.max_duration_s = 49.0),
        ("dynamics", |_, trajectories| trajectories[0].states[4][0] += 0.2),
        ("dynamics", |_, trajectories| trajectories[0].states[4][4] += 0.002),
        ("dynamics", |_, trajectories| trajectories[0].states[4][2] = f64::NAN),
        ("rollout", |_, trajectories| trajectories[0].controls.iter_mut().for_each(|control| control[0] = 4e-4)),
        ("speed", |scenario, _| {
            let model = scenario.models.fixed_wing.values_mut().next().expect("a model");
            model.planning_limits.speed_mps.max = 34.9;
        }),
        ("n_z", |scenario, _| {
            let model = scenario.models.fixed_wing.values_mut().next().expect("a model");
            model.planning_limits.n_z.max = 0.99;
        }),
    ];
    for (constraint, mutate) in cases {
        let (mut scenario, mut trajectories) = fleet();
        mutate(&mut scenario, &mut trajectories);
        let found = violation(&scenario, &trajectories).unwrap_or_else(|| panic!("{constraint} was not found"));
        assert_eq!(found.constraint, constraint, "{found}");
        assert!(!found.parties.is_empty() && found.amount != 0.0, "{found:?}");
    }
}

#[test]
fn separation_is_checked_between_the_nodes() {
    let (mut scenario, mut trajectories) = fleet();
    scenario.fleet.separation_m = Some(50.0);
    // the second vehicle flies the opposite way: they pass each other between two nodes
    let states: Vec<State> = trajectories[0].states.iter().rev().copied().collect();
    trajectories[1].states =
        states.iter().map(|s| State::new(s[0] - 87.5, 20.0, 400.0, 35.0, std::f64::consts::PI, 0.0)).collect();
    let at_nodes = (0..=10).map(|k| (trajectories[0].states[k] - trajectories[1].states[k]).norm());
    assert!(at_nodes.fold(f64::INFINITY, f64::min) > 80.0);
    let found = violation(&scenario, &trajectories).expect("they pass at 20 m");
    assert_eq!(found.constraint, "separation");
    assert!((found.amount - 30.0).abs() < 1e-6, "{found}");
}
