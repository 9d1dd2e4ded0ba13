//! Bounds of robustness against dense samples, and formulas with known values.

mod oracle;

use scenarios::requirement::Requirement;
use scenarios::{Cylinder, Geofence, GeofenceKind, MovingCylinder, Range, Scenario};

use super::grid::TOLERANCE;
use super::scene::Scene;
use super::smallest;
use crate::verdict::motion::{Knot, Motion};
use crate::verdict::random::Uniform;

/// Motions, and random formulas about each.
const MOTIONS: usize = 4;
const FORMULAS_EACH: usize = 8;

/// The shipped fleet of two, with a geofence, a pole, and a cylinder that moves.
fn scenario() -> Scenario {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios/fixed-wing/rendezvous-2.toml");
    let mut scenario = scenarios::load(file.as_ref()).expect("a shipped scenario");
    scenario.world.geofences = vec![field()];
    let pole = Cylinder { name: "pole".into(), center_m: [12.0, -8.0], radius_m: 4.0 };
    scenario.world.cylinders = vec![pole];
    scenario.world.moving = vec![MovingCylinder {
        name: "mover".into(),
        radius_m: 3.0,
        z_m: Some(Range::new(-20.0, 15.0)),
        path_m: vec![[-30.0, 5.0], [10.0, 20.0], [25.0, -10.0]],
        speed_mps: 8.0,
        offset_m: 2.0,
    }];
    scenario
}

fn field() -> Geofence {
    let polygon_m = vec![[-20.0, -20.0], [25.0, -20.0], [25.0, 3.0], [0.0, 5.0], [-20.0, 30.0]];
    Geofence { name: "field".into(), kind: GeofenceKind::StayIn, polygon_m, rings_m: Vec::new(), z_m: None }
}

fn requirement(formula: &str) -> Requirement {
    let text = format!("name = \"r\"\nformula = \"{formula}\"\n");
    toml::from_str(&text).expect("a requirement")
}

/// x = 30 t, y = north, z = altitude + climb t, for 20 s.
fn line(name: &str, north_m: f64, altitude_m: f64, climb_mps: f64) -> Motion {
    let knot = |step: u32| {
        let t_s = f64::from(step) * 0.5;
        let position_m = [30.0 * t_s, north_m, altitude_m + climb_mps * t_s];
        Knot { t_s, position_m, velocity_mps: [30.0, 0.0, climb_mps] }
    };
    Motion::new(name, (0..=40).map(knot).collect()).unwrap()
}

/// Knots at random times until 18 s, places and velocities.
fn wild(name: &str, uniform: &mut Uniform) -> Motion {
    let mut t_s = 0.0;
    let knots = (0..12).map(|index| {
        if index == 11 {
            t_s = 18.0;
        }
        let position_m = std::array::from_fn(|_| uniform.between(-40.0, 40.0));
        let velocity_mps = std::array::from_fn(|_| uniform.between(-15.0, 15.0));
        let knot = Knot { t_s, position_m, velocity_mps };
        t_s += uniform.between(0.4, 1.5);
        knot
    });
    Motion::new(name, knots.collect()).unwrap()
}

fn bounds(formula: &str, motions: &[Motion]) -> [f64; 2] {
    let scenario = scenario();
    let formula = requirement(formula).formula(&scenario).unwrap_or_else(|error| panic!("{formula}: {error}"));
    let scene = Scene::new(&scenario, motions, None);
    let bounds = smallest(&formula, &scene).expect("vehicles").robustness.bounds;
    [bounds.min, bounds.max]
}

#[test]
fn robustness_of_straight_flights_is_what_geometry_says() {
    let motions = [line("uav-1", 0.0, 100.0, 2.0), line("uav-2", 40.0, 170.0, -1.0)];
    for (formula, expected) in [
        ("always altitude > 50 m", 50.0),
        ("always altitude(uav-2) > 160 m", -10.0),
        ("eventually altitude(uav-1) > 120 m", 20.0),
        // 70 m - 3 t above each other: level after 23.3 s, 10 m apart at the end.
        ("for all pairs a, b: always distance(a, b) > 30 m", 1700_f64.sqrt() - 30.0),
        ("always horizontal_distance(uav-1, uav-2) < 41 m", 1.0),
        ("always [2 s, 5 s] altitude(uav-1) > 104 m", 0.0),
        ("eventually [2 s, 5 s] altitude(uav-1) > 111 m", -1.0),
        ("altitude(uav-1) < 130 m until [5 s, 10 s] altitude(uav-1) > 112 m", 8.0),
        ("always (east(uav-1) > 300 m implies altitude(uav-1) > 115 m)", 4.6875),
        ("always (time < 4 s or eventually [0 s, 1 s] altitude(uav-1) > 109 m)", 1.0 / 3.0),
        ("always speed < 31 m/s", 31.0 - 904_f64.sqrt()),
        ("for some a: always altitude(a) > 140 m", 10.0),
        ("always flight_path(uav-1) > 3 deg", (2.0_f64 / 30.0).atan().to_degrees() - 3.0),
        ("always heading_from(90 deg) > 60 deg", 30.0),
        ("always acceleration < 1 m/s^2", 1.0),
        ("eventually distance(uav-1, point(300 m, 0 m, 120 m)) < 5 m", 5.0),
        ("always (time_left > 5 s implies altitude(uav-2) > 155 m)", 0.0),
    ] {
        let [lower, upper] = bounds(formula, &motions);
        let tolerance = 2.0 * TOLERANCE * expected.abs().max(1.0);
        assert!(lower <= expected + 1e-9 && expected <= upper + 1e-9, "{formula}: {lower} {upper}, not {expected}");
        assert!(upper - lower <= tolerance, "{formula}: {lower} {upper}");
    }
}

