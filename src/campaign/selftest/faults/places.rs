//! Faults of places. Of maps and geofences: a body is beyond the boundary, although its centre is not.

use scenarios::{Geofence, GeofenceKind, Range, Trajectory, World};

use super::super::{Fault, NearMiss, ReferenceCase};
use super::bodies::{FAR_M, Placed, WITHIN_BODY, near_body, occupied};
use super::solids;

/// Checks of states: at the nodes, between them and in flight.
const CHECKS: [&str; 3] = ["nodes.state_limits", "plan.state_limits", "flight.state_limits"];

/// Boundaries near the place where a plan or a flight ends.
const NEAR_GOAL: &[(&str, Placed)] = &[
    ("the map ends within the body", |world, [x_m, ..], near_m| world.map.x_m.max = x_m + near_m),
    ("the ceiling of the map is within the body", |world, [.., z_m], near_m| world.map.z_m.max = z_m + near_m),
    ("the floor of the map is within the body", |world, [.., z_m], near_m| world.map.z_m.min = z_m - near_m),
    ("a geofence ends within the body", |world, [x_m, ..], near_m| {
        stay_in(world, rectangle([-FAR_M, x_m + near_m], [-FAR_M, FAR_M]), None);
    }),
    ("the ceiling of a geofence is within the body", |world, [.., z_m], near_m| {
        stay_in(world, everywhere(), Some(Range::new(-FAR_M, z_m + near_m)));
    }),
    ("the notch of a geofence is within the body", |world, [x_m, y_m, _], near_m| {
        let (west_m, south_m) = (x_m - near_m, y_m + near_m);
        let notched = [[-FAR_M, -FAR_M], [FAR_M, -FAR_M], [FAR_M, south_m], [west_m, south_m], [west_m, FAR_M]];
        stay_in(world, notched.into_iter().chain([[-FAR_M, FAR_M]]).collect(), None);
    }),
    ("a forbidden pole of 2 cm is within the body", |world, [x_m, y_m, _], near_m| {
        let [east_m, north_m] = [x_m + 0.01, y_m - near_m];
        keep_out(world, rectangle([x_m - 0.01, east_m], [north_m - 0.02, north_m]), None);
    }),
    ("a forbidden layer begins within the body", |world, [.., z_m], near_m| {
        keep_out(world, everywhere(), Some(Range::new(z_m + near_m, FAR_M)));
    }),
    ("the whole site is forbidden", |world, _, _| keep_out(world, everywhere(), None)),
];

/// Boundaries near the load where a plan or a flight ends, and away from the quadrotor above it.
const NEAR_LOAD: &[(&str, Placed)] = &[
    ("the floor of the map is within the load", |world, [.., z_m], near_m| world.map.z_m.min = z_m - near_m),
    ("the floor of a geofence is within the load", |world, [.., z_m], near_m| {
        stay_in(world, everywhere(), Some(Range::new(z_m - near_m, FAR_M)));
    }),
    ("a forbidden layer ends within the load", |world, [.., z_m], near_m| {
        keep_out(world, everywhere(), Some(Range::new(-FAR_M, z_m - near_m)));
    }),
    ("a forbidden box of 2 cm is within the load", |world, [x_m, y_m, z_m], near_m| {
        let north_m = y_m - near_m;
        let polygon_m = rectangle([x_m - 0.01, x_m + 0.01], [north_m - 0.02, north_m]);
        keep_out(world, polygon_m, Some(Range::new(z_m - 0.01, z_m + 0.01)));
    }),
];

/// The faults of plans that were made before the flight, and of their flights.
pub fn faults() -> Vec<Fault> {
    let near_goal = |check| NEAR_GOAL.iter().map(move |placed| near_body(check, placed));
    CHECKS.into_iter().flat_map(near_goal).chain(solids::faults()).collect()
}

/// The faults of flights that were planned in the loop.
pub fn flown_faults() -> Vec<Fault> {
    NEAR_GOAL.iter().map(|placed| near_body(CHECKS[2], placed)).chain(solids::flown_faults()).collect()
}

/// The faults of plans and flights with a load.
pub fn load_faults() -> Vec<Fault> {
    let of_check = |check| {
        NEAR_LOAD.iter().map(move |&(name, place)| {
            Fault::new(check, name, move |it| {
                let (centre_m, vehicle) = (load_m(it, check), &it.scenario.vehicles[0]);
                let radius_m = it.scenario.slung_load_model(vehicle).load_radius_m;
                place(&mut it.scenario.world, centre_m, WITHIN_BODY * radius_m);
            })
        })
    };
    CHECKS.into_iter().flat_map(of_check).collect()
}

/// A map and a geofence around all bodies, as far beyond them as a vehicle may be off its plan.
pub fn near_misses() -> Vec<NearMiss> {
    let boundaries = vec![
        NearMiss::new("a map that ends just beyond the bodies", |it| {
            let [x_m, y_m, z_m] = occupied(it);
            it.scenario.world.map = scenarios::Map { x_m, y_m, z_m };
        }),
        NearMiss::new("a geofence that ends just beyond the bodies", |it| {
            let [x_m, y_m, z_m] = occupied(it);
            stay_in(&mut it.scenario.world, rectangle([x_m.min, x_m.max], [y_m.min, y_m.max]), Some(z_m));
        }),
        NearMiss::new("a forbidden zone just beside the bodies", |it| {
            let [x_m, _, _] = occupied(it);
            keep_out(&mut it.scenario.world, rectangle([x_m.max, FAR_M], [-FAR_M, FAR_M]), None);
        }),
    ];
    boundaries.into_iter().chain(solids::near_misses()).collect()
}

/// Where the load of the first vehicle of a plan, or of its flight, is at the planned end.
fn load_m(it: &mut ReferenceCase, check: &str) -> [f64; 3] {
    if check.starts_with("flight.") {
        let last = it.planned_steps() - 1;
        return it.flight().vehicles[0].loads[last].position_m;
    }
    match &it.plan.trajectories[0] {
        Trajectory::SlungLoad(trajectory) => trajectory.states.last().expect("a plan has rows").load_position_m,
        _ => panic!("not a slung load"),
    }
}

fn stay_in(world: &mut World, polygon_m: Vec<[f64; 2]>, z_m: Option<Range>) {
    world.geofences.push(Geofence {
        name: "site".to_owned(),
        kind: GeofenceKind::StayIn,
        polygon_m,
        rings_m: Vec::new(),
        z_m,
    });
}

fn keep_out(world: &mut World, polygon_m: Vec<[f64; 2]>, z_m: Option<Range>) {
    world.geofences.push(Geofence {
        name: "zone".to_owned(),
        kind: GeofenceKind::KeepOut,
        polygon_m,
        rings_m: Vec::new(),
        z_m,
    });
}

fn everywhere() -> Vec<[f64; 2]> {
    rectangle([-FAR_M, FAR_M], [-FAR_M, FAR_M])
}

fn rectangle([west_m, east_m]: [f64; 2], [south_m, north_m]: [f64; 2]) -> Vec<[f64; 2]> {
    vec![[west_m, south_m], [east_m, south_m], [east_m, north_m], [west_m, north_m]]
}
