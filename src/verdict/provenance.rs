//! What of a plan its plan_source gave, and what had to be reconstructed: a check never says more than the plan does.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::number_format::quantity;
use crate::verdict::{Check, Status};

/// What of a plan is its plan_source's.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Provenance {
    /// What was missing and has been reconstructed; `None` if the plan was whole.
    pub reconstruction: Option<Reconstruction>,
}

/// How well what was reconstructed fits what was given.
///
/// Load factors are sought that lead, through the simulator's equations, from each node to the next. What they miss is
/// stated here, and no check may be decided by less than it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Reconstruction {
    /// Were the velocities missing too, not only the controls?
    pub velocities: bool,
    /// Largest distance by which an interval's end misses the next node, m.
    pub position_m: f64,
    /// Largest difference of velocities there, m/s.
    pub velocity_mps: f64,
    /// Largest change of a load factor that would take up what is missed within its interval, -.
    pub load_factor: f64,
}

impl Provenance {
    /// The plan was whole.
    pub fn whole() -> Self {
        Self::default()
    }

    /// Takes back what the checks of an incomplete plan cannot say: questions about what was not given are skipped, and
    /// what is decided by less than the reconstruction's error becomes undecided.
    pub(super) fn mark_undecided(&self, checks: &mut [Check]) {
        let Some(reconstruction) = &self.reconstruction else { return };
        for check in checks {
            match check.name.as_str() {
                "nodes.control_limits" => skip(check, "the plan gives no controls"),
                "nodes.state_limits" if reconstruction.velocities => skip(check, "the plan gives no velocities"),
                "plan.rollout" => {
                    skip(check, "the plan gives no controls, and reconstructed ones say nothing open loop");
                }
                "plan.dynamics" if check.is_bad() => {
                    let remark = "no controls were given, and none were found that lead from node to node: if the plan \
                                  is right, give its controls, or nodes closer together";
                    check.reason = Some(remark.into());
                }
                name if name.starts_with("plan.") => reconstruction.mark_undecided(check),
                _ => {}
            }
        }
    }
}

impl Reconstruction {
    /// Whether the limit is kept cannot be told if the margin is smaller than the error.
    fn mark_undecided(&self, check: &mut Check) {
        let error = match check.unit.as_str() {
            "m" => self.position_m,
            "m/s" => self.velocity_mps,
            "-" => self.load_factor,
            // an angle of the velocity: beyond the slowest flight that makes sense, 10 m/s
            "deg" => (self.velocity_mps / 10.0).atan().to_degrees(),
            _ => return,
        };
        let is_decided = check.margin.is_none_or(|margin| margin.abs() > error);
        if !is_decided {
            check.status = Status::Undecided;
            let remark =
                format!("reconstructed to {} only: closer to the limit than that", quantity(error, &check.unit));
            let before = check.reason.take().map_or_else(String::new, |reason| format!("{reason}; "));
            check.reason = Some(before + &remark);
        }
    }

    /// In words, for people.
    pub fn describe(&self) -> String {
        let what = if self.velocities { "velocities and controls" } else { "controls" };
        let missed = quantity(self.position_m, "m");
        format!(
            "{what} reconstructed: they miss the nodes by {missed}, load factors to ±{}",
            quantity(self.load_factor, "-")
        )
    }
}

fn skip(check: &mut Check, reason: &str) {
    let Check { name, unit, .. } = check.clone();
    *check = Check {
        name,
        status: Status::Skip,
        value: None,
        lower: None,
        upper: None,
        limit: None,
        margin: None,
        unit,
        at_s: None,
        between: Vec::new(),
        advisory: false,
        reason: Some(reason.to_owned()),
        limit_key: None,
    };
}

#[cfg(test)]
mod tests {
    use super::{Provenance, Reconstruction};
    use scenarios::check_spec;

    use crate::verdict::evidence::{Decide, Measurement};
    use crate::verdict::{Check, Status};

    fn given(velocities: bool) -> Provenance {
        let reconstruction = Reconstruction { velocities, position_m: 0.5, velocity_mps: 0.1, load_factor: 0.01 };
        Provenance { reconstruction: Some(reconstruction) }
    }

    fn qualified(provenance: &Provenance, check: Check) -> Check {
        let mut checks = [check];
        provenance.mark_undecided(&mut checks);
        let [check] = checks;
        check
    }

    fn separation(value_m: f64) -> Check {
        check_spec("plan.separation").unwrap().at_least(Measurement::value(value_m), 100.0)
    }

    #[test]
    fn what_lies_within_the_error_of_the_reconstruction_is_undecided_on_either_side() {
        let status = |value_m| qualified(&given(false), separation(value_m)).status;
        assert_eq!(status(100.6), Status::Pass);
        assert_eq!(status(100.4), Status::Undecided);
        assert_eq!(status(99.6), Status::Undecided);
        assert_eq!(status(99.4), Status::Fail);
        assert_eq!(qualified(&Provenance::whole(), separation(100.4)).status, Status::Pass);
    }

    #[test]
    fn an_error_that_is_no_number_decides_nothing() {
        let mut provenance = given(false);
        if let Some(reconstruction) = &mut provenance.reconstruction {
            reconstruction.position_m = f64::NAN;
        }
        assert_eq!(qualified(&provenance, separation(500.0)).status, Status::Undecided);
    }

    #[test]
    fn what_was_not_given_is_not_asked() {
        let node_check = |name| check_spec(name).unwrap().at_most(Measurement::value(0.0), 1.0);
        let rollout = check_spec("plan.rollout").unwrap().at_most(Measurement::value(0.0), 1.0);
        for (velocities, check, status) in [
            (false, node_check("nodes.control_limits"), Status::Skip),
            (false, node_check("nodes.state_limits"), Status::Pass),
            (true, node_check("nodes.state_limits"), Status::Skip),
            (false, rollout, Status::Skip),
        ] {
            let answer = qualified(&given(velocities), check);
            assert_eq!((answer.status, answer.reason.is_some()), (status, status == Status::Skip), "{}", answer.name);
        }
    }

    #[test]
    fn what_was_flown_is_not_doubted() {
        let flown = check_spec("flight.separation").unwrap().at_least(Measurement::value(100.1), 100.0);
        assert_eq!(qualified(&given(true), flown).status, Status::Pass);
    }
}
