//! What stands still: the map with its ground grid, the obstacles, starts and goals.

use rerun::components::FillMode;
use rerun::{Boxes3D, Cylinders3D, LineStrips3D, Points3D, Radius, RecordingStream, ViewCoordinates};
use scenarios::{Map, Prism, Range, Scenario, Window, World};

use super::{Logged, entity, palette, to_f32};

/// Most lines of the ground grid in one direction: beyond that its spacing grows.
const MOST_GRID_LINES: f64 = 12.0;
/// Width of a name as a share of the map's.
const WIDTH_OF_NAME: f64 = 0.06;
/// Uprights on the faces of a prism, all together.
const UPRIGHTS: f64 = 60.0;
/// Radius of the dots at starts and goals, points of the screen.
const END_RADIUS: f32 = 4.0;

/// Logs everything that a scenario fixes in space.
pub fn log(stream: &RecordingStream, scenario: &Scenario) -> Logged {
    stream.log_static("world", &ViewCoordinates::RIGHT_HAND_Z_UP())?;
    log_map(stream, &scenario.world.map)?;
    log_obstacles(stream, &scenario.world.known_beforehand())?;
    log_gates(stream, &scenario.world)?;
    log_ends(stream, scenario)
}

fn log_map(stream: &RecordingStream, map: &Map) -> Logged {
    let [x, y, z] = map.axes();
    let outline = Boxes3D::from_centers_and_half_sizes(
        [to_f32([x, y, z].map(middle))],
        [to_f32([x, y, z].map(|axis| axis.width() / 2.0))],
    );
    stream.log_static(
        "world/map/outline",
        &outline
            .with_fill_mode(FillMode::MajorWireframe)
            .with_colors([palette::opaque(palette::MAP)])
            .with_radii([pixels(0.7)]),
    )?;

    let spacing_m = grid_spacing_m(map);
    let meridians = grid_positions(x, spacing_m).map(|east| [[east, y.min, z.min], [east, y.max, z.min]].map(to_f32));
    let parallels =
        grid_positions(y, spacing_m).map(|north| [[x.min, north, z.min], [x.max, north, z.min]].map(to_f32));
    let grid = LineStrips3D::new(meridians.chain(parallels))
        .with_colors([palette::opaque(palette::GRID)])
        .with_radii([pixels(0.5)]);
    stream.log_static("world/map/grid", &grid)?;

    let axes = Points3D::new([to_f32([x.max, y.min, z.min]), to_f32([x.min, y.max, z.min])])
        .with_labels([format!("east (x), grid {spacing_m:.0} m"), "north (y)".to_owned()])
        .with_colors([palette::opaque(palette::MAP)])
        .with_radii([pixels(0.0)])
        .with_show_labels(true);
    Ok(stream.log_static("world/map/axes", &axes)?)
}

/// Cylinders from the floor to the ceiling of the map: in truth they end nowhere.
fn log_obstacles(stream: &RecordingStream, world: &World) -> Logged {
    let z = world.map.z_m;
    let cylinders = &world.cylinders;
    let solid = Cylinders3D::from_lengths_and_radii(
        cylinders.iter().map(|_| z.width() as f32),
        cylinders.iter().map(|cylinder| cylinder.radius_m as f32),
    )
    .with_centers(cylinders.iter().map(|cylinder| to_f32([cylinder.center_m[0], cylinder.center_m[1], middle(z)])))
    .with_labels(cylinders.iter().map(|cylinder| cylinder.name.as_str()))
    .with_colors([palette::translucent(palette::OBSTACLE, 0.8)])
    .with_line_radii([pixels(0.8)])
    .with_fill_mode(FillMode::TransparentFillMajorWireframe);
    stream.log_static("world/obstacles", &solid)?;
    world.flat_obstacles().iter().try_for_each(|prism| log_prism(stream, prism, z))
}

/// A prism by its edges and by thin uprights on its faces, through which one sees what flies behind it; from the floor to
/// the ceiling of the map if it has no bottom or top.
fn log_prism(stream: &RecordingStream, prism: &Prism, map_z_m: Range) -> Logged {
    let z = prism.z_m.unwrap_or(map_z_m);
    let path = entity("world/obstacles", &prism.name);
    let upright = |[x, y]: [f64; 2]| [[x, y, z.min], [x, y, z.max]].map(to_f32);
    let ring =
        |z: f64| prism.corners_m.iter().cycle().take(prism.corners_m.len() + 1).map(move |[x, y]| to_f32([*x, *y, z]));
    let rings = [z.min, z.max].map(|z| ring(z).collect::<Vec<_>>());
    let uprights = prism.corners_m.iter().map(|corner| upright(*corner).to_vec());
    let edges = LineStrips3D::new(rings.into_iter().chain(uprights))
        .with_colors([palette::opaque(palette::OBSTACLE)])
        .with_radii([pixels(1.4)])
        .with_labels([prism.name.as_str()])
        .with_show_labels(false);
    stream.log_static(path.clone() / "edges", &edges)?;
    let faces = LineStrips3D::new(face_points(prism).into_iter().map(upright))
        .with_colors([palette::opaque(palette::dimmed(palette::OBSTACLE))])
        .with_radii([pixels(0.4)]);
    Ok(stream.log_static(path / "faces", &faces)?)
}

