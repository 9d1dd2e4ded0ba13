//! Plans of `slung-lgr` against independent equations of motion in Cartesian coordinates: the planned thrusts must lead
//! from each sample to the next, and impacts must be inelastic.

use std::path::Path;

use nalgebra::{Matrix3, Rotation3, Vector3};
use scenarios::Scenario;
use scenarios::slung_load::{Cable, Model, State, Trajectory};

const GRAVITY: Vector3<f64> = Vector3::new(0.0, 0.0, -9.81);
const SUBSTEPS: usize = 4;

/// Quadrotor as a rigid body, load as a point.
#[derive(Clone, Copy)]
struct FlightState {
    position: Vector3<f64>,
    velocity: Vector3<f64>,
    world_from_body: Matrix3<f64>,
    body_rate: Vector3<f64>,
    load: Vector3<f64>,
    load_velocity: Vector3<f64>,
}

impl FlightState {
    fn from_plan(state: &State) -> Self {
        let [roll, pitch, yaw] = state.roll_pitch_yaw_rad;
        Self {
            position: state.position_m.into(),
            velocity: state.velocity_mps.into(),
            world_from_body: *Rotation3::from_euler_angles(roll, pitch, yaw).matrix(),
            body_rate: state.body_rate_radps.into(),
            load: state.load_position_m.into(),
            load_velocity: state.load_velocity_mps.into(),
        }
    }

    fn plus(&self, rate: &Self, step: f64) -> Self {
        Self {
            position: self.position + step * rate.position,
            velocity: self.velocity + step * rate.velocity,
            world_from_body: self.world_from_body + step * rate.world_from_body,
            body_rate: self.body_rate + step * rate.body_rate,
            load: self.load + step * rate.load,
            load_velocity: self.load_velocity + step * rate.load_velocity,
        }
    }

    fn rate(&self, model: &Model, thrusts: [f64; 4], cable: Cable, is_on_ground: bool) -> Self {
        let [f1, f2, f3, f4] = thrusts;
        let (arm, k) = (model.arm_m, model.torque_per_thrust_m);
        let torque = Vector3::new(arm * (-f1 + f2 + f3 - f4), arm * (-f1 - f2 + f3 + f4), k * (f1 - f2 + f3 - f4));
        let inertia = Vector3::from(model.inertia_kgm2);
        let momentum = inertia.component_mul(&self.body_rate);
        let thrust = self.world_from_body * Vector3::new(0.0, 0.0, f1 + f2 + f3 + f4) / model.mass_kg;
        let along = (self.load - self.position).normalize();
        let relative = self.load_velocity - self.velocity;
        let length = (self.load - self.position).norm();
        // the length is constant: (p_L - p_Q)''.d = -|transverse relative velocity|^2/length
        let centripetal = (relative.norm_squared() - relative.dot(&along).powi(2)) / length;
        let inverse_masses = 1.0 / model.mass_kg + 1.0 / model.load_mass_kg;
        let tension = if cable == Cable::Taut { (centripetal - thrust.dot(&along)) / inverse_masses } else { 0.0 };
        let load_motion = if is_on_ground { 0.0 } else { 1.0 };
        Self {
            position: self.velocity,
            velocity: thrust + GRAVITY + tension / model.mass_kg * along,
            world_from_body: self.world_from_body * self.body_rate.cross_matrix(),
            body_rate: (torque - self.body_rate.cross(&momentum)).component_div(&inertia),
            load: load_motion * self.load_velocity,
            load_velocity: load_motion * (GRAVITY - tension / model.load_mass_kg * along),
        }
    }
}

/// Integrates from a sample to the time of the next one, by the classical Runge-Kutta method with thrusts linear in
/// time.
fn propagate(model: &Model, trajectory: &Trajectory, k: usize, is_on_ground: bool) -> FlightState {
    let duration = trajectory.times_s[k + 1] - trajectory.times_s[k];
    let thrusts = |fraction: f64| {
        let (from, to) = (trajectory.controls[k].thrust_n, trajectory.controls[k + 1].thrust_n);
        std::array::from_fn(|i| from[i] + fraction * (to[i] - from[i]))
    };
    let step = duration / SUBSTEPS as f64;
    let mut at = FlightState::from_plan(&trajectory.states[k]);
    for i in 0..SUBSTEPS {
        let thrusts_at = |half: f64| thrusts((i as f64 + 0.5 * half) / SUBSTEPS as f64);
        let rate = |at: &FlightState, half: f64| at.rate(model, thrusts_at(half), trajectory.cable[k], is_on_ground);
        let k1 = rate(&at, 0.0);
        let k2 = rate(&at.plus(&k1, 0.5 * step), 1.0);
        let k3 = rate(&at.plus(&k2, 0.5 * step), 1.0);
        let k4 = rate(&at.plus(&k3, step), 2.0);
        at = at.plus(&k1, step / 6.0).plus(&k2, step / 3.0).plus(&k3, step / 3.0).plus(&k4, step / 6.0);
    }
    at
}

fn planned(name: &str) -> (Scenario, Trajectory) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenarios/slung/{name}.toml"));
    let scenario = scenarios::load(&path).expect("a shipped scenario");
    let planner = planners::find("slung-lgr").expect("registered");
    assert_eq!((planner.unsupported_reason)(&scenario), None);
    let plan = planner.plan(&scenario, 1, &mut |_| {});
    assert_eq!(plan.status, scenarios::PlanStatus::Solved, "{:?}", plan.reason);
    let trajectory = plan.trajectories[0].slung_load().clone();
    (scenario, trajectory)
}

