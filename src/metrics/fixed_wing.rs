//! Figures of fixed-wing fleets, as their papers report them.

use scenarios::fixed_wing::Trajectory;
use scenarios::{Plan, Scenario};
use sim::Flight;

use super::flight::{self, Dispersion};
use super::{FlightMetrics, Metrics, PlanMetrics, SmallestDistances, finite};
use crate::verdict::fixed_wing::{PlannedMotions, clearance_at_nodes, closest_obstacle};
use crate::verdict::{self, Motion};

/// Measures a flyable plan and, if there is one, its flight.
pub fn measure(scenario: &Scenario, plan: &Plan, flight: Option<&Flight>) -> Metrics {
    Metrics {
        plan: Some(of_plan(scenario, plan)),
        flight: flight.and_then(|flight| of_flight(scenario, plan, flight)),
        ..Metrics::default()
    }
}

fn of_flight(scenario: &Scenario, plan: &Plan, flight: &Flight) -> Option<FlightMetrics> {
    flight::measure(scenario, plan, flight, |motions| distances(scenario, motions))
}

fn of_plan(scenario: &Scenario, plan: &Plan) -> PlanMetrics {
    let planned = PlannedMotions::new(scenario, plan);
    let trajectories = || plan.trajectories.iter().map(scenarios::Trajectory::fixed_wing);
    let states = |value: fn(&scenarios::fixed_wing::State) -> f64| {
        Dispersion::over(trajectories().map(|trajectory| trajectory.states.iter().map(value)))
    };
    let controls = |axis: usize, trim: f64| {
        let magnitudes = |trajectory: &Trajectory| -> f64 {
            trajectory.controls.iter().map(|control| (control.to_array()[axis] - trim).abs()).sum()
        };
        finite(trajectories().map(magnitudes).sum())
    };
    let (speed, altitude) = (states(|state| state.speed_mps), states(|state| state.z_m));
    PlanMetrics {
        flight_time_s: plan.flight_time_s().and_then(finite),
        mean_speed_mps: speed.mean,
        speed_std_mps: speed.standard_deviation,
        altitude_std_m: altitude.standard_deviation,
        sum_abs_n_x: controls(0, 0.0),
        sum_abs_n_y: controls(1, 0.0),
        sum_abs_n_z_minus_1: controls(2, 1.0),
        at_nodes: SmallestDistances {
            separation_m: verdict::separation_at_nodes(plan, scenario.separation_measure())
                .and_then(|nearest| finite(nearest.lower_m)),
            clearance_m: clearance_at_nodes(scenario, plan).and_then(|nearest| finite(nearest.lower_m)),
        },
        between_nodes: planned.map_or_else(|_| SmallestDistances::default(), |it| distances(scenario, &it.motions)),
    }
}

fn distances(scenario: &Scenario, motions: &[Motion]) -> SmallestDistances {
    SmallestDistances {
        separation_m: verdict::closest_vehicles(motions, scenario.separation_measure()).map(|nearest| nearest.lower_m),
        clearance_m: closest_obstacle(scenario, motions).map(|nearest| nearest.lower_m),
    }
}
