//! What acted in a flight, put once more through the equations of motion, by a Runge-Kutta method of order 4 with small
//! steps that is written here, from Newton's and Euler's laws.

use nalgebra::{Quaternion, SVector, UnitQuaternion, Vector3, Vector4};
use scenarios::multirotor::GRAVITY_MPS2;
use sim::{Actuation, ControlMode, Flight, FlightOptions, Sample, fly, fly_with};

use crate::arena::{nodes, plan, scenario};

/// Steps of the integrator for each of the simulator's.
const SUBSTEPS: usize = 20;
const STEP_S: f64 = 0.01;
const MASS_KG: f64 = 1.5;
const DRAG_AREA_M2: f64 = 0.05;
const WIND_MPS: [f64; 3] = [2.0, -1.0, 0.5];

fn drag_mps2(velocity_mps: Vector3<f64>) -> Vector3<f64> {
    let relative = Vector3::from(WIND_MPS) - velocity_mps;
    relative * (relative.norm() * 0.5 * 1.225 * DRAG_AREA_M2 / MASS_KG)
}

fn rk4<const N: usize>(
    state: SVector<f64, N>,
    h: f64,
    rate: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
) -> SVector<f64, N> {
    let k1 = rate(&state);
    let k2 = rate(&(state + k1 * (h / 2.0)));
    let k3 = rate(&(state + k2 * (h / 2.0)));
    let k4 = rate(&(state + k3 * h));
    state + (k1 + k2 * 2.0 + k3 * 2.0 + k4) * (h / 6.0)
}

fn flown(plant: &str) -> Flight {
    let scenario = scenario(plant);
    fly(&scenario, &plan(&scenario, &nodes()), 0, &mut |_| {})
}

#[test]
fn the_start_is_drawn_where_the_scenario_asks_for_it() {
    let mut scenario = scenario("quadrotor");
    scenario.simulation.mismatch.start_radius_m = 0.3;
    let flight = fly(&scenario, &plan(&scenario, &nodes()), 7, &mut |_| {});
    let offset_m = Vector3::from(flight.vehicles[0].samples[0].position_m) - Vector3::from(nodes()[0].position_m);
    assert!(0.0 < offset_m.norm() && offset_m.norm() <= 0.3 && offset_m.z == 0.0, "{offset_m}");
}

fn error_m(sample: &Sample, position_m: Vector3<f64>) -> f64 {
    (Vector3::from(sample.position_m) - position_m).norm()
}

#[test]
fn a_point_mass_moves_as_its_accelerations_and_the_air_make_it() {
    let flight = flown("point-mass");
    let samples = &flight.vehicles[0].samples;
    let mut state = SVector::<f64, 6>::zeros();
    state.fixed_rows_mut::<3>(0).copy_from(&Vector3::from(samples[0].position_m));
    let mut worst_m: f64 = 0.0;
    for sample in samples {
        worst_m = worst_m.max(error_m(sample, state.fixed_rows::<3>(0).into()));
        let Actuation::Acceleration(acceleration) = sample.actuation else { panic!("a point mass") };
        for _ in 0..SUBSTEPS {
            state = rk4(state, STEP_S / SUBSTEPS as f64, |state| {
                let velocity: Vector3<f64> = state.fixed_rows::<3>(3).into();
                let mut rate = SVector::<f64, 6>::zeros();
                rate.fixed_rows_mut::<3>(0).copy_from(&velocity);
                rate.fixed_rows_mut::<3>(3).copy_from(&(Vector3::from(acceleration.control) + drag_mps2(velocity)));
                rate
            });
        }
    }
    assert!(samples.len() == 601 && worst_m < 2e-3, "{worst_m} m");
}

