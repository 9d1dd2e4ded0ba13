//! Validation of models of quadrotors with slung loads, and of where the load begins and ends.

use super::{Limits, Model, State};
use crate::validate::body::{beyond_geofences, too_near, too_near_edges};
use crate::validate::quantity::{not_negative, ordered, positive, positive_if_given};
use crate::validate::{inside_obstacle, outside_map, planning_inside_physical};
use crate::{Issue, Prism, Range, Waypoint, World};

/// Excess over the cable's length that is attributed to the decimals of a file, m.
const LENGTH_TOLERANCE_M: f64 = 1e-6;

pub(super) fn model(field: &str, model: &Model) -> Vec<Issue> {
    let mut issues = quantities(field, model);
    issues.extend(limits(&format!("{field}.limits"), &model.limits));
    issues.extend(limits(&format!("{field}.planning_limits"), &model.planning_limits));
    issues.extend(planning_inside_physical(field, named(&model.planning_limits), named(&model.limits)));
    issues.extend(hover_thrust(field, model));
    issues
}

fn quantities(field: &str, model: &Model) -> Vec<Issue> {
    let positive_quantities = [
        ("mass_kg", model.mass_kg),
        ("inertia_kgm2[0]", model.inertia_kgm2[0]),
        ("inertia_kgm2[1]", model.inertia_kgm2[1]),
        ("inertia_kgm2[2]", model.inertia_kgm2[2]),
        ("arm_m", model.arm_m),
        ("torque_per_thrust_m", model.torque_per_thrust_m),
        ("propeller_radius_m", model.propeller_radius_m),
        ("load_mass_kg", model.load_mass_kg),
        ("load_radius_m", model.load_radius_m),
        ("cable_length_m", model.cable_length_m),
    ];
    let drag = [("drag_area_m2", model.drag_area_m2), ("load_drag_area_m2", model.load_drag_area_m2)];
    let positive_quantities =
        positive_quantities.into_iter().filter_map(|(name, value)| positive(&format!("{field}.{name}"), value));
    let drag = drag.into_iter().filter_map(|(name, value)| not_negative(&format!("{field}.{name}"), value));
    let lag = positive_if_given(&format!("{field}.rotor_time_constant_s"), model.rotor_time_constant_s);
    positive_quantities.chain(drag).chain(lag).collect()
}

fn limits(field: &str, limits: &Limits) -> Vec<Issue> {
    let mut issues: Vec<Issue> =
        named(limits).into_iter().filter_map(|(name, range)| ordered(&format!("{field}.{name}"), range)).collect();
    issues.extend(positive(&format!("{field}.tension_n"), limits.tension_n));
    issues.extend(not_negative(&format!("{field}.thrust_n"), limits.thrust_n.min).map(|issue| {
        Issue::new(issue.field, limits.thrust_n.to_string(), "a minimum thrust of 0 or more: rotors cannot pull down")
    }));
    if limits.attitude_deg.min <= -90.0 || limits.attitude_deg.max >= 90.0 {
        let expected = "both ends strictly between -90 and 90 deg";
        issues.push(Issue::new(format!("{field}.attitude_deg"), limits.attitude_deg.to_string(), expected));
    }
    issues
}

fn hover_thrust(field: &str, model: &Model) -> Option<Issue> {
    let (hover_n, thrust_n) = (model.hover_thrust_n(), model.planning_limits.thrust_n);
    (thrust_n.min < thrust_n.max && !(thrust_n.min < hover_n && hover_n < thrust_n.max)).then(|| {
        let expected = format!("a range that contains {hover_n:.3} N, the thrust of each rotor in hover");
        Issue::new(format!("{field}.planning_limits.thrust_n"), thrust_n.to_string(), expected)
            .remedy("increase the thrust, or reduce the mass")
    })
}

