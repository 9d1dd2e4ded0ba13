//! Map, obstacles, gates and geofences.

use super::identifier::entity_names;
use super::quantity::{not_negative, ordered, positive};
use crate::world::is_simple;
use crate::{BoxObstacle, Gate, Geofence, Issue, MovingCylinder, Prism, World, closest_name};

pub(super) fn issues(world: &World) -> Vec<Issue> {
    let mut issues = Vec::new();
    issues.extend(ordered("world.map.x_m", world.map.x_m));
    issues.extend(ordered("world.map.y_m", world.map.y_m));
    issues.extend(ordered("world.map.z_m", world.map.z_m));
    issues.extend(world.origin.as_ref().and_then(crate::load::geographic::origin_issues));
    issues.extend(entity_names("world.cylinders", world.cylinders.iter().map(|cylinder| cylinder.name.as_str())));
    for (index, cylinder) in world.cylinders.iter().enumerate() {
        issues.extend(positive(&format!("world.cylinders[{index}].radius_m"), cylinder.radius_m));
    }
    issues.extend(entity_names("world.boxes", world.boxes.iter().map(|block| block.name.as_str())));
    issues.extend(world.boxes.iter().enumerate().flat_map(|(index, block)| box_issues(index, block)));
    issues.extend(entity_names("world.prisms", world.prisms.iter().map(|prism| prism.name.as_str())));
    issues.extend(world.prisms.iter().enumerate().flat_map(|(index, prism)| prism_issues(index, prism)));
    issues.extend(entity_names("world.moving", world.moving.iter().map(|moving| moving.name.as_str())));
    issues.extend(world.moving.iter().enumerate().flat_map(|(index, moving)| moving_issues(index, moving)));
    issues.extend(entity_names("world.gates", world.gates.iter().map(|gate| gate.name.as_str())));
    issues.extend(world.gates.iter().enumerate().flat_map(|(index, gate)| gate_issues(index, gate)));
    issues.extend(entity_names("world.geofences", world.geofences.iter().map(|fence| fence.name.as_str())));
    issues.extend(world.geofences.iter().enumerate().flat_map(|(index, fence)| geofence_issues(index, fence)));
    issues.extend(super::solids::issues(world));
    issues.extend(names_in_two_lists(world));
    issues.extend(world.hidden.iter().enumerate().filter_map(|(index, name)| unknown_hidden(world, index, name)));
    issues
}

fn moving_issues(index: usize, moving: &MovingCylinder) -> Vec<Issue> {
    let field = format!("world.moving[{index}]");
    let path = (!moving.has_path()).then(|| {
        let found = format!("{} corners, or two successive corners at the same point", moving.path_m.len());
        Issue::new(format!("{field}.path_m"), found, "at least two corners, each different from the one before")
    });
    let rules = [
        positive(&format!("{field}.radius_m"), moving.radius_m),
        not_negative(&format!("{field}.speed_mps"), moving.speed_mps),
        not_negative(&format!("{field}.offset_m"), moving.offset_m),
        moving.z_m.and_then(|range| ordered(&format!("{field}.z_m"), range)),
    ];
    rules.into_iter().flatten().chain(path).collect()
}

/// The name of a hidden obstacle must exist.
fn unknown_hidden(world: &World, index: usize, name: &str) -> Option<Issue> {
    let names: Vec<&str> = world.names_that_may_be_hidden().collect();
    let expected = "the name of a cylinder, a box or a prism, or \"*\" for all of them";
    let issue = Issue::new(format!("world.hidden[{index}]"), format!("\"{name}\""), expected);
    let is_known = name == "*" || names.contains(&name);
    (!is_known).then(|| match closest_name(name, names) {
        Some(known) => issue.remedy(format!("did you mean \"{known}\"?")),
        None => issue.remedy("moving obstacles are always sensed; obstacles of other shapes are always known"),
    })
}

fn box_issues(index: usize, block: &BoxObstacle) -> Vec<Issue> {
    let field = format!("world.boxes[{index}]");
    let [length_m, width_m] = block.size_m;
    let sizes = [positive(&format!("{field}.size_m[0]"), length_m), positive(&format!("{field}.size_m[1]"), width_m)];
    let z_m = block.z_m.and_then(|range| ordered(&format!("{field}.z_m"), range));
    sizes.into_iter().flatten().chain(z_m).collect()
}

fn gate_issues(index: usize, gate: &Gate) -> Vec<Issue> {
    let windows = [("quadrotor", &gate.quadrotor), ("load", &gate.load)];
    let faces = windows.into_iter().flat_map(|(whose, window)| {
        let named = ["x_m", "y_m", "z_m"].into_iter().zip(window.axes());
        named.filter_map(move |(axis, range)| ordered(&format!("world.gates[{index}].{whose}.{axis}"), range?))
    });
    let is_unbounded = windows.iter().all(|(_, window)| window.axes().iter().all(Option::is_none));
    let unbounded = is_unbounded.then(|| {
        let expected = "at least one of x_m, y_m, z_m in `quadrotor` or `load`";
        Issue::new(format!("world.gates[{index}]"), "two windows without a face", expected)
            .remedy("bound a window, or remove the gate: every motion passes it")
    });
    faces.chain(unbounded).collect()
}

fn geofence_issues(index: usize, fence: &Geofence) -> Vec<Issue> {
    let field = format!("world.geofences[{index}]");
    let shape = (!fence.is_simple()).then(|| {
        let remedy = "list the corners in order along the boundary, each once, without repeating the first at the end";
        let issue = if is_simple(&fence.polygon_m) {
            let expected = "rings of at least three corners each that meet neither each other nor `polygon_m`";
            Issue::new(format!("{field}.rings_m"), "edges that cross, touch or fold back", expected)
        } else {
            let found = format!("{} corners whose edges cross, touch or fold back", fence.polygon_m.len());
            Issue::new(format!("{field}.polygon_m"), found, "at least three corners of a simple polygon, in order")
        };
        issue.remedy(remedy)
    });
    let z_m = fence.z_m.and_then(|range| ordered(&format!("{field}.z_m"), range));
    shape.into_iter().chain(z_m).collect()
}

fn prism_issues(index: usize, prism: &Prism) -> Vec<Issue> {
    let field = format!("world.prisms[{index}]");
    let shape = (!prism.is_convex()).then(|| {
        let found = format!("{} corners that do not form a convex polygon", prism.corners_m.len());
        Issue::new(format!("{field}.corners_m"), found, "at least three corners of a convex polygon, in order")
            .remedy("list the corners in order along the boundary; split a polygon that is not convex")
    });
    let z_m = prism.z_m.and_then(|range| ordered(&format!("{field}.z_m"), range));
    shape.into_iter().chain(z_m).collect()
}

/// Names shared by obstacles of two kinds. Duplicates within one kind are reported with that kind.
fn names_in_two_lists(world: &World) -> Vec<Issue> {
    let kinds = world.obstacle_lists().map(|(list, names)| (format!("world.{list}"), names));
    let mut issues = Vec::new();
    for (later, (kind, names)) in kinds.iter().enumerate() {
        let field = |index| if kind == "world.terrain" { kind.clone() } else { format!("{kind}[{index}]") };
        for (index, name) in names.iter().enumerate() {
            if let Some((earlier, _)) = kinds[..later].iter().find(|(_, others)| others.contains(name)) {
                let expected = format!("a unique name; an obstacle in {earlier} has the same");
                issues.push(
                    Issue::new(format!("{}.name", field(index)), format!("\"{name}\""), expected)
                        .remedy("rename one of them"),
                );
            }
        }
    }
    issues
}
