//! The map and its obstacles.

use super::identifier::entity_names;
use super::quantity::{ordered, positive};
use crate::{Problem, World};

pub(super) fn problems(world: &World) -> Vec<Problem> {
    let mut problems = Vec::new();
    problems.extend(ordered("world.map.x_m", world.map.x_m));
    problems.extend(ordered("world.map.y_m", world.map.y_m));
    problems.extend(ordered("world.map.z_m", world.map.z_m));
    problems.extend(entity_names("world.cylinders", world.cylinders.iter().map(|cylinder| cylinder.name.as_str())));
    for (index, cylinder) in world.cylinders.iter().enumerate() {
        problems.extend(positive(&format!("world.cylinders[{index}].radius_m"), cylinder.radius_m));
    }
    problems
}