#[test]
fn intervals_beyond_the_end_of_the_motion_decide_nothing() {
    let motions = [line("uav-1", 0.0, 100.0, 0.0), line("uav-2", 40.0, 100.0, 0.0)];
    assert_eq!(bounds("always [30 s, 40 s] altitude > 5 m", &motions), [f64::INFINITY; 2]);
    assert_eq!(bounds("eventually [30 s, 40 s] altitude > 5 m", &motions), [f64::NEG_INFINITY; 2]);
}

#[test]
fn tubes_widen_the_bounds() {
    let motions = [line("uav-1", 0.0, 100.0, 0.0).within(|_| 0.25), line("uav-2", 40.0, 100.0, 0.0)];
    let [lower, upper] = bounds("always altitude(uav-1) > 90 m", &motions);
    assert!((lower - 9.75).abs() < 1e-6 && (upper - 10.25).abs() < 1e-6, "{lower} {upper}");
    let [lower, upper] = bounds("for all pairs a, b: always distance(a, b) > 30 m", &motions);
    assert!((lower - 9.75).abs() < 1e-6 && (upper - 10.25).abs() < 1e-6, "{lower} {upper}");
}

#[test]
fn no_sample_of_a_predicate_is_outside_its_bounds() {
    let scenario = scenario();
    let mut uniform = Uniform::seeded(19);
    let mut samples = 0;
    for round in 0..60 {
        let motions = [wild("uav-1", &mut uniform), wild("uav-2", &mut uniform)];
        let scene = Scene::new(&scenario, &motions, None);
        for predicate in oracle::PREDICATES {
            let formula = requirement(predicate).formula(&scenario).unwrap();
            let instance = super::Instance::new(&formula, &scene, &[0]).unwrap();
            let [begin_s, end_s] = instance.lifetime_s;
            for _ in 0..60 {
                let from_s = uniform.between(begin_s, end_s);
                let length_s = 5.0 * uniform.between(0.0, 1.0).powi(4);
                let to_s = uniform.between(from_s, end_s.min(from_s + length_s));
                let (bounds, _) = instance.robustness(0, [from_s, to_s]);
                for _ in 0..20 {
                    let t_s = uniform.between(from_s, to_s);
                    let value = oracle::value(predicate, &scenario, &motions, t_s);
                    let is_inside = bounds.min <= value && value <= bounds.max;
                    assert!(is_inside, "{round}: {predicate} at {t_s} in [{from_s}, {to_s}]: {value} {bounds:?}");
                    samples += 1;
                }
            }
        }
    }
    assert!(samples >= 1_000_000, "{samples}");
}

#[test]
fn random_formulas_contain_their_sampled_robustness() {
    let mut uniform = Uniform::seeded(20);
    let scenario = scenario();
    for round in 0..MOTIONS {
        let motions = [wild("uav-1", &mut uniform), wild("uav-2", &mut uniform)];
        let end_s = motions[0].end_s().min(motions[1].end_s());
        let samples = oracle::Samples::of(&scenario, &motions, end_s);
        for _ in 0..FORMULAS_EACH {
            let formula = oracle::Sampled::random(&mut uniform, 3);
            let [lower, upper] = bounds(&formula.text(), &motions);
            let sampled = formula.robustness(&samples);
            let is_inside = lower - samples.error <= sampled && sampled <= upper + samples.error;
            assert!(is_inside, "{round}: {} is {sampled} ± {}, not in {lower} {upper}", formula.text(), samples.error);
        }
    }
}

#[test]
fn until_in_until_has_the_robustness_of_its_definition() {
    let motions = [line("uav-1", 0.0, 100.0, 2.0), line("uav-2", 40.0, 170.0, -1.0)];
    // From t on, the inner formula holds best at its last instant t + 5 s, where uav-1 is 2 (t + 5) m above 100 m.
    let inner = "(altitude(uav-2) > 150 m until [0 s, 5 s] altitude(uav-1) > 120 m)";
    let [lower, upper] = bounds(&format!("altitude(uav-1) > 90 m until [2 s, 8 s] {inner}"), &motions);
    // At 8 s: min(20 - t at the end of the inner interval, 2 * 13 - 20) = min(7, 6); uav-1 is 10 m above 90 m at first.
    assert!(lower <= 6.0 + 1e-9 && 6.0 <= upper + 1e-9 && upper - lower < 1e-4, "{lower} {upper}");
}
