//! Faults of flights among moving obstacles.

use scenarios::MovingCylinder;
use sim::Obstacles;

use crate::campaign::selftest::{Fault, ReferenceCase};

/// Step by which a moving obstacle is delayed until it is in the way, s.
const DELAY_STEP_S: f64 = 0.1;

/// The faults.
pub fn faults() -> Vec<Fault> {
    vec![
        Fault::new("flight.clearance", "a crossing obstacle comes later than it was sensed", |it| delay(it, 0)),
        Fault::new("flight.clearance", "an obstacle that crosses at the end comes later than it was sensed", |it| {
            delay(it, 2);
        }),
        Fault::new("flight.crash", "an obstacle hit a vehicle without a crash in the log", |it| delay(it, 1)),
        Fault::new(
            "flight.clearance",
            "a plate of 2 mm crosses the path between two samples, faster than either",
            |it| {
                let middle = it.steps() / 2;
                let [from, to] = [it.samples(0)[middle], it.samples(0)[middle + 1]];
                let [x_m, y_m] = [0, 1].map(|axis| f64::midpoint(from.position_m[axis], to.position_m[axis]));
                let (speed_mps, t_s) = (400.0, f64::midpoint(from.t_s, to.t_s));
                // It passes in an instant, and is far away during the rest of the flight.
                let (before_m, beyond_m) = (speed_mps * t_s, speed_mps * 200.0);
                it.scenario.world.moving.push(MovingCylinder {
                    name: "planted".to_owned(),
                    radius_m: 1e-3,
                    z_m: None,
                    path_m: vec![[x_m, y_m - before_m], [x_m, y_m + beyond_m]],
                    speed_mps,
                    offset_m: 0.0,
                });
            },
        ),
        Fault::new("flight.clearance", "moving obstacles are wider than they were sensed", |it| {
            let clearance_m = it.value("flight.clearance");
            it.scenario.world.moving.iter_mut().for_each(|cart| cart.radius_m += clearance_m + 1e-3);
            it.scenario.world.boxes.clear();
        }),
    ]
}

/// Delays a moving obstacle until the first vehicle flies into it. Panics if it is never in the way.
fn delay(it: &mut ReferenceCase, cart: usize) {
    let reach_m = it.multirotor_model().body_radius_m;
    let samples = it.samples(0).clone();
    for _ in 0..1000 {
        let late = &mut it.scenario.world.moving[cart];
        late.offset_m -= late.speed_mps * DELAY_STEP_S;
        let world = scenarios::World { moving: vec![late.clone()], boxes: Vec::new(), ..it.scenario.world.clone() };
        let alone = Obstacles::new(&world);
        if samples.iter().any(|sample| alone.distance_m(0, sample.t_s, sample.position_m) < 0.5 * reach_m) {
            return;
        }
    }
    panic!("the obstacle is never in the way");
}
