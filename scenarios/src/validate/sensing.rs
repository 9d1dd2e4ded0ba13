//! Can a multirotor stop before what it has only just sensed?

use crate::multirotor::Model;
use crate::{Issue, Scenario};

/// One issue for every model in use whose sensors see too little.
pub(super) fn issues(scenario: &Scenario) -> Vec<Issue> {
    let models = &scenario.models.multirotor;
    let is_used = |name: &&String| scenario.vehicles.iter().any(|vehicle| vehicle.model == **name);
    models.keys().filter(is_used).filter_map(|name| too_short(scenario, name, &models[name])).collect()
}

/// The vehicle goes on for a period and a deadline before it knows, and then brakes; what moves comes towards it meanwhile.
fn too_short(scenario: &Scenario, name: &str, model: &Model) -> Option<Issue> {
    let (limits, planning) = (&model.planning_limits, &scenario.simulation.planning);
    let delay_s = planning.period_s + planning.deadline_s.max(planning.median_s);
    let fastest_mps = scenario.world.moving.iter().map(|moving| moving.speed_mps).fold(0.0, f64::max);
    let braking_s = limits.speed_mps / limits.acceleration_mps2;
    let own_m = limits.stopping_distance_m() + limits.speed_mps * delay_s;
    let needed_m = own_m + fastest_mps * (delay_s + braking_s) + model.body_radius_m;
    (model.sensor_range_m < needed_m).then(|| {
        let expected = format!(
            "{needed_m:.3} m or more: {:.3} m to stop from {} m/s, {:.3} m during a period and a delay of {delay_s} s, the \
             way of what moves meanwhile, and the body's radius",
            limits.stopping_distance_m(),
            limits.speed_mps,
            limits.speed_mps * delay_s,
        );
        Issue::new(format!("models.multirotor.{name}.sensor_range_m"), model.sensor_range_m.to_string(), expected)
            .remedy("look farther, plan slower (planning_limits), or plan more often (simulation.planning)")
    })
}
