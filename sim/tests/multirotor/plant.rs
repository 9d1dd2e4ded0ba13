//! The logged controls integrated independently, from Newton's and Euler's laws, by a Runge-Kutta method of order 4
//! with small steps.

use nalgebra::{Quaternion, SVector, UnitQuaternion, Vector3, Vector4};
use scenarios::multirotor::GRAVITY_MPS2;
use sim::{Actuation, ControlMode, Flight, FlightOptions, Sample, fly, fly_with};

use crate::arena::{nodes, plan, scenario};

/// Steps of the integrator for each step of the simulator.
const SUBSTEPS: usize = 20;
const STEP_S: f64 = 0.01;
const MASS_KG: f64 = 1.5;
const DRAG_AREA_M2: f64 = 0.05;
const WIND_MPS: [f64; 3] = [2.0, -1.0, 0.5];

fn drag_mps2(velocity_mps: Vector3<f64>) -> Vector3<f64> {
    let relative = Vector3::from(WIND_MPS) - velocity_mps;
    relative * (relative.norm() * 0.5 * 1.225 * DRAG_AREA_M2 / MASS_KG)
}

pub fn rk4<const N: usize>(
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
fn the_start_is_drawn_from_the_disc_of_the_scenario() {
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
fn the_logged_accelerations_and_air_explain_the_motion_of_a_point_mass() {
    let flight = flown("point-mass");
    let samples = &flight.vehicles[0].samples;
    let mut state = SVector::<f64, 6>::zeros();
    state.fixed_rows_mut::<3>(0).copy_from(&Vector3::from(samples[0].position_m));
    let mut max_m: f64 = 0.0;
    for sample in samples {
        max_m = max_m.max(error_m(sample, state.fixed_rows::<3>(0).into()));
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
    assert!(samples.len() == 601 && max_m < 2e-3, "{max_m} m");
}

#[test]
fn the_logged_thrusts_and_air_explain_the_motion_of_a_quadrotor() {
    let flight = flown("quadrotor");
    let samples = &flight.vehicles[0].samples;
    let inertia = Vector3::new(0.0177, 0.0150, 0.0264);
    // Position, velocity, quaternion (x, y, z, w), body rates, thrusts.
    let mut state = SVector::<f64, 17>::zeros();
    state.fixed_rows_mut::<3>(0).copy_from(&Vector3::from(samples[0].position_m));
    state[9] = 1.0;
    state.fixed_rows_mut::<4>(13).copy_from(&Vector4::repeat(MASS_KG * GRAVITY_MPS2 / 4.0));
    let (mut max_m, mut max_rad): (f64, f64) = (0.0, 0.0);
    for sample in samples {
        let attitude = |q: Vector4<f64>| UnitQuaternion::from_quaternion(Quaternion::from(q));
        let flown = attitude(Vector4::from(sample.world_from_body));
        max_m = max_m.max(error_m(sample, state.fixed_rows::<3>(0).into()));
        max_rad = max_rad.max(flown.angle_to(&attitude(state.fixed_rows::<4>(6).into())));
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
                let angular_acceleration =
                    (torque - rates.cross(&inertia.component_mul(&rates))).component_div(&inertia);
                let acceleration = up * (f.sum() / MASS_KG) - Vector3::z() * GRAVITY_MPS2 + drag_mps2(velocity);
                let mut rate = SVector::<f64, 17>::zeros();
                rate.fixed_rows_mut::<3>(0).copy_from(&velocity);
                rate.fixed_rows_mut::<3>(3).copy_from(&acceleration);
                rate.fixed_rows_mut::<4>(6).copy_from(&(q * Quaternion::from_imag(rates) * 0.5).coords);
                rate.fixed_rows_mut::<3>(10).copy_from(&angular_acceleration);
                let command = Vector4::from(thrusts.control.thrust_n);
                rate.fixed_rows_mut::<4>(13).copy_from(&((command - f) / 0.03));
                rate
            });
        }
    }
    // Without feedback an attitude error of 1e-4 rad results in a position error of 2 cm after 6 s.
    assert!(max_m < 8e-3 && max_rad < 5e-4, "{max_m} m, {max_rad} rad");
}

#[test]
fn both_plants_follow_the_plan_and_the_quadrotor_less_closely() {
    let largest_m = |plant: &str| {
        let flight = flown(plant);
        let error_m = |sample: &Sample| error_m(sample, sample.reference_position_m.into());
        flight.vehicles[0].samples.iter().map(error_m).fold(0.0, f64::max)
    };
    let (point_mass_m, quadrotor_m) = (largest_m("point-mass"), largest_m("quadrotor"));
    // Wind of 2.3 m/s and more accelerates by some 0.2 m/s², which displaces the vehicle by 0.2 / 2.5² m.
    assert!(point_mass_m < 0.08, "{point_mass_m} m");
    assert!(quadrotor_m < 0.25 && quadrotor_m > point_mass_m, "{quadrotor_m} m");
}

#[test]
fn open_loop_in_still_air_the_point_mass_follows_the_plan() {
    let mut scenario = scenario("point-mass");
    scenario.simulation.wind = None;
    scenario.models.multirotor.get_mut("quad").expect("the model").drag_area_m2 = 0.0;
    let options = FlightOptions { control_mode: ControlMode::OpenLoop, ..FlightOptions::default() };
    let flight = fly_with(&scenario, &plan(&scenario, &nodes()), 0, &options, &mut |_| {});
    let error_m = |sample: &Sample| error_m(sample, sample.reference_position_m.into());
    let max_m = flight.vehicles[0].samples.iter().map(error_m).fold(0.0, f64::max);
    // The acceleration is held over each step at its middle value; it changes by some 0.03 m/s² per step.
    assert!(max_m < 1e-4, "{max_m} m");
}
