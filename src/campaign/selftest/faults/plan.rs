//! Faults of plans of all families.

use scenarios::PlannedEvent;

use super::super::{Fault, ReferenceCase};

/// The faults.
pub fn faults() -> Vec<Fault> {
    vec![
        Fault::new("plan.complete", "the plan is empty", |it| it.plan.trajectories.clear()),
        Fault::new("plan.complete", "a trajectory has no node", |it| truncate(it, 0.0)),
        Fault::new("plan.complete", "a trajectory has states and no times", |it| it.times_s(0).clear()),
        Fault::new("plan.complete", "the plan is for a vehicle of another name", |it| it.edit(0).vehicle().push('?')),
        Fault::new("plan.complete", "a trajectory is duplicated", |it| {
            let twice = it.plan.trajectories[0].clone();
            it.plan.trajectories.push(twice);
        }),
        Fault::new("plan.complete", "planned time goes backwards", |it| {
            let times_s = it.times_s(0);
            times_s[3] = 0.5 * times_s[1];
        }),
        Fault::new("plan.complete", "the plan starts late", |it| it.times_s(0)[0] = 1e-3),
        Fault::new("plan.complete", "planned times in milliseconds", |it| {
            it.scenario.vehicles[0].start.x_m += 1000.0;
            it.times_s(0).iter_mut().for_each(|t_s| *t_s *= 1000.0);
        }),
        Fault::new("plan.goal", "the last quarter of the plan is missing", |it| {
            truncate(it, 0.75);
            let scenario = it.scenario.clone();
            it.fly_in(&scenario);
        }),
        Fault::new("plan.finite", "one planned time is not a number", |it| it.times_s(0)[2] = f64::NAN),
        Fault::new("plan.finite", "the objective is not a number", |it| it.plan.objective = Some(f64::NAN)),
        Fault::new("plan.finite", "the time of a planned event is not a number", |it| {
            it.plan.diagnostics.events.push(PlannedEvent { at_s: f64::NAN, what: "catch".to_owned() });
        }),
        Fault::new("plan.dynamics", "the plan's clock runs 5 % fast", |it| {
            it.times_s(0).iter_mut().for_each(|t_s| *t_s *= 0.95);
        }),
        Fault::new("flight.complete", "the plan was changed after it was flown", |it| {
            it.times_s(0).iter_mut().for_each(|t_s| *t_s *= 1.0 + 1e-6);
        }),
        Fault::new("nodes.goal", "the goal was moved after planning", |it| {
            let goal_m = it.scenario.limits().goal_m;
            it.scenario.vehicles.iter_mut().for_each(|vehicle| vehicle.goal.z_m += 1.5 * goal_m);
        }),
        Fault::new("plan.duration", "the plan takes longer than it may", |it| {
            it.scenario.simulation.max_duration_s = 0.9 * it.plan.flight_time_s().unwrap_or(0.0);
        }),
    ]
}

/// Keeps a fraction of the nodes of every trajectory.
fn truncate(it: &mut ReferenceCase, fraction: f64) {
    for vehicle in 0..it.plan.trajectories.len() {
        let kept = (it.times_s(vehicle).len() as f64 * fraction) as usize;
        it.edit(vehicle).truncate(kept);
    }
}
