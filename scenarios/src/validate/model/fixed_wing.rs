//! Fixed-wing models: each limit in itself, and the planning limits inside the physical ones.

use crate::fixed_wing::{Limits, Model};
use crate::validate::identifier::entity_name;
use crate::validate::quantity::{ordered, positive};
use crate::{Issue, Range};

use super::planning_inside_physical;

pub(super) fn issues(name: &str, model: &Model) -> Vec<Issue> {
    let field = format!("models.fixed-wing.{name}");
    let mut issues = Vec::new();
    issues.extend(entity_name(&field, name));
    issues.extend(positive(&format!("{field}.mass_kg"), model.mass_kg));
    issues.extend(positive(&format!("{field}.body_radius_m"), model.body_radius_m));
    issues.extend(limits(&format!("{field}.limits"), &model.limits));
    issues.extend(limits(&format!("{field}.planning_limits"), &model.planning_limits));
    issues.extend(planning_inside_physical(&field, named(&model.planning_limits), named(&model.limits)));
    issues
}

fn limits(field: &str, limits: &Limits) -> Vec<Issue> {
    let mut issues = Vec::new();
    for (name, range) in named(limits) {
        issues.extend(ordered(&format!("{field}.{name}"), range));
    }
    if limits.speed_mps.min <= 0.0 {
        let expected = "a least speed greater than 0: a fixed wing can't hover";
        issues.push(Issue::new(format!("{field}.speed_mps"), limits.speed_mps.to_string(), expected));
    }
    if limits.flight_path_deg.min <= -90.0 || limits.flight_path_deg.max >= 90.0 {
        let expected = "both ends strictly between -90 and 90 deg";
        issues.push(Issue::new(format!("{field}.flight_path_deg"), limits.flight_path_deg.to_string(), expected));
    }
    issues
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
