//! The map and its obstacles.

use super::identifier::entity_names;
use super::quantity::{ordered, positive};
use crate::{Block, Prism, Problem, World};

pub(super) fn problems(world: &World) -> Vec<Problem> {
    let mut problems = Vec::new();
    problems.extend(ordered("world.map.x_m", world.map.x_m));
    problems.extend(ordered("world.map.y_m", world.map.y_m));
    problems.extend(ordered("world.map.z_m", world.map.z_m));
    problems.extend(entity_names("world.cylinders", world.cylinders.iter().map(|cylinder| cylinder.name.as_str())));
    for (index, cylinder) in world.cylinders.iter().enumerate() {
        problems.extend(positive(&format!("world.cylinders[{index}].radius_m"), cylinder.radius_m));
    }
    problems.extend(entity_names("world.boxes", world.boxes.iter().map(|block| block.name.as_str())));
    problems.extend(world.boxes.iter().enumerate().flat_map(|(index, block)| of_box(index, block)));
    problems.extend(entity_names("world.prisms", world.prisms.iter().map(|prism| prism.name.as_str())));
    problems.extend(world.prisms.iter().enumerate().flat_map(|(index, prism)| of_prism(index, prism)));
    problems.extend(names_of_two_kinds(world));
    problems
}

fn of_box(index: usize, block: &Block) -> Vec<Problem> {
    let field = format!("world.boxes[{index}]");
    let [length_m, width_m] = block.size_m;
    let sizes = [positive(&format!("{field}.size_m[0]"), length_m), positive(&format!("{field}.size_m[1]"), width_m)];
    let z_m = block.z_m.and_then(|range| ordered(&format!("{field}.z_m"), range));
    sizes.into_iter().flatten().chain(z_m).collect()
}

fn of_prism(index: usize, prism: &Prism) -> Vec<Problem> {
    let field = format!("world.prisms[{index}]");
    let shape = (!prism.is_convex()).then(|| {
        let found = format!("{} corners that make no convex polygon", prism.corners_m.len());
        Problem::new(format!("{field}.corners_m"), found, "the corners of a convex polygon in order, three at least")
            .remedy("list the corners in the order in which the edge passes them; split what is not convex")
    });
    let z_m = prism.z_m.and_then(|range| ordered(&format!("{field}.z_m"), range));
    shape.into_iter().chain(z_m).collect()
}

/// A name that obstacles of two kinds share. (Within one kind it is reported with the kind.)
fn names_of_two_kinds(world: &World) -> Vec<Problem> {
    let kinds: [(&str, Vec<&str>); 3] = [
        ("world.cylinders", world.cylinders.iter().map(|cylinder| cylinder.name.as_str()).collect()),
        ("world.boxes", world.boxes.iter().map(|block| block.name.as_str()).collect()),
        ("world.prisms", world.prisms.iter().map(|prism| prism.name.as_str()).collect()),
    ];
    let mut problems = Vec::new();
    for (later, (kind, names)) in kinds.iter().enumerate() {
        for (index, name) in names.iter().enumerate() {
            if let Some((earlier, _)) = kinds[..later].iter().find(|(_, others)| others.contains(name)) {
                let expected = format!("a name of its own; an obstacle in {earlier} has this one already");
                problems.push(
                    Problem::new(format!("{kind}[{index}].name"), format!("\"{name}\""), expected)
                        .remedy("rename one of the two"),
                );
            }
        }
    }
    problems
}
