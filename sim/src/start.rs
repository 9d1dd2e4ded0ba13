//! Where vehicles really start.

use nalgebra::Vector3;
use rand_distr::{Distribution, UnitDisc};
use scenarios::Vehicle;

use crate::kinematics::PointState;
use crate::request::FlightRequest;

/// True start of a vehicle relative to its nominal one: the offsets of the options, and a draw from the disc of the
/// scenario.
pub(crate) fn offset(request: &FlightRequest<'_>, vehicle: &Vehicle) -> PointState {
    let [east, north]: [f64; 2] = UnitDisc.sample(&mut request.stream("start", vehicle));
    let drawn_m = Vector3::new(east, north, 0.0) * request.scenario.simulation.mismatch.start_radius_m;
    PointState {
        position_m: Vector3::from(request.options.start_offset_m) + drawn_m,
        velocity_mps: request.options.start_velocity_offset_mps.into(),
    }
}
