//! Means over the geometries of a fleet: the comparison of the methods by Xu et al. (2022).

use scenarios::PlanStatus;
use serde::Serialize;

use super::{Measured, Row};
use crate::campaign::bench::entry::Outcome;

/// One planner on one fleet, over all geometries. Figures of the planner are means over the geometries that it calls solved.
#[derive(Clone, Debug, Serialize)]
pub struct Mean {
    /// Scenario that the vehicles come from.
    pub scenario: String,
    /// Number of its vehicles.
    pub vehicles: usize,
    /// The planner.
    pub planner: &'static str,
    /// Number of geometries.
    pub geometries: usize,
    /// In how many of them the planner calls its plan solved.
    pub solved: usize,
    /// In how many of them the judge passes plan and flight.
    pub passed: usize,
    /// Iterations.
    pub iterations: Option<f64>,
    /// Sum over the iterations of the slowest vehicle's time, s.
    pub distributed_s: Option<f64>,
    /// Planning time, s.
    pub wall_s: Option<f64>,
    /// Flight time, s.
    pub flight_time_s: Option<f64>,
}

impl Mean {
    /// Of the rows of `planner` among those of one fleet; panics without rows.
    pub(super) fn of(planner: &'static str, rows: &[Row]) -> Self {
        let own: Vec<&Row> = rows.iter().filter(|row| row.planner == planner).collect();
        let solved: Vec<&Measured> =
            own.iter().filter_map(|row| row.measured.as_ref()).filter(|it| it.status == PlanStatus::Solved).collect();
        Self {
            scenario: rows[0].scenario.clone(),
            vehicles: rows[0].vehicles,
            planner,
            geometries: own.len(),
            solved: solved.len(),
            passed: own.iter().filter(|row| row.outcome == Outcome::Pass).count(),
            iterations: mean(solved.iter().map(|it| it.iterations as f64)),
            distributed_s: mean(solved.iter().map(|it| it.distributed_s)),
            wall_s: mean(solved.iter().map(|it| it.wall_s)),
            flight_time_s: mean(solved.iter().filter_map(|it| it.flight_time_s)),
        }
    }
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(planner: &'static str, outcome: Outcome, status: PlanStatus, iterations: usize) -> Row {
        let measured = Measured {
            status,
            iterations,
            wall_s: 2.0,
            distributed_s: 1.0,
            per_vehicle_and_iteration_s: 0.1,
            flight_time_s: Some(170.0),
            separation_m: [None; 3],
            defect_m: None,
            rollout_m: None,
            flight_and_verdict_s: 0.0,
        };
        Row { scenario: "ring".into(), vehicles: 3, geometry: 0, planner, outcome, measured: Some(measured) }
    }

    #[test]
    fn means_are_over_the_solved_geometries_of_the_planner() {
        let rows = [
            row("dpd-scp", Outcome::Fail, PlanStatus::Solved, 20),
            row("parallel-scp", Outcome::Fail, PlanStatus::Solved, 7),
            row("dpd-scp", Outcome::Pass, PlanStatus::Solved, 30),
            row("dpd-scp", Outcome::Fail, PlanStatus::NotConverged, 60),
        ];
        let mean = Mean::of("dpd-scp", &rows);
        assert_eq!((mean.geometries, mean.solved, mean.passed), (3, 2, 1));
        assert_eq!((mean.iterations, mean.flight_time_s), (Some(25.0), Some(170.0)));
        let nothing = Mean::of("serial-scp", &rows);
        assert_eq!((nothing.geometries, nothing.solved, nothing.iterations), (0, 0, None));
    }
}
