//! Obstacles of any shape: sizes, files, and how the files lie in the map.

use super::identifier::entity_names;
use super::quantity::positive;
use crate::world::UPRIGHT_LISTS;
use crate::{Issue, Map, Mesh, Range, Terrain, World};

/// A mesh that is this many times longer than the map is in other units.
const MAX_LENGTH: f64 = 20.0;
/// What a terrain may miss of the map, as a fraction of its width: rounding of the header.
const ROUNDING: f64 = 1e-9;

pub(super) fn issues(world: &World) -> Vec<Issue> {
    let mut issues = Vec::new();
    let lists = world.obstacle_lists();
    let solids = lists.iter().skip(UPRIGHT_LISTS).filter(|(list, _)| *list != "terrain");
    issues.extend(solids.flat_map(|(list, names)| entity_names(&format!("world.{list}"), names.iter().copied())));
    for (index, sphere) in world.spheres.iter().enumerate() {
        issues.extend(positive(&format!("world.spheres[{index}].radius_m"), sphere.radius_m));
    }
    for (index, capsule) in world.capsules.iter().enumerate() {
        issues.extend(positive(&format!("world.capsules[{index}].radius_m"), capsule.radius_m));
    }
    for (index, cuboid) in world.cuboids.iter().enumerate() {
        let size = cuboid.size_m.into_iter().enumerate();
        issues.extend(size.filter_map(|(axis, it)| positive(&format!("world.cuboids[{index}].size_m[{axis}]"), it)));
    }
    issues.extend(world.meshes.iter().enumerate().flat_map(|(index, mesh)| mesh_issues(&world.map, index, mesh)));
    issues.extend(world.terrain.iter().flat_map(|terrain| terrain_issues(&world.map, terrain)));
    issues
}

/// A mesh must reach into the map, and not be so large that it can only be in other units.
fn mesh_issues(map: &Map, index: usize, mesh: &Mesh) -> Vec<Issue> {
    let field = format!("world.meshes[{index}]");
    if let Some(issue) = positive(&format!("{field}.scale"), mesh.scale) {
        return vec![issue];
    }
    let Some(surface) = mesh.surface.get() else { return vec![unread(&field)] };
    let [min_m, max_m] = surface.bounds_m();
    let extents_m: [f64; 3] = std::array::from_fn(|axis| max_m[axis] - min_m[axis]);
    let size = format!("a mesh of {:.3} m x {:.3} m x {:.3} m", extents_m[0], extents_m[1], extents_m[2]);
    let map_m = map.axes().map(|range| range.width()).into_iter().fold(0.0, f64::max);
    if extents_m.into_iter().fold(0.0, f64::max) > MAX_LENGTH * map_m {
        let expected = format!("at most {MAX_LENGTH} times the longest side of the map, {map_m} m");
        let remedy = "give `scale`: 0.001 if the file is in millimetres, 0.0254 if it is in inches";
        return vec![Issue::new(format!("{field}.scale"), size, expected).remedy(remedy)];
    }
    let reaches = |(axis, range): (usize, Range)| min_m[axis] <= range.max && max_m[axis] >= range.min;
    if map.axes().into_iter().enumerate().all(reaches) {
        return Vec::new();
    }
    let corner = |corner: [f64; 3]| format!("({:.3}, {:.3}, {:.3})", corner[0], corner[1], corner[2]);
    let found = format!("{size} from {} m to {} m", corner(min_m), corner(max_m));
    let remedy =
        "move it by `offset_m`, or give `scale`: 0.001 if the file is in millimetres, 1000 if it is in kilometres";
    vec![Issue::new(format!("{field}.offset_m"), found, "a mesh that reaches into the map").remedy(remedy)]
}

/// A terrain must have heights everywhere on the map.
fn terrain_issues(map: &Map, terrain: &Terrain) -> Vec<Issue> {
    let field = "world.terrain";
    let mut issues: Vec<Issue> =
        super::identifier::entity_name(&format!("{field}.name"), &terrain.name).into_iter().collect();
    let Some(grid) = terrain.grid.get() else {
        issues.push(unread(field));
        return issues;
    };
    let extent_m = grid.extent_m();
    let is_covered = |(range, [min_m, max_m]): (Range, [f64; 2])| {
        let rounding_m = ROUNDING * range.width();
        min_m <= range.min + rounding_m && max_m >= range.max - rounding_m
    };
    if ![map.x_m, map.y_m].into_iter().zip(extent_m).all(is_covered) {
        let [x_m, y_m] = extent_m.map(|[min_m, max_m]| format!("[{min_m}, {max_m}]"));
        let found = format!("heights for x in {x_m} m and y in {y_m} m");
        let expected = format!("heights for the whole map, x in {} m and y in {} m", map.x_m, map.y_m);
        let remedy = "move the terrain by `offset_m`, or make the map smaller";
        issues.push(Issue::new(format!("{field}.offset_m"), found, expected).remedy(remedy));
    } else if let Some([x_m, y_m]) = grid.gap_m([map.x_m.min, map.x_m.max], [map.y_m.min, map.y_m.max]) {
        let found = format!("no height at ({x_m}, {y_m}) m");
        let remedy = "fill the gap in the file, or make the map smaller";
        issues.push(Issue::new(format!("{field}.file"), found, "heights everywhere on the map").remedy(remedy));
    }
    issues
}

fn unread(field: &str) -> Issue {
    Issue::new(format!("{field}.file"), "a file that has not been read", "the content of the file")
        .remedy("load the scenario from its file, which reads the others")
}
