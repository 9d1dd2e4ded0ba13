//! Bodies: their parts, fixed to frames, and the transforms of the frames over time.

use std::sync::Arc;

use foxglove::messages::{FrameTransform, FrameTransforms, Quaternion, SceneEntity, SceneUpdate, Vector3};
use foxglove::{Channel, Context};

use super::shapes::{Artist, update};
use super::{INTERVAL_S, WORLD, channel, timestamp};
use crate::output::scene::{Body, BodyKind, Part, Pose};

/// Logs parts (once) and transforms.
pub fn log(context: &Arc<Context>, bodies: &[Body<'_>], artist: &Artist) {
    for (kind, topic) in [(BodyKind::Vehicle, "/fleet"), (BodyKind::Obstacle, "/moving"), (BodyKind::Ghost, "/ghost")] {
        let of_kind = bodies.iter().filter(|body| body.kind == kind);
        let entities: Vec<SceneEntity> = of_kind.flat_map(|body| entities(body, artist)).collect();
        if !entities.is_empty() {
            let topic: Channel<SceneUpdate> = channel(context, topic);
            topic.log_with_time(&update(entities), timestamp(0.0));
        }
    }
    log_transforms(context, bodies);
}

/// One entity for the parts that rotate with the body, and one for those that stay upright. Its id is the name of its frame.
fn entities(body: &Body<'_>, artist: &Artist) -> Vec<SceneEntity> {
    let entity = |frame: String, rotate: bool| {
        let mut parts = body.parts.iter().filter(|part| part.rotates == rotate).peekable();
        parts.peek()?;
        let mut entity = SceneEntity {
            timestamp: Some(timestamp(0.0)),
            frame_id: frame.clone(),
            id: frame,
            frame_locked: true,
            ..SceneEntity::default()
        };
        parts.for_each(|part| artist.add(&mut entity, &part.shape));
        Some(entity)
    };
    if is_rotating(body) {
        [entity(body.frame.clone(), true), entity(upright(body), false)].into_iter().flatten().collect()
    } else {
        entity(body.frame.clone(), false).into_iter().collect()
    }
}

/// One message for each time, with all bodies that have a pose then.
fn log_transforms(context: &Arc<Context>, bodies: &[Body<'_>]) {
    let mut transforms: Vec<(f64, FrameTransform)> = bodies.iter().flat_map(of_body).collect();
    transforms.sort_by(|(a_s, _), (b_s, _)| a_s.total_cmp(b_s)); // stable: bodies stay in their order
    let topic: Channel<FrameTransforms> = channel(context, "/tf");
    for group in transforms.chunk_by(|(a_s, _), (b_s, _)| timestamp(*a_s) == timestamp(*b_s)) {
        let message = FrameTransforms { transforms: group.iter().map(|(_, transform)| transform.clone()).collect() };
        topic.log_with_time(&message, timestamp(group[0].0));
    }
}

fn of_body(body: &Body<'_>) -> Vec<(f64, FrameTransform)> {
    let has_upright_parts = is_rotating(body) && body.parts.iter().any(|part| !part.rotates);
    let of_pose = |pose: Pose| {
        let own = transform(&body.frame, pose);
        let upright = || transform(&upright(body), Pose { world_from_body: Pose::UPRIGHT, ..pose });
        [Some(own), has_upright_parts.then(upright)].into_iter().flatten().map(move |transform| (pose.t_s, transform))
    };
    (body.poses)(INTERVAL_S).into_iter().flat_map(of_pose).collect()
}

fn is_rotating(body: &Body<'_>) -> bool {
    body.parts.iter().any(|part: &Part| part.rotates)
}

/// The frame that follows the position of a body, but not its attitude.
fn upright(body: &Body<'_>) -> String {
    format!("{}/upright", body.frame)
}

fn transform(frame: &str, Pose { t_s, position_m: [x, y, z], world_from_body }: Pose) -> FrameTransform {
    let [qx, qy, qz, qw] = world_from_body;
    FrameTransform {
        timestamp: Some(timestamp(t_s)),
        parent_frame_id: WORLD.to_owned(),
        child_frame_id: frame.to_owned(),
        translation: Some(Vector3 { x, y, z }),
        rotation: Some(Quaternion { x: qx, y: qy, z: qz, w: qw }),
    }
}
