//! Completion of imported plans: a plan that gives positions only, or states only, gets velocities and controls.
//!
//! For the fixed-wing point mass the position is a flat output: velocity, speed, heading and flight-path angle follow
//! from its first derivative, the load factors from its second. `velocities` differentiates a spline; `controls` takes the
//! second derivative as the initial guess of a fit of the load factors to the nodes by the simulator's equations of motion,
//! whose residual is known. Of multirotors, `curves` turns polynomial pieces into cubics with certified errors, and positions
//! into a spline through them. Plans of slung loads must be complete.

mod controls;
mod curves;
mod rounding;
mod velocities;

use nalgebra::Vector3;
use rounding::Rounding;
use scenarios::fixed_wing::{PartialTrajectory, State, Trajectory, states_from_velocities};
use scenarios::plan_input::{ImportedTrajectory, PlanHeader, RecordedRows, Setpoints};
use scenarios::{Interpolation, Plan, PlanStatus, Scenario, Trajectory as AnyTrajectory, Vehicle, multirotor};

use crate::number_format::quantity;
use crate::verdict::fixed_wing::max_acceleration_mps2;
use crate::verdict::reconstruction::{max_distance_m, max_velocity_from_chord_mps};
use crate::verdict::{EndVelocity, GivenRows, Provenance, Reconstruction, RoundedRows, VehicleProvenance};

/// Load factors that are known better than this come from velocities that fit the positions.
const EXACT_LOAD_FACTOR: f64 = 1e-3;

/// A complete plan, and what of it was reconstructed.
#[derive(Clone, Debug)]
pub struct CompletedPlan {
    /// The complete plan.
    pub plan: Plan,
    /// What was reconstructed.
    pub provenance: Provenance,
}

impl CompletedPlan {
    /// A plan that was complete.
    pub fn whole(plan: Plan) -> Self {
        Self { plan, provenance: Provenance::whole() }
    }
}

/// Makes a plan from what was read.
///
/// - `tracks`: one per vehicle, in the order of the scenario; none at all is a plan that says it is none
/// - `planner`: name under which the results go
pub fn complete(
    scenario: &Scenario,
    header: PlanHeader,
    tracks: Vec<ImportedTrajectory>,
    planner: &str,
    seed: u64,
) -> CompletedPlan {
    let mut provenance = Provenance::whole();
    provenance.remarks = header.remarks;
    let mut trajectories = Vec::with_capacity(tracks.len());
    for (vehicle, track) in scenario.vehicles.iter().zip(tracks) {
        let (trajectory, own) = completed(scenario, vehicle, track);
        provenance.remarks.extend(own_nodes(&trajectory));
        trajectories.push(trajectory);
        provenance.add(own);
    }
    let plan = Plan {
        status: header.status.unwrap_or(PlanStatus::Unstated),
        reason: header.reason,
        objective: header.objective,
        history: header.history,
        diagnostics: header.diagnostics,
        timings: header.timings.unwrap_or_default(),
        ..Plan::new(&scenario.name, planner, seed, trajectories)
    };
    CompletedPlan { plan, provenance }
}

/// The samples of a flight that was flown elsewhere, as trajectories, and where the vehicles were told to be.
///
/// - `rows`: one track per vehicle, in the order of the scenario
/// - `name`: under which the results go
pub fn complete_flight(scenario: &Scenario, rows: RecordedRows, name: &str) -> (CompletedPlan, Vec<Option<Setpoints>>) {
    let mut provenance = Provenance::whole();
    provenance.remarks = rows.remarks;
    let (mut trajectories, mut setpoints) = (Vec::new(), Vec::new());
    for (vehicle, track) in scenario.vehicles.iter().zip(rows.tracks) {
        let (trajectory, own) = sampled(scenario, vehicle, track.motion);
        provenance.remarks.extend(between_samples(scenario, vehicle, &trajectory, &own.given));
        provenance.add(own);
        trajectories.push(trajectory);
        setpoints.push(track.setpoints);
    }
    let plan = Plan {
        status: PlanStatus::Unstated,
        ..Plan::new(&scenario.name, name, scenario.simulation.seed, trajectories)
    };
    (CompletedPlan { plan, provenance }, setpoints)
}