fn named(limits: &Limits) -> [(&'static str, Range); 3] {
    [("thrust_n", limits.thrust_n), ("attitude_deg", limits.attitude_deg), ("cable_deg", limits.cable_deg)]
}

/// The load at a start or goal: within reach of the cable, on the map, outside obstacles and above the ground.
pub(super) fn waypoint(model: &Model, world: &World, field: &str, waypoint: &Waypoint) -> Vec<Issue> {
    let state = State::at(waypoint, model.cable_length_m);
    let load = format!("{field}.load");
    let mut issues = outside_map(world, &load, state.load_position_m);
    issues.extend(inside_obstacle(world, &load, state.load_position_m));
    issues.extend(too_near_edges(model.load_radius_m, world, &load, state.load_position_m));
    issues.extend(beyond_geofences(model.load_radius_m, world, &load, state.load_position_m));
    if state.cable_length_m() > model.cable_length_m + LENGTH_TOLERANCE_M {
        let found = format!("a load {:.4} m from the quadrotor", state.cable_length_m());
        let expected = format!("at most {} m, the length of the cable", model.cable_length_m);
        issues.push(Issue::new(load.clone(), found, expected).remedy("move the load or the quadrotor"));
    }
    issues.extend(inside_body(model, &load, &state));
    issues.extend(touched(model, world, [field, &load], &state));
    issues.extend(pierced(model, world, &load, &state));
    let min_z_m = world.ground_m.map(|ground_m| ground_m + model.load_radius_m);
    if let Some(min_z_m) = min_z_m.filter(|min_z_m| state.load_position_m[2] < min_z_m - LENGTH_TOLERANCE_M) {
        let found = format!("a load whose centre is at {} m", state.load_position_m[2]);
        let expected = format!("at least {min_z_m} m, its radius above the ground");
        issues.push(Issue::new(load, found, expected).remedy("raise the load, or lower world.ground_m"));
    }
    issues
}

/// Obstacles that the disc of the level body or the ball of the load touches while its centre is outside.
fn touched(model: &Model, world: &World, [body, load]: [&str; 2], state: &State) -> Vec<Issue> {
    let [x_m, y_m, z_m] = state.position_m;
    let of_prism = |prism: Prism| {
        let is_level = prism.z_m.is_none_or(|range| range.contains(z_m));
        let to_body_m = if is_level { prism.signed_distance_m([x_m, y_m]) } else { f64::INFINITY };
        let to_load_m = prism.signed_distance_in_space_m(state.load_position_m);
        let parts = [(body, to_body_m, model.body_radius_m()), (load, to_load_m, model.load_radius_m)];
        // A box without a width, which is refused itself, is at distance 0 of every point beside it.
        let is_near = |(_, distance_m, radius_m): &(&str, f64, f64)| 0.0 < *distance_m && distance_m < radius_m;
        let touching = parts.into_iter().filter(is_near);
        touching
            .map(|(field, distance_m, radius_m)| too_near(radius_m, field, &prism.name, distance_m))
            .collect::<Vec<_>>()
    };
    world.prism_obstacles().into_iter().flat_map(of_prism).collect()
}

/// Obstacles between the body and its load that a taut cable passes through.
fn pierced(model: &Model, world: &World, load: &str, state: &State) -> Vec<Issue> {
    if state.cable_length_m() < model.cable_length_m - LENGTH_TOLERANCE_M {
        return Vec::new();
    }
    let ends_m = [state.position_m, state.load_position_m];
    let outside = |prism: &Prism| ends_m.iter().all(|end_m| prism.signed_distance_in_space_m(*end_m) > 0.0);
    let crossed = world.prism_obstacles().into_iter().filter(|it| outside(it) && passes_through(it, ends_m));
    let issue = |prism: Prism| {
        let found = format!("a cable that passes through `{}`", prism.name);
        Issue::new(load, found, "a taut cable outside every obstacle").remedy("move the vehicle or the obstacle")
    };
    crossed.map(issue).collect()
}

/// Whether a point of the segment is inside, up to 10 µm. No distance changes by more than the point moves.
fn passes_through(prism: &Prism, [a_m, b_m]: [[f64; 3]; 2]) -> bool {
    let middle_m: [f64; 3] = std::array::from_fn(|axis| f64::midpoint(a_m[axis], b_m[axis]));
    let half_m = (0..3).map(|axis| (b_m[axis] - middle_m[axis]).powi(2)).sum::<f64>().sqrt();
    let distance_m = prism.signed_distance_in_space_m(middle_m);
    if distance_m < 0.0 {
        return true;
    }
    if distance_m > half_m || half_m < 1e-5 || distance_m.is_nan() {
        return false;
    }
    passes_through(prism, [a_m, middle_m]) || passes_through(prism, [middle_m, b_m])
}

/// A load that overlaps the disc of the level body.
fn inside_body(model: &Model, load: &str, state: &State) -> Option<Issue> {
    let [x_m, y_m, z_m]: [f64; 3] = std::array::from_fn(|axis| state.load_position_m[axis] - state.position_m[axis]);
    let beyond_m = (x_m.hypot(y_m) - model.body_radius_m()).max(0.0);
    let clearance_m = beyond_m.hypot(z_m) - model.load_radius_m;
    (clearance_m < 0.0).then(|| {
        let found = format!("a load that overlaps the body of the quadrotor by {:.4} m", -clearance_m);
        let expected = format!("at least {} m, the radius of the load, from the body's disc", model.load_radius_m);
        Issue::new(load, found, expected).remedy("move the load or the quadrotor")
    })
}