/// The windows of gates, from face to face, of the map where they have none.
fn log_gates(stream: &RecordingStream, world: &World) -> Logged {
    let faces = |window: &Window| {
        let [x, y, z] = world.map.axes();
        let [own_x, own_y, own_z] = window.axes();
        [own_x.unwrap_or(x), own_y.unwrap_or(y), own_z.unwrap_or(z)]
    };
    for gate in &world.gates {
        for (whose, window) in [("quadrotor", &gate.quadrotor), ("load", &gate.load)] {
            let faces = faces(window);
            let outline = Boxes3D::from_centers_and_half_sizes(
                [to_f32(faces.map(middle))],
                [to_f32(faces.map(|axis| axis.width() / 2.0))],
            )
            .with_fill_mode(FillMode::MajorWireframe)
            .with_labels([format!("{}: {whose}", gate.name)])
            .with_show_labels(false)
            .with_colors([palette::opaque(palette::KEPT)])
            .with_radii([pixels(1.0)]);
            stream.log_static(entity("world/gates", &gate.name) / whose, &outline)?;
        }
    }
    Ok(())
}

/// Points on the edge of a prism's polygon, about equally far apart.
pub fn face_points(prism: &Prism) -> Vec<[f64; 2]> {
    let n = prism.corners_m.len();
    let edge = |i: usize| (prism.corners_m[i], prism.corners_m[(i + 1) % n]);
    let length_m = |(a, b): ([f64; 2], [f64; 2])| (b[0] - a[0]).hypot(b[1] - a[1]);
    let spacing_m = (0..n).map(|i| length_m(edge(i))).sum::<f64>() / UPRIGHTS;
    let points = (0..n).flat_map(|i| {
        let (a, b) = edge(i);
        let steps = (length_m((a, b)) / spacing_m).round().max(1.0);
        (1..steps as usize).map(move |k| {
            let share = k as f64 / steps;
            [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]
        })
    });
    points.collect()
}

/// Dots at the starts (dim) and at the goals (bright). A start shows its name when it is pointed at: at time 0 the
/// aircraft stands there and bears it already. So do goals that are too close to each other for legible names.
fn log_ends(stream: &RecordingStream, scenario: &Scenario) -> Logged {
    let vehicles = &scenario.vehicles;
    let colours = (0..vehicles.len()).map(|index| palette::vehicle(index, vehicles.len()));
    let starts = Points3D::new(vehicles.iter().map(|vehicle| to_f32(vehicle.start.position_m())))
        .with_labels(vehicles.iter().map(|vehicle| format!("start {}", vehicle.name)))
        .with_show_labels(false)
        .with_colors(colours.clone().map(|colour| palette::opaque(palette::dimmed(colour))))
        .with_radii([pixels(END_RADIUS)]);
    stream.log_static("world/ends/starts", &starts)?;
    let goals = Points3D::new(vehicles.iter().map(|vehicle| to_f32(vehicle.goal.position_m())))
        .with_labels(vehicles.iter().map(|vehicle| format!("goal {}", vehicle.name)))
        .with_show_labels(is_roomy(scenario))
        .with_colors(colours.map(palette::opaque))
        .with_radii([pixels(END_RADIUS)]);
    Ok(stream.log_static("world/ends/goals", &goals)?)
}

/// Is there room on the whole map for a name at every goal?
fn is_roomy(scenario: &Scenario) -> bool {
    let name_m = WIDTH_OF_NAME * scenario.world.map.x_m.width();
    let goals_m: Vec<_> = scenario.vehicles.iter().map(|vehicle| vehicle.goal.position_m()).collect();
    let distance_m = |a: &[f64; 3], b: &[f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]);
    goals_m.iter().enumerate().all(|(i, a)| goals_m[..i].iter().all(|b| distance_m(a, b) > name_m))
}

/// A radius that does not change with the distance of the camera, points of the screen.
pub fn pixels(radius: f32) -> Radius {
    Radius::new_ui_points(radius)
}

fn middle(range: Range) -> f64 {
    f64::midpoint(range.min, range.max)
}

/// The finest of 1, 2, 5, 10 ... m that needs no more than [`MOST_GRID_LINES`] lines.
fn grid_spacing_m(map: &Map) -> f64 {
    let width_m = map.x_m.width().max(map.y_m.width());
    let spacings = (0..9).flat_map(|decade| [1.0, 2.0, 5.0].map(|digit| digit * 10_f64.powi(decade)));
    spacings.into_iter().find(|spacing| width_m / spacing <= MOST_GRID_LINES).unwrap_or(1e9)
}

/// Multiples of `spacing_m` inside `range`; none if the range is not finite.
fn grid_positions(range: Range, spacing_m: f64) -> impl Iterator<Item = f64> {
    let (first, last) = ((range.min / spacing_m).ceil() as i64, (range.max / spacing_m).floor() as i64);
    let most = MOST_GRID_LINES as usize + 1;
    (first..=last).take(most).map(move |multiple| multiple as f64 * spacing_m)
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
