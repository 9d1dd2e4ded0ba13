//! The guard.

use harness::guard::{self, Knot};
use harness::verdict::Status;
use pyo3::prelude::*;

use crate::error::invalid;
use crate::geometry::fill;
use crate::scenario::Scenario;

/// Name, status, value, limit, margin, unit, time, and the limited quantity or the obstacle of a check.
type Row = (&'static str, &'static str, f64, f64, f64, &'static str, f64, Option<String>);

/// Judges candidates for one multirotor.
#[pyclass(module = "uav_harness.native")]
pub struct Guard {
    guard: guard::Guard,
    knots: Vec<Knot>,
}

#[pymethods]
impl Guard {
    #[new]
    fn new(scenario: &Scenario, vehicle: &str) -> PyResult<Self> {
        let guard = guard::Guard::new(&scenario.scenario, vehicle).map_err(|error| invalid(error.to_string()))?;
        Ok(Self { guard, knots: Vec::new() })
    }

    /// Replaces the map and the obstacles by those of a scenario.
    fn set_world(&mut self, scenario: &Scenario) {
        self.guard.set_world(&scenario.scenario.world);
    }

    /// Status, why the candidate is no motion, and the checks.
    fn judge(
        &mut self,
        py: Python<'_>,
        knots: [Bound<'_, PyAny>; 3],
        measured: Option<(f64, [f64; 3], [f64; 3])>,
    ) -> PyResult<(&'static str, Option<String>, Vec<Row>)> {
        let [times, positions, velocities] = &knots;
        fill(py, "candidate", [times, positions, velocities], &mut self.knots)?;
        let measured = measured.map(|(t_s, position_m, velocity_mps)| Knot { t_s, position_m, velocity_mps });
        let Self { guard, knots } = self;
        let assessment = py.detach(|| guard.judge(knots, measured.as_ref()));
        let defect = assessment.defect.map(|defect| defect.to_string());
        Ok((
            word(assessment.status),
            defect,
            assessment.margins.iter().map(|margin| row(&self.guard, margin)).collect(),
        ))
    }
}

fn row(guard: &guard::Guard, margin: &guard::Margin) -> Row {
    let guard::Margin { check, status, value, limit, margin, unit, at_s, quantity, obstacle } = *margin;
    let of = match check {
        "plan.clearance" if value.is_finite() => Some(guard.obstacle_name(obstacle).to_owned()),
        _ => quantity.map(str::to_owned),
    };
    (check, word(status), value, limit, margin, unit, at_s, of)
}

fn word(status: Status) -> &'static str {
    match status {
        Status::Pass => "pass",
        Status::Fail => "fail",
        Status::Undecided => "undecided",
        Status::Skip => "skip",
    }
}
