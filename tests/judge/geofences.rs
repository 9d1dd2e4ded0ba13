//! Geofences: stay-in and keep-out volumes, at the nodes, between them and in flight.

use harness::verdict::Status;
use scenarios::{Geofence, GeofenceKind, Range};

use crate::fleet::Case;

const CHECKS: [&str; 3] = ["nodes.state_limits", "plan.state_limits", "flight.state_limits"];

fn fence(kind: GeofenceKind, polygon_m: &[[f64; 2]]) -> Geofence {
    Geofence { name: "zone".into(), kind, polygon_m: polygon_m.to_vec(), rings_m: Vec::new(), z_m: None }
}

fn rectangle(kind: GeofenceKind, x: [f64; 2], y: [f64; 2]) -> Geofence {
    fence(kind, &[[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]])
}

/// The fleet flies east at y = 0, 200 and 400 m from x = 0, at 400 m; bodies have a radius of 1 m.
fn assert_status(fence: &Geofence, checks: &[&str], status: Status) {
    assert_status_of(Case::good(), fence, checks, status);
}

fn assert_status_of(mut case: Case, fence: &Geofence, checks: &[&str], status: Status) {
    case.scenario.world.geofences.push(fence.clone());
    let verdict = case.judge();
    for name in checks {
        let check = verdict.check(name).unwrap();
        assert_eq!(check.status, status, "{fence:?}: {check:#?}");
        if status == Status::Fail {
            assert_eq!(check.between.last().map(String::as_str), Some("zone"), "{check:#?}");
            assert!(check.margin.unwrap() < 0.0, "{check:#?}");
        }
    }
}

#[test]
fn a_fleet_that_leaves_a_stay_in_zone_fails() {
    let up_to = |y_m: f64| rectangle(GeofenceKind::StayIn, [-500.0, 2000.0], [-100.0, y_m]);
    assert_status(&up_to(400.9), &CHECKS, Status::Fail);
    assert_status(&up_to(401.1), &CHECKS, Status::Pass);
}

#[test]
fn a_fleet_that_enters_a_keep_out_zone_fails() {
    let from = |y_m: f64| rectangle(GeofenceKind::KeepOut, [100.0, 600.0], [y_m, 900.0]);
    assert_status(&from(400.9), &CHECKS, Status::Fail);
    assert_status(&from(401.1), &CHECKS, Status::Pass);
}

/// A ring inside a stay-in zone is not part of it, and a ring inside a keep-out zone neither.
#[test]
fn a_hole_in_a_zone_is_outside_it() {
    let with_hole = |kind, hole_y: [f64; 2]| {
        let hole = rectangle(kind, [100.0, 600.0], hole_y).polygon_m;
        Geofence { rings_m: vec![hole], ..rectangle(kind, [-500.0, 2000.0], [-500.0, 900.0]) }
    };
    assert_status(&with_hole(GeofenceKind::StayIn, [401.1, 450.0]), &CHECKS, Status::Pass);
    assert_status(&with_hole(GeofenceKind::StayIn, [400.9, 450.0]), &CHECKS, Status::Fail);
    assert_status(&with_hole(GeofenceKind::KeepOut, [100.0, 300.0]), &CHECKS, Status::Fail);
    let around = Geofence {
        rings_m: vec![rectangle(GeofenceKind::KeepOut, [-500.0, 2000.0], [-100.0, 500.0]).polygon_m],
        ..rectangle(GeofenceKind::KeepOut, [-600.0, 2100.0], [-200.0, 600.0])
    };
    assert_status(&around, &CHECKS, Status::Pass);
}

/// 0.2 m wide: 6 ms of flight of a small body, between two nodes of the plan and two samples of the flight.
#[test]
fn a_zone_crossed_between_samples_is_found() {
    let strip = rectangle(GeofenceKind::KeepOut, [105.05, 105.25], [-50.0, 50.0]);
    let mut case = Case::good();
    case.scenario.models.fixed_wing.get_mut("paper").unwrap().body_radius_m = 0.01;
    assert_status_of(case.clone(), &strip, &["nodes.state_limits"], Status::Pass);
    assert_status_of(case, &strip, &["plan.state_limits", "flight.state_limits"], Status::Fail);
}

#[test]
fn altitude_bands_count() {
    let below = |z_m: f64| Geofence {
        z_m: Some(Range::new(0.0, z_m)),
        ..rectangle(GeofenceKind::KeepOut, [100.0, 600.0], [-50.0, 50.0])
    };
    assert_status(&below(399.1), &CHECKS, Status::Fail);
    assert_status(&below(398.9), &CHECKS, Status::Pass);
}

/// A U open to the west around the first aircraft's path: its convex hull is entered, the zone is not.
#[test]
fn the_hollow_of_a_zone_is_not_the_zone() {
    let u = |end_m: f64| {
        let outer = [[0.0, -90.0], [900.0, -90.0], [900.0, 90.0], [0.0, 90.0]];
        let inner = [[0.0, 50.0], [end_m, 50.0], [end_m, -50.0], [0.0, -50.0]];
        fence(GeofenceKind::KeepOut, &[outer, inner].concat())
    };
    assert_status(&u(880.0), &CHECKS, Status::Pass);
    assert_status(&u(600.0), &CHECKS, Status::Fail);
}

/// The map is for bodies, too: the one farthest north is at y = 400 m, all are at 400 m.
#[test]
fn a_wing_tip_beyond_the_edge_or_the_ceiling_of_the_map_has_left_it() {
    let statuses = |change: &dyn Fn(&mut scenarios::Map)| {
        let mut case = Case::good();
        change(&mut case.scenario.world.map);
        CHECKS.map(|name| case.status(name))
    };
    assert_eq!(statuses(&|map| map.y_m.max = 400.9), [Status::Fail; 3]);
    assert_eq!(statuses(&|map| map.y_m.max = 401.1), [Status::Pass; 3]);
    assert_eq!(statuses(&|map| map.z_m.max = 400.9), [Status::Fail; 3]);
    assert_eq!(statuses(&|map| map.z_m.max = 401.1), [Status::Pass; 3]);
}