/// Maximum differences over all intervals: position, m, velocity, m/s, and body rate, rad/s.
fn defects(scenario: &Scenario, trajectory: &Trajectory) -> [f64; 3] {
    let model = scenario.slung_load_model(&scenario.vehicles[0]);
    let starts_on_ground = scenario
        .world
        .ground_m
        .is_some_and(|ground_m| trajectory.states[0].load_position_m[2] <= ground_m + model.load_radius_m + 1e-6);
    let mut max = [0.0_f64; 3];
    for k in 0..trajectory.times_s.len() - 1 {
        if trajectory.times_s[k + 1] <= trajectory.times_s[k] {
            continue;
        }
        let is_on_ground = starts_on_ground && trajectory.cable[k] == Cable::Slack;
        let (end, next) =
            (propagate(model, trajectory, k, is_on_ground), FlightState::from_plan(&trajectory.states[k + 1]));
        let differences = [
            (end.position - next.position).norm().max((end.load - next.load).norm()),
            (end.velocity - next.velocity).norm().max((end.load_velocity - next.load_velocity).norm()),
            (end.body_rate - next.body_rate).norm(),
        ];
        for (max, difference) in max.iter_mut().zip(differences) {
            assert!(difference.is_finite());
            *max = max.max(difference);
        }
    }
    max
}

#[test]
fn thrusts_lead_from_sample_to_sample() {
    for name in ["rectangle", "lift-off", "drop-and-catch", "gate", "polygons"] {
        let (scenario, trajectory) = planned(name);
        let [position, velocity, rate] = defects(&scenario, &trajectory);
        println!(
            "{name}: {position:.1e} m, {velocity:.1e} m/s, {rate:.1e} rad/s over {} samples",
            trajectory.times_s.len()
        );
        assert!(position < 1e-5 && velocity < 1e-3 && rate < 1e-2, "{name}: {position} {velocity} {rate}");
    }
}

/// The cable has its full length while it is taut, and never exceeds it.
#[test]
fn the_cable_never_exceeds_its_length() {
    for name in ["rectangle", "lift-off", "drop-and-catch", "gate"] {
        let (scenario, trajectory) = planned(name);
        let full_m = scenario.slung_load_model(&scenario.vehicles[0]).cable_length_m;
        for (state, cable) in trajectory.states.iter().zip(&trajectory.cable) {
            let length_m = state.cable_length_m();
            assert!(length_m < full_m + 1e-5, "{name}: {length_m}");
            assert!(*cable == Cable::Slack || (length_m - full_m).abs() < 1e-9, "{name}: {length_m}");
        }
    }
}

/// An impact conserves the total momentum and stops the stretching of the cable; its impulse acts along the cable.
#[test]
fn impacts_are_inelastic() {
    for name in ["lift-off", "drop-and-catch"] {
        let (scenario, trajectory) = planned(name);
        let model = scenario.slung_load_model(&scenario.vehicles[0]);
        let jump = (1..trajectory.times_s.len()).find(|&k| trajectory.times_s[k] == trajectory.times_s[k - 1]);
        let k = jump.expect("one impact");
        let (before, after) =
            (FlightState::from_plan(&trajectory.states[k - 1]), FlightState::from_plan(&trajectory.states[k]));
        assert_eq!((trajectory.cable[k - 1], trajectory.cable[k]), (Cable::Slack, Cable::Taut));
        let momentum = |at: &FlightState| model.mass_kg * at.velocity + model.load_mass_kg * at.load_velocity;
        assert!((momentum(&after) - momentum(&before)).norm() < 1e-6, "{name}");
        let stretching = |at: &FlightState| (at.load_velocity - at.velocity).dot(&(at.load - at.position).normalize());
        assert!(stretching(&before) > 0.1 && stretching(&after).abs() < 1e-6, "{name}");
        let jump_across = (after.load_velocity - before.load_velocity).cross(&(after.load - after.position)).norm();
        assert!(jump_across < 1e-6, "{name}: the impulse acts along the cable");
    }
}

/// Plans on one thread and on two are equal to the bit.
#[test]
fn plans_do_not_depend_on_the_number_of_threads() {
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| planned("rectangle").1)
    };
    assert_eq!(with(1), with(2));
}

/// The complementarity formulation has no phase boundaries for gates, and does not model the ground.
#[test]
fn complementarity_is_refused_with_gates_and_on_the_ground() {
    let planner = planners::find("slung-lgr").expect("registered");
    let refusal = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenarios/slung/{name}.toml"));
        let mut scenario = scenarios::load(&path).expect("a shipped scenario");
        let mut settings = scenario.planner.collocation.take().unwrap_or_default();
        (settings.formulation, settings.cable) = (Some(scenarios::Formulation::Complementarity), None);
        scenario.planner.collocation = Some(settings);
        (planner.unsupported_reason)(&scenario)
    };
    assert!(refusal("gate").is_some_and(|reason| reason.contains("gate")));
    assert!(refusal("lift-off").is_some_and(|reason| reason.contains("ground")));
    assert_eq!((refusal("rectangle"), refusal("drop-and-catch")), (None, None));
}
