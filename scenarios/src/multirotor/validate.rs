//! Validation of multirotor models: quantities and limits, thrust to hover, sensor range to stop.

mod waypoint;

use super::{Airframe, GRAVITY_MPS2, Limits, Model, Plant};
use crate::validate::planning_inside_physical;
use crate::validate::quantity::{above_up_to, not_negative, ordered, positive, positive_if_given};
use crate::{Issue, Range, Scenario};

pub(super) use waypoint::issues as waypoint;

pub(super) fn model(field: &str, model: &Model) -> Vec<Issue> {
    let positive_quantities = [
        ("mass_kg", model.mass_kg),
        ("body_radius_m", model.body_radius_m),
        ("sensor_range_m", model.sensor_range_m),
        ("limits.speed_mps", model.limits.speed_mps),
        ("limits.acceleration_mps2", model.limits.acceleration_mps2),
        ("planning_limits.speed_mps", model.planning_limits.speed_mps),
        ("planning_limits.acceleration_mps2", model.planning_limits.acceleration_mps2),
    ];
    let mut issues: Vec<Issue> = Vec::new();
    issues.extend(
        positive_quantities.into_iter().filter_map(|(name, value)| positive(&format!("{field}.{name}"), value)),
    );
    issues.extend(not_negative(&format!("{field}.drag_area_m2"), model.drag_area_m2));
    issues.extend(planning_inside_physical(field, named(&model.planning_limits), named(&model.limits)));
    issues.extend(missing_airframe(field, model));
    issues.extend(model.airframe.iter().flat_map(|airframe| airframe_issues(&format!("{field}.airframe"), airframe)));
    issues.extend(model.airframe.as_ref().and_then(|airframe| thrust_range(field, model, airframe)));
    issues
}

fn missing_airframe(field: &str, model: &Model) -> Option<Issue> {
    (model.plant == Plant::Quadrotor && model.airframe.is_none()).then(|| {
        let expected = "a table with inertia, lever arm and thrusts, since the plant is a quadrotor";
        Issue::new(format!("{field}.airframe"), "nothing", expected).remedy("add it, or use the plant `point-mass`")
    })
}

fn airframe_issues(field: &str, airframe: &Airframe) -> Vec<Issue> {
    let [ix, iy, iz] = airframe.inertia_kgm2;
    let positive_quantities = [
        ("inertia_kgm2[0]", ix),
        ("inertia_kgm2[1]", iy),
        ("inertia_kgm2[2]", iz),
        ("arm_m", airframe.arm_m),
        ("torque_per_thrust_m", airframe.torque_per_thrust_m),
    ];
    let positive_quantities =
        positive_quantities.into_iter().filter_map(|(name, value)| positive(&format!("{field}.{name}"), value));
    let others = [
        positive_if_given(&format!("{field}.rotor_time_constant_s"), airframe.rotor_time_constant_s),
        ordered(&format!("{field}.thrust_n"), airframe.thrust_n),
        not_negative(&format!("{field}.thrust_n"), airframe.thrust_n.min),
        above_up_to(&format!("{field}.tilt_deg"), airframe.tilt_deg, 0.0, 80.0),
    ];
    positive_quantities.chain(others.into_iter().flatten()).collect()
}

/// The four rotors must carry the weight while tilted for the planned acceleration.
fn thrust_range(field: &str, model: &Model, airframe: &Airframe) -> Option<Issue> {
    let hover_n = model.mass_kg * GRAVITY_MPS2 / 4.0;
    let needed_n = model.mass_kg * GRAVITY_MPS2.hypot(model.planning_limits.acceleration_mps2) / 4.0;
    let Range { min, max } = airframe.thrust_n;
    (min < max && !(min < hover_n && needed_n < max)).then(|| {
        let expected = format!(
            "a range from below {hover_n:.3} N, in hover, to above {needed_n:.3} N, at the planned acceleration"
        );
        Issue::new(format!("{field}.airframe.thrust_n"), airframe.thrust_n.to_string(), expected)
            .remedy("increase the thrust, or reduce the planned acceleration")
    })
}

fn named(limits: &Limits) -> [(&'static str, Range); 2] {
    [("speed_mps", Range::new(0.0, limits.speed_mps)), ("acceleration_mps2", Range::new(0.0, limits.acceleration_mps2))]
}

/// Models in use whose sensor range is too short to stop before an obstacle.
pub(super) fn sensing(scenario: &Scenario) -> Vec<Issue> {
    let models = &scenario.models.multirotor;
    let is_used = |name: &&String| scenario.vehicles.iter().any(|vehicle| vehicle.model == **name);
    models.keys().filter(is_used).filter_map(|name| too_short(scenario, name, &models[name])).collect()
}

/// The vehicle reacts after a period and a deadline, and then brakes, while moving obstacles approach.
fn too_short(scenario: &Scenario, name: &str, model: &Model) -> Option<Issue> {
    let (limits, planning) = (&model.planning_limits, &scenario.simulation.planning);
    let delay_s = planning.period_s + planning.deadline_s.max(planning.median_s);
    let max_obstacle_mps = scenario.world.moving.iter().map(|moving| moving.speed_mps).fold(0.0, f64::max);
    let braking_s = limits.speed_mps / limits.acceleration_mps2;
    let own_m = limits.stopping_distance_m() + limits.speed_mps * delay_s;
    let needed_m = own_m + max_obstacle_mps * (delay_s + braking_s) + model.body_radius_m;
    (model.sensor_range_m < needed_m).then(|| {
        let expected = format!(
            "{needed_m:.3} m or more: {:.3} m to brake from {} m/s, {:.3} m during the reaction time of {delay_s} s, the \
             distance that moving obstacles cover meanwhile, and the body radius",
            limits.stopping_distance_m(),
            limits.speed_mps,
            limits.speed_mps * delay_s,
        );
        Issue::new(format!("models.multirotor.{name}.sensor_range_m"), model.sensor_range_m.to_string(), expected)
            .remedy("increase the sensor range, reduce planning_limits.speed_mps, or replan more often (simulation.planning)")
    })
}
