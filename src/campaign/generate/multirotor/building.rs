//! Rooms on two floors.

use scenarios::{BoxObstacle, Map, Range, World};

use super::{CLEARANCE_M, MAX_MAPS, draft_of_one};
use crate::campaign::generate::Request;
use crate::campaign::generate::file::Draft;
use crate::campaign::generate::grid_search::Grid;
use crate::campaign::generate::random_stream::{RandomStream, round_to};

/// Side and height of a room, m.
const ROOM_M: f64 = 5.0;
const HEIGHT_M: f64 = 3.0;
const FLOORS: usize = 2;
/// Thickness of walls and floors, m.
const WALL_M: f64 = 0.2;
/// Width and height of a door, m.
const DOOR_M: [f64; 2] = [2.0, 2.4];
/// Probability of a door between two rooms, and of an opening between two floors.
const DOOR_PROBABILITY: f64 = 0.7;
const OPENING_PROBABILITY: f64 = 0.35;
/// Cell of the grid, m.
const STEP_M: f64 = 0.25;
/// Altitude of start and goal above their floors, and distance without furniture around them and around doors, m.
const ABOVE_FLOOR_M: f64 = 1.3;
const FREE_RADIUS_M: f64 = 1.3;
/// Attempts to place one more piece of furniture.
const MAX_ATTEMPTS: usize = 300;

/// From the first column of rooms on the lower floor to the last one on the upper floor.
pub fn draw(request: &Request) -> Option<Draft> {
    let mut rng = request.rng("rooms");
    let rooms = request.size;
    let side_m = ROOM_M * rooms as f64;
    let side = Range::new(0.0, side_m);
    (0..MAX_MAPS).find_map(|_| {
        let height_m = HEIGHT_M * FLOORS as f64;
        let mut world = World::empty(Map { x_m: side, y_m: side, z_m: Range::new(0.0, height_m) });
        let doors_m = walls(&mut rng, &mut world, rooms);
        floors(&mut rng, &mut world, rooms);
        let endpoints_m = [(0, 0), (rooms - 1, FLOORS - 1)].map(|(column, floor)| {
            let middle_m = |room: usize| ROOM_M * (room as f64 + 0.5);
            let row = rng.index(rooms);
            [middle_m(column), middle_m(row), round_to(HEIGHT_M * floor as f64 + ABOVE_FLOOR_M, 0.1)]
        });
        let free_m = [doors_m, endpoints_m.to_vec()].concat();
        furnish(&mut rng, &mut world, request.density, &free_m)?;
        let path_length_m =
            Grid::new(&world, None, STEP_M, CLEARANCE_M).path_length_m(endpoints_m[0], endpoints_m[1])?;
        Some(draft_of_one(request, world, endpoints_m, path_length_m))
    })
}

/// Walls between neighbouring rooms, most of them with a door. Returns the middles of the doors.
fn walls(rng: &mut RandomStream, world: &mut World, rooms: usize) -> Vec<[f64; 3]> {
    let mut doors_m = Vec::new();
    for floor in 0..FLOORS {
        for line in 1..rooms {
            for room in 0..rooms {
                for is_across in [true, false] {
                    let has_door = rng.between(0.0, 1.0) < DOOR_PROBABILITY;
                    let door_m = rng.rounded(0.3, ROOM_M - DOOR_M[0] - 0.3, 0.1);
                    let wall = Wall { floor, line, room, is_across };
                    world.boxes.extend(wall.parts(has_door.then_some(door_m)));
                    doors_m.extend(has_door.then(|| wall.door_middle_m(door_m)));
                }
            }
        }
    }
    doors_m
}

/// A wall of the length of a room.
struct Wall {
    floor: usize,
    line: usize,
    room: usize,
    /// Whether it stands across the x axis.
    is_across: bool,
}

impl Wall {
    /// Its parts: one, or two beside a door and a lintel above it.
    ///
    /// - `door_m`: distance of the door from the initial of the wall, m
    fn parts(&self, door_m: Option<f64>) -> Vec<BoxObstacle> {
        let Some(door_m) = door_m else { return vec![self.part("", [0.0, ROOM_M], 0.0)] };
        let [width_m, height_m] = DOOR_M;
        vec![
            self.part("-a", [0.0, door_m], 0.0),
            self.part("-b", [door_m + width_m, ROOM_M], 0.0),
            self.part("-lintel", [door_m, door_m + width_m], height_m),
        ]
    }

    /// Middle of a door at this distance from the beginning of the wall.
    fn door_middle_m(&self, door_m: f64) -> [f64; 3] {
        let along_m = ROOM_M * self.room as f64 + door_m + DOOR_M[0] / 2.0;
        let line_m = ROOM_M * self.line as f64;
        let [x_m, y_m] = if self.is_across { [line_m, along_m] } else { [along_m, line_m] };
        [x_m, y_m, HEIGHT_M * self.floor as f64 + DOOR_M[1] / 2.0]
    }