/// The samples of one vehicle. Those of a multirotor with velocities are not its whole motion, as those of a plan are.
fn sampled(scenario: &Scenario, vehicle: &Vehicle, motion: ImportedTrajectory) -> (AnyTrajectory, VehicleProvenance) {
    let (trajectory, own) = completed(scenario, vehicle, motion);
    match &trajectory {
        AnyTrajectory::Multirotor(rows) if own.given == GivenRows::Everything => {
            let given = GivenRows::States(rows.states.iter().map(|state| state.velocity_mps).collect());
            (trajectory, VehicleProvenance { given, ..own })
        }
        _ => (trajectory, own),
    }
}

/// What is not known between the samples of a multirotor, for people; of others the reconstruction tells it.
fn between_samples(
    scenario: &Scenario,
    vehicle: &Vehicle,
    trajectory: &AnyTrajectory,
    given: &GivenRows,
) -> Option<String> {
    let AnyTrajectory::Multirotor(rows) = trajectory else { return None };
    let GivenRows::States(_) = given else { return None };
    let acceleration_mps2 = scenario.multirotor_model(vehicle).limits.acceleration_mps2;
    let longest_s = rows.times_s.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    let [longest, known] = [(longest_s, "s"), (max_distance_m(given, acceleration_mps2, longest_s), "m")]
        .map(|(value, unit)| quantity(value, unit));
    Some(format!("samples of {} up to {longest} apart: between them its motion is known to {known}", vehicle.name))
}

/// What the checks at the nodes rest on, if it is not every row.
fn own_nodes(trajectory: &AnyTrajectory) -> Option<String> {
    let AnyTrajectory::SlungLoad(trajectory) = trajectory else { return None };
    let (nodes, rows) = (trajectory.planner_nodes().len(), trajectory.times_s.len());
    (nodes < rows).then(|| format!("the checks nodes.* rest on {nodes} of {rows} rows, the planner's own nodes"))
}

/// The trajectory of one vehicle, without the rows that are noise, and what of it was given.
fn completed(scenario: &Scenario, vehicle: &Vehicle, track: ImportedTrajectory) -> (AnyTrajectory, VehicleProvenance) {
    match track {
        ImportedTrajectory::Complete(AnyTrajectory::Multirotor(trajectory)) => {
            let limits = &scenario.multirotor_model(vehicle).limits;
            let (trajectory, rounded) = thinned_multirotor(trajectory, limits.acceleration_mps2);
            (trajectory.into(), VehicleProvenance { rounded, ..VehicleProvenance::default() })
        }
        ImportedTrajectory::Complete(trajectory) => (trajectory, VehicleProvenance::default()),
        ImportedTrajectory::Positions(positions) => curves::through_positions(scenario, vehicle, positions),
        ImportedTrajectory::Curve(curve) if scenario.family().hovers() => {
            curves::multirotor(&scenario.multirotor_model(vehicle).limits, &curve)
        }
        ImportedTrajectory::Curve(curve) => {
            completed(scenario, vehicle, ImportedTrajectory::Partial(curves::fixed_wing(&curve)))
        }
        ImportedTrajectory::Partial(track) => {
            let limits = &scenario.fixed_wing_model(vehicle).limits;
            let lacks_controls = track.controls.is_none();
            let lacks_velocities = track.states.is_none();
            let end_velocity = end_velocity(&track.times_s, &track.positions_m, max_acceleration_mps2(limits))
                .filter(|_| lacks_velocities);
            let (track, rounded) = thinned(track, max_acceleration_mps2(limits));
            let (given, trajectory, residual) = reconstructed(vehicle, track);
            let reconstruction =
                residual.map(|residual| between_rows(scenario, vehicle, &trajectory, &given, residual));
            let own = VehicleProvenance { reconstruction, given, rounded, lacks_controls, end_velocity, curve: None };
            (trajectory.into(), own)
        }
    }
}

