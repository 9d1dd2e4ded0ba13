//! Completion of imported plans: a plan that gives positions only, or states only, gets velocities and controls.
//!
//! For the fixed-wing point mass the position is a flat output: velocity, speed, heading and flight-path angle follow
//! from its first derivative, the load factors from its second. `velocities` differentiates a spline; `controls` takes the
//! second derivative as the initial guess of a fit of the load factors to the nodes by the simulator's equations of motion,
//! whose residual is known. Plans of other families must be complete.

mod controls;
mod velocities;

use scenarios::fixed_wing::{PartialTrajectory, State, Trajectory, states_from_velocities};
use scenarios::plan_input::{ImportedTrajectory, PlanHeader};
use scenarios::{Interpolation, Plan, PlanStatus, Scenario, Vehicle};

use crate::verdict::{Provenance, Reconstruction};

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
    let mut reconstruction: Option<Reconstruction> = None;
    let mut trajectories = Vec::with_capacity(tracks.len());
    for (vehicle, track) in scenario.vehicles.iter().zip(tracks) {
        match track {
            ImportedTrajectory::Complete(trajectory) => trajectories.push(trajectory),
            ImportedTrajectory::Partial(track) => {
                let (trajectory, own) = complete_trajectory(vehicle, track);
                reconstruction = larger_errors(reconstruction, own);
                trajectories.push(trajectory.into());
            }
        }
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
    CompletedPlan { plan, provenance: Provenance { reconstruction } }
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

/// The larger errors of two vehicles. NaN counts as larger than any number.
fn larger_errors(a: Option<Reconstruction>, b: Option<Reconstruction>) -> Option<Reconstruction> {
    let larger = |a: f64, b: f64| if a.is_nan() || a > b { a } else { b };
    match (a, b) {
        (Some(a), Some(b)) => Some(Reconstruction {
            velocities: a.velocities || b.velocities,
            position_m: larger(a.position_m, b.position_m),
            velocity_mps: larger(a.velocity_mps, b.velocity_mps),
            load_factor: larger(a.load_factor, b.load_factor),
        }),
        (a, b) => a.or(b),
    }
}

#[cfg(test)]
mod tests;
