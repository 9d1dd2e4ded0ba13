//! The plan flown open loop, where that does not end at the plan's end.

use scenarios::fixed_wing::Trajectory;
use sim::fixed_wing::rollout;

use super::super::{Lines, Paint, Scene, colours, distance_m, is_finite};
use crate::output::run::JudgedRun;
use crate::verdict::is_flyable;

/// Step of the integration, s.
const STEP_S: f64 = 0.1;
/// Points of the drawn path: one of so many steps.
const STEPS_PER_POINT: usize = 5;
/// Width of the gap below which the planned path says it all, as a fraction of the tolerance of `plan.rollout`.
const NEGLIGIBLE: f64 = 0.2;

/// Adds the path of every vehicle that ends elsewhere, and the distance by which it misses.
pub(super) fn add(scene: &mut Scene<'_>, run: &JudgedRun<'_>) {
    if is_flyable(run.scenario, run.plan).is_err() {
        return;
    }
    let negligible_m = NEGLIGIBLE * run.scenario.limits().rollout_m;
    let mut is_drawn = false;
    for trajectory in run.plan.trajectories.iter().map(scenarios::Trajectory::fixed_wing) {
        let Some((path_m, gap_m)) = path(trajectory).filter(|(_, gap_m)| *gap_m > negligible_m) else { continue };
        let line = Lines::new(vec![path_m], Paint::opaque(colours::OPEN_LOOP), 0.9)
            .labelled(format!("{} open loop: {gap_m:.0} m off", trajectory.vehicle), false);
        scene.add_item(&["open_loop", &trajectory.vehicle], line);
        is_drawn = true;
    }
    if is_drawn {
        scene.legend.push("- pink line: the plan's controls flown open loop, in air at rest".to_owned());
    }
}

/// The path, m, and the distance of its end from the last node, m.
fn path(trajectory: &Trajectory) -> Option<(Vec<[f64; 3]>, f64)> {
    let last = trajectory.states.last()?;
    let knots = rollout(trajectory, STEP_S);
    let end_m = knots.last()?.position_m.into();
    let gap_m = distance_m([last.x_m, last.y_m, last.z_m], end_m);
    let inner = knots.iter().step_by(STEPS_PER_POINT).map(|knot| knot.position_m.into());
    let path_m: Vec<[f64; 3]> = inner.chain([end_m]).filter(is_finite).collect();
    gap_m.is_finite().then_some((path_m, gap_m))
}