    fn part(&self, suffix: &str, [from_m, to_m]: [f64; 2], from_z_m: f64) -> BoxObstacle {
        let along_m = ROOM_M * self.room as f64 + (from_m + to_m) / 2.0;
        let line_m = ROOM_M * self.line as f64;
        let length_m = to_m - from_m;
        let (direction, center_m, size_m) = if self.is_across {
            ("x", [line_m, along_m], [WALL_M, length_m])
        } else {
            ("y", [along_m, line_m], [length_m, WALL_M])
        };
        let floor_m = HEIGHT_M * self.floor as f64;
        BoxObstacle {
            name: format!("wall-{direction}{}-{}-floor-{}{suffix}", self.line, self.room + 1, self.floor + 1),
            center_m: center_m.map(|it| round_to(it, 1e-3)),
            size_m: size_m.map(|it| round_to(it, 1e-3)),
            heading_deg: 0.0,
            z_m: Some(Range::new(round_to(floor_m + from_z_m, 0.1), floor_m + HEIGHT_M)),
        }
    }
}

/// The floor above each room, apart from openings.
fn floors(rng: &mut RandomStream, world: &mut World, rooms: usize) {
    for column in 0..rooms {
        for row in 0..rooms {
            let is_open = rng.between(0.0, 1.0) < OPENING_PROBABILITY;
            world.boxes.extend((!is_open).then(|| BoxObstacle {
                name: format!("floor-{}-{}", column + 1, row + 1),
                center_m: [column, row].map(|room| ROOM_M * (room as f64 + 0.5)),
                size_m: [ROOM_M; 2],
                heading_deg: 0.0,
                z_m: Some(Range::new(HEIGHT_M - WALL_M / 2.0, HEIGHT_M + WALL_M / 2.0)),
            }));
        }
    }
}

/// Furniture until the volume is filled to the density.
///
/// - `free_m`: points around which there is none
fn furnish(rng: &mut RandomStream, world: &mut World, density: f64, free_m: &[[f64; 3]]) -> Option<()> {
    let volume_m3 = world.map.axes().map(|range| range.max - range.min).iter().product::<f64>();
    let volume = |it: &BoxObstacle| it.size_m[0] * it.size_m[1] * it.z_m.map_or(0.0, |z| z.max - z.min);
    let mut filled_m3: f64 = world.boxes.iter().map(volume).sum();
    let mut number = 0;
    while filled_m3 < density * volume_m3 {
        let mut pieces = (0..MAX_ATTEMPTS).map(|_| piece(rng, world, number + 1));
        let is_away = |it: &BoxObstacle| {
            let prism = it.as_prism().counterclockwise();
            free_m.iter().all(|point_m| prism.signed_distance_in_space_m(*point_m) >= FREE_RADIUS_M)
        };
        let fits =
            |it: &BoxObstacle| is_away(it) && stands(it, world) && !world.boxes.iter().any(|other| overlap(it, other));
        let piece = pieces.find(fits)?;
        number += 1;
        filled_m3 += volume(&piece);
        world.boxes.push(piece);
    }
    Some(())
}

/// A piece of furniture, standing on its floor.
fn piece(rng: &mut RandomStream, world: &World, number: usize) -> BoxObstacle {
    let size_m = [0, 1].map(|_| rng.rounded(0.6, 2.0, 0.1));
    let floor_m = [0.0, HEIGHT_M + WALL_M / 2.0][rng.index(FLOORS)];
    let height_m = rng.rounded(0.8, 2.4, 0.1);
    BoxObstacle {
        name: format!("furniture-{number}"),
        center_m: [world.map.x_m, world.map.y_m].map(|range| rng.rounded(range.min, range.max, 0.05)),
        size_m,
        heading_deg: 0.0,
        z_m: Some(Range::new(floor_m, round_to(floor_m + height_m, 0.1))),
    }
}

/// Whether there is a floor below the middle of a piece.
fn stands(piece: &BoxObstacle, world: &World) -> bool {
    let bottom_m = piece.z_m.map_or(0.0, |z_m| z_m.min);
    let is_below = |floor: &BoxObstacle| {
        let over = |axis: usize| (piece.center_m[axis] - floor.center_m[axis]).abs() <= floor.size_m[axis] / 2.0;
        floor.z_m.is_some_and(|z_m| z_m.max == bottom_m) && over(0) && over(1)
    };
    bottom_m == 0.0 || world.boxes.iter().any(is_below)
}

/// Whether two boxes that are parallel to the axes overlap.
fn overlap(a: &BoxObstacle, b: &BoxObstacle) -> bool {
    let in_plane = |axis: usize| (a.center_m[axis] - b.center_m[axis]).abs() < (a.size_m[axis] + b.size_m[axis]) / 2.0;
    let in_height = match (a.z_m, b.z_m) {
        (Some(a), Some(b)) => a.min < b.max && b.min < a.max,
        _ => true,
    };
    in_plane(0) && in_plane(1) && in_height
}
