//! Start and goal of a fixed wing against its planning limits.

use crate::fixed_wing::Model;
use crate::validate::quantity::inside;
use crate::{Issue, Waypoint};

pub(super) fn issues(model: &Model, field: &str, waypoint: &Waypoint) -> Vec<Issue> {
    let limits = &model.planning_limits;
    let quantities = [
        ("z_m", waypoint.z_m, limits.altitude_m, "the planning limits of altitude, m"),
        ("speed_mps", waypoint.speed_mps, limits.speed_mps, "the planning limits of speed, m/s"),
        (
            "flight_path_deg",
            waypoint.flight_path_deg,
            limits.flight_path_deg,
            "the planning limits of climb angle, deg",
        ),
    ];
    let check = |(name, value, range, of)| inside(&format!("{field}.{name}"), value, range, of);
    let load = waypoint.load.map(|_| {
        Issue::new(format!("{field}.load"), "a load", "nothing: a fixed wing carries none").remedy("remove it")
    });
    quantities.into_iter().filter_map(check).chain(load).collect()
}
