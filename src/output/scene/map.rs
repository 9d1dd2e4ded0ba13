//! What a scenario fixes in space: the map with its ground grid, gates, geofences, starts, goals and via-points.

use scenarios::{GeofenceKind, Map, Range, Scenario, Window, World};

use super::{BoxOutline, Label, Lines, Paint, Points, Radius, Scene, colours};

/// Largest number of lines of the ground grid in one direction; its spacing grows to keep to it.
const MAX_GRID_LINES: f64 = 12.0;
/// Width of a label as a fraction of the map's width.
const LABEL_WIDTH: f64 = 0.06;
/// Radius of the points at starts and goals, points on the screen.
const END_RADIUS: f32 = 4.0;

/// Adds all of it.
pub(super) fn add(scene: &mut Scene<'_>, scenario: &Scenario) {
    add_map(scene, &scenario.world.map);
    if let Some(ground_m) = scenario.world.ground_m {
        add_ground(scene, &scenario.world.map, ground_m);
    }
    add_gates(scene, &scenario.world);
    add_geofences(scene, &scenario.world);
    add_ends(scene, scenario);
    add_via_points(scene, scenario);
}

fn add_map(scene: &mut Scene<'_>, map: &Map) {
    let [x, y, z] = map.axes();
    let outline = BoxOutline {
        centre_m: [x, y, z].map(middle),
        half_size_m: [x, y, z].map(|axis| axis.width() / 2.0),
        paint: Paint::opaque(colours::MAP),
        radius: 0.7,
        label: None,
    };
    scene.add_item(&["map", "outline"], outline);

    let spacing_m = grid_spacing_m(map);
    let meridians = grid_positions(x, spacing_m).map(|east| vec![[east, y.min, z.min], [east, y.max, z.min]]);
    let parallels = grid_positions(y, spacing_m).map(|north| vec![[x.min, north, z.min], [x.max, north, z.min]]);
    let grid = Lines::new(meridians.chain(parallels).collect(), Paint::opaque(colours::GRID), 0.5);
    scene.add_item(&["map", "grid"], grid);

    let axes = Points {
        positions_m: vec![[x.max, y.min, z.min], [x.min, y.max, z.min]],
        paints: vec![Paint::opaque(colours::MAP)],
        radius: Radius::Screen(0.0),
        labels: vec![format!("east (x), grid {spacing_m:.0} m"), "north (y)".to_owned()],
        are_labels_shown: true,
    };
    scene.add_item(&["map", "axes"], axes);
}

/// The level ground as a rectangle below the whole map.
fn add_ground(scene: &mut Scene<'_>, map: &Map, ground_m: f64) {
    let (x, y) = (map.x_m, map.y_m);
    let corners = [[x.min, y.min], [x.max, y.min], [x.max, y.max], [x.min, y.max], [x.min, y.min]];
    let outline = corners.map(|[x, y]| [x, y, ground_m]).to_vec();
    let ground = Lines::new(vec![outline], Paint::opaque(colours::OBSTACLE), 0.7).labelled("ground", false);
    scene.add_item(&["map", "ground"], ground);
}

/// The windows of gates; along axes without faces they extend over the whole map.
fn add_gates(scene: &mut Scene<'_>, world: &World) {
    let faces = |window: &Window| {
        let [x, y, z] = world.map.axes();
        let [own_x, own_y, own_z] = window.axes();
        [own_x.unwrap_or(x), own_y.unwrap_or(y), own_z.unwrap_or(z)]
    };
    for gate in &world.gates {
        for (whose, window) in [("quadrotor", &gate.quadrotor), ("load", &gate.load)] {
            let faces = faces(window);
            let outline = BoxOutline {
                centre_m: faces.map(middle),
                half_size_m: faces.map(|axis| axis.width() / 2.0),
                paint: Paint::opaque(colours::KEPT),
                radius: 1.0,
                label: Some(Label { text: format!("{}: {whose}", gate.name), is_shown: false }),
            };
            scene.add_item(&["gates", &gate.name, whose], outline);
        }
    }
}

/// The edges of geofences; without lowest and highest altitude they extend from the floor to the ceiling of the map.
fn add_geofences(scene: &mut Scene<'_>, world: &World) {
    for fence in &world.geofences {
        let z = fence.z_m.unwrap_or(world.map.z_m);
        let level =
            |ring: &[[f64; 2]], z: f64| ring.iter().chain(ring.first()).map(|&[x, y]| [x, y, z]).collect::<Vec<_>>();
        let posts =
            |ring: &[[f64; 2]]| ring.iter().map(|&[x, y]| vec![[x, y, z.min], [x, y, z.max]]).collect::<Vec<_>>();
        let edges = fence.rings().flat_map(|ring| [vec![level(ring, z.min), level(ring, z.max)], posts(ring)].concat());
        let edges = edges.collect();
        let colour = match fence.kind {
            GeofenceKind::StayIn => colours::MAP,
            GeofenceKind::KeepOut => colours::OBSTACLE,
        };
        let outline = Lines::new(edges, Paint::opaque(colour), 1.4).labelled(fence.name.as_str(), false);
        scene.add_item(&["geofences", &fence.name], outline);
    }
}

