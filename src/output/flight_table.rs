//! The columns of a flight log: in the order of cause and effect within a step.

use sim::{Actuation, Commanded, Flight, VehicleLog};

const COMMON: [&str; 23] = [
    "t_s",
    "x_m",
    "y_m",
    "z_m",
    "vx_mps",
    "vy_mps",
    "vz_mps",
    "attitude_x",
    "attitude_y",
    "attitude_z",
    "attitude_w",
    "wind_x_mps",
    "wind_y_mps",
    "wind_z_mps",
    "measured_x_m",
    "measured_y_m",
    "measured_z_m",
    "measured_vx_mps",
    "measured_vy_mps",
    "measured_vz_mps",
    "reference_x_m",
    "reference_y_m",
    "reference_z_m",
];
const REFERENCE_VELOCITY: [&str; 3] = ["reference_vx_mps", "reference_vy_mps", "reference_vz_mps"];
const LOAD_FACTORS: [&str; 6] = ["command_n_x", "command_n_y", "command_n_z", "n_x", "n_y", "n_z"];
const THRUSTS: [&str; 8] = [
    "command_thrust_1_n",
    "command_thrust_2_n",
    "command_thrust_3_n",
    "command_thrust_4_n",
    "thrust_1_n",
    "thrust_2_n",
    "thrust_3_n",
    "thrust_4_n",
];
const ACCELERATION: [&str; 6] =
    ["command_ax_mps2", "command_ay_mps2", "command_az_mps2", "ax_mps2", "ay_mps2", "az_mps2"];
const LOAD: [&str; 16] = [
    "load_x_m",
    "load_y_m",
    "load_z_m",
    "load_vx_mps",
    "load_vy_mps",
    "load_vz_mps",
    "tension_n",
    "measured_load_x_m",
    "measured_load_y_m",
    "measured_load_z_m",
    "measured_load_vx_mps",
    "measured_load_vy_mps",
    "measured_load_vz_mps",
    "reference_load_x_m",
    "reference_load_y_m",
    "reference_load_z_m",
];

/// Names of the columns of a flight, which depend on its controls and loads.
pub fn columns(flight: &Flight) -> Vec<&'static str> {
    let first = flight.vehicles.iter().find_map(|log| log.samples.first());
    let controls: &[&str] = match first.map(|sample| &sample.actuation) {
        Some(Actuation::Thrusts(_)) => &THRUSTS,
        Some(Actuation::Acceleration(_)) => &ACCELERATION,
        Some(Actuation::LoadFactors(_)) | None => &LOAD_FACTORS,
    };
    let load: &[&str] = if flight.vehicles.iter().any(|log| !log.loads.is_empty()) { &LOAD } else { &[] };
    [&COMMON[..], &REFERENCE_VELOCITY, controls, load].concat()
}

/// The numbers of one step in the order of the columns; NaN for missing ones.
pub fn values(log: &VehicleLog, step: usize, width: usize) -> Vec<f64> {
    let sample = &log.samples[step];
    let mut row = vec![sample.t_s];
    row.extend(sample.position_m.iter().chain(&sample.velocity_mps).chain(&sample.world_from_body));
    row.extend(sample.wind_mps.iter().chain(&sample.measured_position_m).chain(&sample.measured_velocity_mps));
    row.extend(sample.reference_position_m.iter().chain(&sample.reference_velocity_mps));
    match &sample.actuation {
        Actuation::LoadFactors(Commanded { command, control }) => {
            row.extend(command.to_array().into_iter().chain(control.to_array()));
        }
        Actuation::Thrusts(Commanded { command, control }) => {
            row.extend(command.thrust_n.iter().chain(&control.thrust_n));
        }
        Actuation::Acceleration(Commanded { command, control }) => row.extend(command.iter().chain(control)),
    }
    if let Some(load) = log.loads.get(step) {
        row.extend(load.position_m.iter().chain(&load.velocity_mps).chain([&load.tension_n]));
        row.extend(load.measured_position_m.iter().chain(&load.measured_velocity_mps));
        row.extend(load.reference_position_m);
    }
    row.resize(width, f64::NAN);
    row
}
