//! Polynomial pieces, and positions alone, as the motions that simulator and judge know.

use scenarios::curve::{CubicNode, Curve, Piece};
use scenarios::fixed_wing::{PartialTrajectory, states_from_velocities};
use scenarios::multirotor::{Limits, Positions, State, Trajectory};
use scenarios::{Scenario, Trajectory as AnyTrajectory, Vehicle};

use super::rounding::Rounding;
use super::{at, end_velocity, velocities};
use crate::verdict::reconstruction::max_distance_m;
use crate::verdict::{CurveAsCubics, GivenRows, Reconstruction, RoundedRows, VehicleProvenance};

/// The error of the accelerations of the cubics that is aimed at, as a fraction of the vehicle's limit.
const ACCELERATION_ERROR: f64 = 1e-4;
/// Distance of the rows that a fixed wing's curve becomes, s: what lies between them is bounded by its limits.
const FIXED_WING_ROW_S: f64 = 0.05;
/// Largest number of rows of one piece.
const MAX_ROWS: f64 = 20_000.0;

/// A multirotor's pieces as cubics.
pub(super) fn multirotor(limits: &Limits, curve: &Curve) -> (AnyTrajectory, VehicleProvenance) {
    let (nodes, error) = curve.cubics(ACCELERATION_ERROR * limits.acceleration_mps2);
    let state = |node: &CubicNode| State { position_m: node.position_m, velocity_mps: node.velocity_mps };
    let trajectory = Trajectory {
        vehicle: curve.vehicle.clone(),
        times_s: nodes.iter().map(|node| node.t_s).collect(),
        states: nodes.iter().map(state).collect(),
    };
    let as_cubics = CurveAsCubics {
        pieces: curve.pieces.len(),
        degree: curve.degree(),
        cubics: nodes.windows(2).filter(|pair| pair[0].t_s < pair[1].t_s).count(),
        position_m: error.position_m,
        velocity_mps: error.velocity_mps,
        acceleration_mps2: error.acceleration_mps2,
    };
    (trajectory.into(), VehicleProvenance { curve: Some(as_cubics), ..VehicleProvenance::default() })
}

/// A fixed wing's pieces as rows with their velocities.
pub(super) fn fixed_wing(curve: &Curve) -> PartialTrajectory {
    let mut rows: Vec<(f64, [f64; 3], [f64; 3])> = Vec::new();
    let row = |piece: &Piece, u: f64| {
        let [begin_s, end_s] = piece.t_s;
        let t_s = if u == 1.0 { end_s } else { begin_s + u * (end_s - begin_s) };
        (t_s, piece.position_m(u), piece.velocity_mps(u))
    };
    for piece in &curve.pieces {
        let count = (piece.duration_s() / FIXED_WING_ROW_S).ceil().clamp(1.0, MAX_ROWS) as usize;
        rows.extend((0..count).map(|k| row(piece, k as f64 / count as f64)));
    }
    rows.extend(curve.pieces.last().map(|piece| row(piece, 1.0)));
    let positions_m: Vec<[f64; 3]> = rows.iter().map(|row| row.1).collect();
    let velocities_mps: Vec<[f64; 3]> = rows.iter().map(|row| row.2).collect();
    PartialTrajectory {
        vehicle: curve.vehicle.clone(),
        times_s: rows.iter().map(|row| row.0).collect(),
        states: Some(states_from_velocities(&positions_m, &velocities_mps)),
        positions_m,
        controls: None,
    }
}

/// A multirotor's positions with the velocities of a spline through them, which begins at the velocity of the start.
pub(super) fn through_positions(
    scenario: &Scenario,
    vehicle: &Vehicle,
    positions: Positions,
) -> (AnyTrajectory, VehicleProvenance) {
    let acceleration_mps2 = scenario.multirotor_model(vehicle).limits.acceleration_mps2;
    let end_velocity = end_velocity(&positions.times_s, &positions.positions_m, acceleration_mps2);
    let (Positions { vehicle: name, times_s, positions_m }, rounded) = thinned(positions, acceleration_mps2);
    let velocities_mps = velocities::of(&times_s, &positions_m, vehicle.start.velocity_mps());
    let row_interval_s = times_s.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    let reconstruction = Reconstruction {
        velocities: true,
        row_interval_s,
        between_rows_m: max_distance_m(&GivenRows::Positions, acceleration_mps2, row_interval_s),
        ..Reconstruction::default()
    };
    let states = positions_m.into_iter().zip(velocities_mps);
    let states = states.map(|(position_m, velocity_mps)| State { position_m, velocity_mps }).collect();
    let provenance = VehicleProvenance {
        given: GivenRows::Positions,
        reconstruction: Some(reconstruction),
        rounded,
        end_velocity,
        ..VehicleProvenance::default()
    };
    (Trajectory { vehicle: name, times_s, states }.into(), provenance)
}

/// Positions without the rows that are noise. Rows in between that the vehicle cannot have reached are kept.
fn thinned(positions: Positions, acceleration_mps2: f64) -> (Positions, Option<RoundedRows>) {
    let Positions { vehicle, times_s, positions_m } = &positions;
    let rounding = Rounding::of(times_s, positions_m, &[]);
    let is_between = |from, to| rounding.is_within_reach(times_s, positions_m, &[], acceleration_mps2, [from, to]);
    let Some(kept) = rounding.rows_to_keep(times_s, acceleration_mps2, is_between) else { return (positions, None) };
    let rounded = rounding.rows(times_s.len(), kept.len());
    let vehicle = vehicle.clone();
    (Positions { vehicle, times_s: at(&kept, times_s), positions_m: at(&kept, positions_m) }, Some(rounded))
}