/// The complete trajectory and what of it was given.
///
/// Given velocities need not fit the positions: those of a planner's coarse model do not. Then the motion through the
/// positions alone may be closer to both.
fn reconstructed(vehicle: &Vehicle, track: PartialTrajectory) -> (GivenRows, Trajectory, Option<Reconstruction>) {
    let given = given_rows(&track);
    let positions = PartialTrajectory { states: None, ..track.clone() };
    let (trajectory, residual) = complete_trajectory(vehicle, track);
    let GivenRows::States(given_mps) = &given else { return (given, trajectory, residual) };
    let Some(own) = residual.filter(|own| own.load_factor > EXACT_LOAD_FACTOR) else {
        return (given, trajectory, residual);
    };
    let (smooth, smooth_residual) = complete_trajectory(vehicle, positions);
    let Some(smooth_residual) = smooth_residual else { return (given, trajectory, Some(own)) };
    let apart_mps = smooth
        .states
        .iter()
        .zip(given_mps)
        .map(|(state, given_mps)| (Vector3::from(state.velocity_mps()) - Vector3::from(*given_mps)).norm());
    let velocity_mps = apart_mps.fold(smooth_residual.velocity_mps, f64::max);
    let smooth_residual = Reconstruction { velocities: false, velocity_mps, ..smooth_residual };
    let interval_s = trajectory.times_s.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    // A cubic is off by a quarter of what its end velocities are off, times its duration.
    let off_m = |of: &Reconstruction| of.position_m + of.velocity_mps * interval_s / 4.0;
    if off_m(&smooth_residual) < off_m(&own) {
        (given, smooth, Some(smooth_residual))
    } else {
        (given, trajectory, Some(own))
    }
}

fn thinned_multirotor(
    trajectory: multirotor::Trajectory,
    acceleration_mps2: f64,
) -> (multirotor::Trajectory, Option<RoundedRows>) {
    let multirotor::Trajectory { vehicle, times_s, states } = &trajectory;
    let positions_m: Vec<[f64; 3]> = states.iter().map(|state| state.position_m).collect();
    let velocities_mps: Vec<[f64; 3]> = states.iter().map(|state| state.velocity_mps).collect();
    let rounding = Rounding::of(times_s, &positions_m, &velocities_mps);
    let is_between = |from, to| rounding.is_on_cubic(times_s, states, from, to);
    let Some(kept) = rounding.rows_to_keep(times_s, acceleration_mps2, is_between) else { return (trajectory, None) };
    let rounded = rounding.rows(times_s.len(), kept.len());
    let vehicle = vehicle.clone();
    (multirotor::Trajectory { vehicle, times_s: at(&kept, times_s), states: at(&kept, states) }, Some(rounded))
}

/// A fixed wing's table without the rows that are noise. What lies between the others is bounded by the vehicle's limits;
/// rows in between that it cannot have reached are kept. A table with controls is not thinned, since all of them count.
fn thinned(track: PartialTrajectory, acceleration_mps2: f64) -> (PartialTrajectory, Option<RoundedRows>) {
    if track.controls.is_some() {
        return (track, None);
    }
    let PartialTrajectory { vehicle, times_s, positions_m, states, controls: _ } = &track;
    let velocities_mps: Vec<[f64; 3]> = states.iter().flatten().map(State::velocity_mps).collect();
    let rounding = Rounding::of(times_s, positions_m, &velocities_mps);
    let is_between =
        |from, to| rounding.is_within_reach(times_s, positions_m, &velocities_mps, acceleration_mps2, [from, to]);
    let Some(kept) = rounding.rows_to_keep(times_s, acceleration_mps2, is_between) else { return (track, None) };
    let rounded = rounding.rows(times_s.len(), kept.len());
    let thinned = PartialTrajectory {
        vehicle: vehicle.clone(),
        times_s: at(&kept, times_s),
        positions_m: at(&kept, positions_m),
        states: states.as_ref().map(|states| at(&kept, states)),
        controls: None,
    };
    (thinned, Some(rounded))
}