/// Points at the starts (dim) and at the goals (bright). Labels of starts are hidden, since the vehicle with its own label
/// is there at time 0; those of goals are hidden if they would overlap.
fn add_ends(scene: &mut Scene<'_>, scenario: &Scenario) {
    let vehicles = &scenario.vehicles;
    let vehicle_colours = || (0..vehicles.len()).map(|index| colours::vehicle(index, vehicles.len()));
    let starts = Points {
        positions_m: vehicles.iter().map(|vehicle| vehicle.start.position_m()).collect(),
        paints: vehicle_colours().map(|colour| Paint::opaque(colours::dimmed(colour))).collect(),
        radius: Radius::Screen(END_RADIUS),
        labels: vehicles.iter().map(|vehicle| format!("start {}", vehicle.name)).collect(),
        are_labels_shown: false,
    };
    scene.add_item(&["ends", "starts"], starts);
    let goals = Points {
        positions_m: vehicles.iter().map(|vehicle| vehicle.goal.position_m()).collect(),
        paints: vehicle_colours().map(Paint::opaque).collect(),
        radius: Radius::Screen(END_RADIUS),
        labels: vehicles.iter().map(|vehicle| format!("goal {}", vehicle.name)).collect(),
        are_labels_shown: is_roomy(scenario),
    };
    scene.add_item(&["ends", "goals"], goals);
}

/// The balls of via-points, numbered in their order.
fn add_via_points(scene: &mut Scene<'_>, scenario: &Scenario) {
    let count = scenario.vehicles.len();
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        for (number, via) in (1..).zip(&vehicle.via) {
            let ball = Points {
                positions_m: vec![via.position_m()],
                paints: vec![Paint::translucent(colours::vehicle(index, count), 0.7)],
                radius: Radius::World(via.radius_m),
                labels: vec![format!("{} via {number}", vehicle.name)],
                are_labels_shown: false,
            };
            scene.add_item(&["via", &vehicle.name, &number.to_string()], ball);
        }
    }
}

/// Is there room for a label at every goal when the whole map is in view?
fn is_roomy(scenario: &Scenario) -> bool {
    let label_m = LABEL_WIDTH * scenario.world.map.x_m.width();
    let goals_m: Vec<_> = scenario.vehicles.iter().map(|vehicle| vehicle.goal.position_m()).collect();
    let distance_m = |a: &[f64; 3], b: &[f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]);
    goals_m.iter().enumerate().all(|(i, a)| goals_m[..i].iter().all(|b| distance_m(a, b) > label_m))
}

pub(super) fn middle(range: Range) -> f64 {
    f64::midpoint(range.min, range.max)
}

/// The finest of 1, 2, 5, 10 ... m that needs no more than [`MAX_GRID_LINES`] lines.
fn grid_spacing_m(map: &Map) -> f64 {
    let width_m = map.x_m.width().max(map.y_m.width());
    let spacings = (0..9).flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| digit * 10_f64.powi(decade)));
    spacings.into_iter().find(|spacing| width_m / spacing <= MAX_GRID_LINES).unwrap_or(1e9)
}

/// Multiples of `spacing_m` inside `range`; at most [`MAX_GRID_LINES`] and one, also if the range is not finite.
fn grid_positions(range: Range, spacing_m: f64) -> impl Iterator<Item = f64> {
    let (first, last) = ((range.min / spacing_m).ceil() as i64, (range.max / spacing_m).floor() as i64);
    let max = MAX_GRID_LINES as usize + 1;
    (first..=last).take(max).map(move |multiple| multiple as f64 * spacing_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_grid_fits_the_map() {
        let map = Map { x_m: Range::new(-500.0, 8500.0), y_m: Range::new(0.0, 4200.0), z_m: Range::new(0.0, 600.0) };
        assert_eq!(grid_spacing_m(&map), 1000.0);
        assert_eq!(
            grid_positions(map.x_m, 1000.0).collect::<Vec<_>>(),
            (0..=8).map(|k| f64::from(k) * 1e3).collect::<Vec<_>>()
        );
        assert!(grid_positions(Range::new(f64::NEG_INFINITY, f64::INFINITY), 1e9).count() <= 13);
    }
}
