//! The paper shows its positions in figures only. The shipped geometry must be as hard, which is tested on the files.

use scenarios::{Cylinder, Scenario, Vehicle};

/// Flight times of the paper with seven vehicles, s.
const MISSIONS: [(&str, f64); 2] = [("rendezvous-7", 232.86), ("reconfiguration-7", 191.91)];

#[test]
fn seven_vehicle_missions_are_as_hard_as_the_paper_s() {
    for (name, _) in MISSIONS {
        let scenario = super::named(name);
        assert!(obstacles_cut(&scenario) >= 4, "{name}: {} obstacles cut", obstacles_cut(&scenario));
        assert!(close_pairs(&scenario) >= 3, "{name}: {} pairs too close", close_pairs(&scenario));
        let lengths: Vec<f64> = scenario.vehicles.iter().map(|vehicle| norm(way(vehicle))).collect();
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        assert!(lengths.iter().any(|length| *length < 0.75 * longest), "{name}: {lengths:?}");
    }
}

#[test]
fn flight_times_are_within_a_tenth_of_the_paper_s() {
    for (name, paper_s) in MISSIONS {
        let scenario = super::named(name);
        let plan =
            planners::find(&scenario.planner.name).expect("a planner that exists").plan(&scenario, 0, &mut |_| {});
        let flight_time_s = plan.flight_time_s().expect("a plan");
        assert!((flight_time_s / paper_s - 1.0).abs() < 0.1, "{name}: {flight_time_s} s, the paper {paper_s} s");
    }
}

#[test]
fn smaller_fleets_are_the_first_vehicles_of_the_largest() {
    for (name, _) in MISSIONS {
        let seven = super::named(name);
        for n in 1..7 {
            let smaller = super::named(&name.replace('7', &n.to_string()));
            assert_eq!(smaller.vehicles[..], seven.vehicles[..n]);
            assert_eq!(smaller.world, seven.world);
        }
        let disturbed = super::named(&format!("{name}-wind"));
        assert_eq!(disturbed.vehicles, seven.vehicles);
        assert!(disturbed.simulation.wind.is_some() && seven.simulation.wind.is_none());
    }
}

fn way(vehicle: &Vehicle) -> [f64; 2] {
    [vehicle.goal.x_m - vehicle.start.x_m, vehicle.goal.y_m - vehicle.start.y_m]
}

/// Number of obstacles that intersect the straight path of at least one vehicle.
fn obstacles_cut(scenario: &Scenario) -> usize {
    let cuts = |cylinder: &Cylinder, vehicle: &Vehicle| {
        let [x, y] = cylinder.center_m;
        nearest_to_origin([vehicle.start.x_m - x, vehicle.start.y_m - y], way(vehicle)) < cylinder.radius_m
    };
    let is_cut = |cylinder: &&Cylinder| scenario.vehicles.iter().any(|vehicle| cuts(cylinder, vehicle));
    scenario.world.cylinders.iter().filter(is_cut).count()
}

/// Pairs that come closer than the separation when all fly straight and arrive together.
fn close_pairs(scenario: &Scenario) -> usize {
    let separation_m = scenario.fleet.separation_m.expect("a fleet with a rule");
    let pairs =
        scenario.vehicles.iter().enumerate().flat_map(|(i, a)| scenario.vehicles[..i].iter().map(move |b| (a, b)));
    let distance_m = |(a, b): &(&Vehicle, &Vehicle)| {
        let apart = [a.start.x_m - b.start.x_m, a.start.y_m - b.start.y_m];
        nearest_to_origin(apart, [way(a)[0] - way(b)[0], way(a)[1] - way(b)[1]])
    };
    pairs.filter(|pair| distance_m(pair) < separation_m).count()
}

/// Smallest norm of `from + share * along` over shares in [0, 1].
fn nearest_to_origin(from: [f64; 2], along: [f64; 2]) -> f64 {
    let square = along[0] * along[0] + along[1] * along[1];
    let share = (-(from[0] * along[0] + from[1] * along[1]) / square.max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    norm([from[0] + share * along[0], from[1] + share * along[1]])
}

fn norm([x, y]: [f64; 2]) -> f64 {
    x.hypot(y)
}