#[test]
fn a_quadrotor_moves_as_its_rotors_and_the_air_make_it() {
    let flight = flown("quadrotor");
    let samples = &flight.vehicles[0].samples;
    let inertia = Vector3::new(0.0177, 0.0150, 0.0264);
    // Position, velocity, quaternion (x, y, z, w), body rates, thrusts.
    let mut state = SVector::<f64, 17>::zeros();
    state.fixed_rows_mut::<3>(0).copy_from(&Vector3::from(samples[0].position_m));
    state[9] = 1.0;
    state.fixed_rows_mut::<4>(13).copy_from(&Vector4::repeat(MASS_KG * GRAVITY_MPS2 / 4.0));
    let (mut worst_m, mut worst_rad): (f64, f64) = (0.0, 0.0);
    for sample in samples {
        let attitude = |q: Vector4<f64>| UnitQuaternion::from_quaternion(Quaternion::from(q));
        let flown = attitude(Vector4::from(sample.world_from_body));
        worst_m = worst_m.max(error_m(sample, state.fixed_rows::<3>(0).into()));
        worst_rad = worst_rad.max(flown.angle_to(&attitude(state.fixed_rows::<4>(6).into())));
        let Actuation::Thrusts(thrusts) = sample.actuation else { panic!("a quadrotor") };
        for _ in 0..SUBSTEPS {
            state = rk4(state, STEP_S / SUBSTEPS as f64, |state| {
                let velocity: Vector3<f64> = state.fixed_rows::<3>(3).into();
                let q = Quaternion::from(state.fixed_rows::<4>(6).into_owned());
                let rates: Vector3<f64> = state.fixed_rows::<3>(10).into();
                let f: Vector4<f64> = state.fixed_rows::<4>(13).into();
                let up = UnitQuaternion::from_quaternion(q) * Vector3::z();
                let torque = Vector3::new(
                    0.16 * (-f[0] + f[1] + f[2] - f[3]),
                    0.16 * (-f[0] - f[1] + f[2] + f[3]),
                    0.016 * (f[0] - f[1] + f[2] - f[3]),
                );
                let update_rotors = (torque - rates.cross(&inertia.component_mul(&rates))).component_div(&inertia);
                let acceleration = up * (f.sum() / MASS_KG) - Vector3::z() * GRAVITY_MPS2 + drag_mps2(velocity);
                let mut rate = SVector::<f64, 17>::zeros();
                rate.fixed_rows_mut::<3>(0).copy_from(&velocity);
                rate.fixed_rows_mut::<3>(3).copy_from(&acceleration);
                rate.fixed_rows_mut::<4>(6).copy_from(&(q * Quaternion::from_imag(rates) * 0.5).coords);
                rate.fixed_rows_mut::<3>(10).copy_from(&update_rotors);
                let command = Vector4::from(thrusts.control.thrust_n);
                rate.fixed_rows_mut::<4>(13).copy_from(&((command - f) / 0.03));
                rate
            });
        }
    }
    // Without feedback an attitude that is off by 1e-4 rad leads 2 cm astray in 6 s.
    assert!(worst_m < 8e-3 && worst_rad < 5e-4, "{worst_m} m, {worst_rad} rad");
}

#[test]
fn both_plants_follow_the_plan_and_the_quadrotor_less_closely() {
    let largest_m = |plant: &str| {
        let flight = flown(plant);
        let error_m = |sample: &Sample| error_m(sample, sample.reference_position_m.into());
        flight.vehicles[0].samples.iter().map(error_m).fold(0.0, f64::max)
    };
    let (point_mass_m, quadrotor_m) = (largest_m("point-mass"), largest_m("quadrotor"));
    // Wind of 2.3 m/s and more pushes by some 0.2 m/s²; the tracker gives way by 0.2 / 2.5² m.
    assert!(point_mass_m < 0.08, "{point_mass_m} m");
    assert!(quadrotor_m < 0.25 && quadrotor_m > point_mass_m, "{quadrotor_m} m");
}

#[test]
fn open_loop_in_still_air_the_point_mass_flies_the_plan_itself() {
    let mut scenario = scenario("point-mass");
    scenario.simulation.wind = None;
    scenario.models.multirotor.get_mut("quad").expect("the model").drag_area_m2 = 0.0;
    let setup = FlightOptions { control_mode: ControlMode::OpenLoop, ..FlightOptions::default() };
    let flight = fly_with(&scenario, &plan(&scenario, &nodes()), 0, &setup, &mut |_| {});
    let error_m = |sample: &Sample| error_m(sample, sample.reference_position_m.into());
    let worst_m = flight.vehicles[0].samples.iter().map(error_m).fold(0.0, f64::max);
    // The acceleration is held over each step at its middle value, from step to step it changes by some 0.03 m/s².
    assert!(worst_m < 1e-4, "{worst_m} m");
}