/// What positions tell of the last velocity. It differs from that of a chord of duration T to the last row by a T/2 and by
/// the rounding of its ends; the best chord counts. `None` with fewer than two rows.
fn end_velocity(times_s: &[f64], positions_m: &[[f64; 3]], acceleration_mps2: f64) -> Option<EndVelocity> {
    let rounding = Rounding::of(times_s, positions_m, &[]);
    let (&end_s, &end_m) = (times_s.last()?, positions_m.last()?);
    let chords = times_s.iter().zip(positions_m).filter(|(begin_s, _)| **begin_s < end_s).map(|(begin_s, begin_m)| {
        let duration_s = end_s - begin_s;
        let velocity_mps = (Vector3::from(end_m) - Vector3::from(*begin_m)) / duration_s;
        let rounding_mps = 2.0 * 3.0_f64.sqrt() * rounding.position_m / duration_s;
        let error_mps = max_velocity_from_chord_mps(acceleration_mps2, duration_s, 1.0) + rounding_mps;
        EndVelocity { velocity_mps: velocity_mps.into(), error_mps }
    });
    chords.min_by(|a, b| a.error_mps.total_cmp(&b.error_mps))
}

/// The values at the rows that are kept.
fn at<T: Clone>(kept: &[usize], values: &[T]) -> Vec<T> {
    kept.iter().map(|row| values[*row].clone()).collect()
}

fn given_rows(track: &PartialTrajectory) -> GivenRows {
    match (&track.states, &track.controls) {
        (None, _) => GivenRows::Positions,
        (Some(states), None) => GivenRows::States(states.iter().map(State::velocity_mps).collect()),
        (Some(_), Some(_)) => GivenRows::Everything,
    }
}

/// The reconstruction with what the vehicle's limits allow between the rows.
fn between_rows(
    scenario: &Scenario,
    vehicle: &Vehicle,
    trajectory: &Trajectory,
    given: &GivenRows,
    residual: Reconstruction,
) -> Reconstruction {
    let acceleration_mps2 = max_acceleration_mps2(&scenario.fixed_wing_model(vehicle).limits);
    let row_interval_s = trajectory.times_s.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    let between_rows_m = max_distance_m(given, acceleration_mps2, row_interval_s);
    Reconstruction { row_interval_s, between_rows_m, ..residual }
}

fn complete_trajectory(vehicle: &Vehicle, track: PartialTrajectory) -> (Trajectory, Option<Reconstruction>) {
    let PartialTrajectory { vehicle: name, times_s, positions_m, states, controls } = track;
    let velocities_missing = states.is_none();
    let states: Vec<State> = states.unwrap_or_else(|| {
        let start_mps = vehicle.start.fixed_wing_state().velocity_mps();
        states_from_velocities(&positions_m, &velocities::of(&times_s, &positions_m, start_mps))
    });
    let (controls, reconstruction) = match controls {
        Some(controls) if !velocities_missing => (controls, None),
        Some(controls) => {
            let residual = controls::residual(&times_s, &states, &controls);
            (controls, Some(residual))
        }
        None => {
            let (controls, residual) = controls::fit(&times_s, &states);
            (controls, Some(residual))
        }
    };
    let reconstruction = reconstruction.map(|residual| Reconstruction { velocities: velocities_missing, ..residual });
    let interpolation = Interpolation::FirstOrderHold;
    (Trajectory { vehicle: name, interpolation, times_s, states, controls }, reconstruction)
}

#[cfg(test)]
mod tests;
