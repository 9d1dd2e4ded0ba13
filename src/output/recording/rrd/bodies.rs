//! Bodies: their parts, and their poses over time.

use rerun::components::Translation3D;
use rerun::{EntityPath, EntityPathPart, Quaternion, RecordingStream, Transform3D};

use super::shapes::{archetype, world_path};
use super::{Logged, SIM_TIME, sim_times, to_f32};
use crate::output::scene::{Body, Part, Pose};

/// Logs every body.
pub fn log(stream: &RecordingStream, bodies: &[Body<'_>]) -> Logged {
    bodies.iter().try_for_each(|body| log_body(stream, body))
}

/// The position moves the body, the attitude only the parts that rotate with it.
///
/// Shapes do not change, but are not static: on the planner's timeline, which has no poses, all of them would stand at the
/// origin.
fn log_body(stream: &RecordingStream, body: &Body<'_>) -> Logged {
    let path = world_path(&body.path);
    stream.set_duration_secs(SIM_TIME, 0.0);
    for part in &body.parts {
        stream.log(part_path(&path, part), archetype(&part.shape)?.as_ref())?;
    }
    stream.reset_time();
    let poses = (body.poses)(body.interval_s);
    let times = || sim_times(poses.iter().map(|pose| pose.t_s));
    let positions = poses.iter().map(|pose| Translation3D::from(to_f32(pose.position_m)));
    let translations = Transform3D::update_fields().with_many_translation(positions).columns_of_unit_batches()?;
    stream.send_columns(path.clone(), [times()], translations)?;
    for part in body.parts.iter().filter(|part| part.rotates) {
        let attitude = |pose: &Pose| Quaternion::from_xyzw(to_f32(pose.world_from_body));
        let rotations = Transform3D::update_fields().with_many_quaternion(poses.iter().map(attitude));
        stream.send_columns(part_path(&path, part), [times()], rotations.columns_of_unit_batches()?)?;
    }
    Ok(())
}

fn part_path(body: &EntityPath, part: &Part) -> EntityPath {
    if part.name.is_empty() { body.clone() } else { body.clone() / EntityPathPart::new(part.name) }
}
