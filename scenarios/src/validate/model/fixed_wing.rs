//! Fixed-wing models: each limit in itself, and the planning limits inside the physical ones.

use crate::fixed_wing::{Limits, Model};
use crate::validate::identifier::entity_name;
use crate::validate::quantity::{ordered, positive};
use crate::{Problem, Range};

use super::planning_inside_physical;

pub(super) fn problems(name: &str, model: &Model) -> Vec<Problem> {
    let field = format!("models.fixed-wing.{name}");
    let mut problems = Vec::new();
    problems.extend(entity_name(&field, name));
    problems.extend(positive(&format!("{field}.mass_kg"), model.mass_kg));
    problems.extend(positive(&format!("{field}.body_radius_m"), model.body_radius_m));
    problems.extend(limits(&format!("{field}.limits"), &model.limits));
    problems.extend(limits(&format!("{field}.planning_limits"), &model.planning_limits));
    problems.extend(planning_inside_physical(&field, named(&model.planning_limits), named(&model.limits)));
    problems
}

fn limits(field: &str, limits: &Limits) -> Vec<Problem> {
    let mut problems = Vec::new();
    for (name, range) in named(limits) {
        problems.extend(ordered(&format!("{field}.{name}"), range));
    }
    if limits.speed_mps.min <= 0.0 {
        let expected = "a least speed greater than 0: a fixed wing can't hover";
        problems.push(Problem::new(format!("{field}.speed_mps"), limits.speed_mps.to_string(), expected));
    }
    if limits.flight_path_deg.min <= -90.0 || limits.flight_path_deg.max >= 90.0 {
        let expected = "both ends strictly between -90 and 90 deg";
        problems.push(Problem::new(format!("{field}.flight_path_deg"), limits.flight_path_deg.to_string(), expected));
    }
    problems
}

fn named(limits: &Limits) -> [(&'static str, Range); 6] {
    [
        ("altitude_m", limits.altitude_m),
        ("speed_mps", limits.speed_mps),
        ("flight_path_deg", limits.flight_path_deg),
        ("n_x", limits.n_x),
        ("n_y", limits.n_y),
        ("n_z", limits.n_z),
    ]
}
