//! Signals and terms over a cell of time, as [`Jet`]s.

use scenarios::Geofence;
use scenarios::geometry::{Solid, TerrainGrid};
use scenarios::requirement::{Quantity, Signal, Target, Term};

use crate::verdict::requirements::body::Enclosure;
use crate::verdict::requirements::instance::Instance;
use crate::verdict::requirements::interval::{Interval, Jet, angle, dot, norm};
use crate::verdict::requirements::scene::Shape;

impl Instance<'_> {
    /// Bounds of a term over the cell, SI units and radians: those of the function itself, and what the slope leaves of them
    /// around the value in the middle.
    ///
    /// Returns the bounds, and how far the true motion may move the term: what no refinement takes away.
    pub fn bounds(&self, term: &Term, cell: [f64; 2]) -> (Interval, f64) {
        let jet = self.term(term, cell);
        let middle_s = 0.5 * (cell[0] + cell[1]);
        let radius_s = 0.5 * (cell[1] - cell[0]);
        let bounds = if radius_s > 0.0 && jet.slope.magnitude().is_finite() {
            let centred = self.term(term, [middle_s, middle_s]).value + jet.slope * Interval::within(radius_s);
            jet.value.intersection(centred)
        } else {
            jet.value
        };
        (bounds.widened(jet.error), jet.error)
    }

    fn term(&self, term: &Term, cell: [f64; 2]) -> Jet {
        let of = |term: &Term| self.term(term, cell);
        let clock = Jet { value: Interval::new(cell[0], cell[1]), slope: Interval::point(1.0), error: 0.0 };
        match term {
            Term::Constant(value) => Jet::constant(*value),
            Term::Time => clock,
            Term::TimeLeft => Jet::constant(self.lifetime_s[1]).plus(clock.negate()),
            Term::Signal(signal) => self.signal(signal, cell),
            Term::Negate(a) => of(a).negate(),
            Term::Absolute(a) => of(a).abs(),
            Term::Add(a, b) => of(a).plus(of(b)),
            Term::Subtract(a, b) => of(a).plus(of(b).negate()),
            Term::Multiply(a, b) => of(a).times(of(b)),
            Term::Divide(a, b) => of(a).times(of(b).reciprocal()),
            Term::Minimum(a, b) => of(a).minimum(of(b)),
            Term::Maximum(a, b) => of(a).maximum(of(b)),
        }
    }

    fn signal(&self, signal: &Signal, cell: [f64; 2]) -> Jet {
        let body = self.scene.body_of(signal.subject, &self.assigned);
        if signal.quantity.is_logged() {
            return Jet::rough(self.scene.logged(signal.quantity, body, cell), 0.0);
        }
        let it = self.scene.bodies[body].over(cell);
        let jet = match signal.quantity {
            Quantity::Distance | Quantity::HorizontalDistance => self.distance(signal, body, &it, cell),
            Quantity::Inside => match signal.target {
                Some(Target::Geofence(index)) => self.to_volume(&self.scene.geofences[index], body, &it, cell),
                _ => Jet::rough(Interval::ALL, 0.0),
            },
            Quantity::Swing => {
                let load = self.scene.bodies[self.scene.scenario.vehicles.len()].over(cell);
                swing(&relative(&load, &self.scene.bodies[0].over(cell)))
            }
            Quantity::Height => match self.scene.terrain() {
                Some(terrain) => above_terrain(terrain, &it),
                None => {
                    let ground_m = self.scene.scenario.world.ground_m.unwrap_or(f64::NAN);
                    coordinate(&it, 2).plus(Jet::constant(-ground_m))
                }
            },
            _ => of_motion(signal, &it),
        };
        if it.jumps { Jet { slope: Interval::ALL, ..jet } } else { jet }
    }

    fn distance(&self, signal: &Signal, body: usize, it: &Enclosure, cell: [f64; 2]) -> Jet {
        let is_horizontal = signal.quantity == Quantity::HorizontalDistance;
        let scene = self.scene;
        let to_body = |other: usize| range(&relative(it, &scene.bodies[other].over(cell)), is_horizontal);
        let to_obstacle = |index: usize| self.to_obstacle(&scene.obstacles[index].shape, is_horizontal, body, it, cell);
        let nearest = |distances: &mut dyn Iterator<Item = Jet>| {
            distances.reduce(Jet::minimum).unwrap_or(Jet::rough(Interval::point(f64::INFINITY), 0.0))
        };
        match &signal.target {
            Some(Target::Point(point_m)) => range(&from_point(it, *point_m), is_horizontal),
            Some(Target::Goal) => {
                let goal_m = scene.scenario.vehicles[body.min(scene.scenario.vehicles.len() - 1)].goal.position_m();
                range(&from_point(it, goal_m), is_horizontal)
            }
            Some(Target::Body(subject)) => to_body(scene.body_of(*subject, &self.assigned)),
            Some(Target::Obstacle(name)) => {
                nearest(&mut scene.obstacles.iter().position(|it| it.name == *name).into_iter().map(to_obstacle))
            }
            Some(Target::AnyObstacle) => nearest(&mut (0..scene.obstacles.len()).map(to_obstacle)),
            Some(Target::AnyVehicle) => {
                let others = (0..scene.scenario.vehicles.len()).filter(|other| *other != body);
                let alive = others.filter_map(|other| {
                    let [begin_s, end_s] = scene.bodies[other].lifetime_s();
                    let common = [cell[0].max(begin_s), cell[1].min(end_s)];
                    let is_whole = common == cell;
                    (common[0] <= common[1]).then(|| {
                        let other = scene.bodies[other].over(common);
                        let jet = range(&relative(it, &other), is_horizontal);
                        // After the other has ended, it is at no distance.
                        let gone = Interval::new(jet.value.min, f64::INFINITY);
                        if is_whole { jet } else { Jet::rough(gone, jet.error) }
                    })
                });
                nearest(&mut { alive })
            }
            _ => Jet::rough(Interval::ALL, 0.0),
        }
    }

    fn to_obstacle(&self, shape: &Shape<'_>, is_horizontal: bool, body: usize, it: &Enclosure, cell: [f64; 2]) -> Jet {
        match shape {
            Shape::Cylinder(cylinder) => {
                let [x, y] = cylinder.center_m;
                range(&from_point(it, [x, y, 0.0]), true).plus(Jet::constant(-cylinder.radius_m))
            }
            Shape::Prism(volumes) => self.to_volume(&volumes[usize::from(is_horizontal)], body, it, cell),
            Shape::Solid(solid) => self.to_solid(solid, is_horizontal, body, it, cell),
            Shape::Moving(cylinders) => {
                // Neither the vehicle nor the obstacle moves farther than its speed takes it.
                let cylinder = &cylinders[usize::from(is_horizontal)];
                let (middle_s, radius_s) = (0.5 * (cell[0] + cell[1]), 0.5 * (cell[1] - cell[0]));
                let middle_m = it.position.map(|axis| 0.5 * (axis.min + axis.max));
                let extent_m = norm(&it.position.map(|axis| Interval::within(0.5 * axis.width()))).max;
                let distance_m = cylinder.signed_distance_m(middle_s, middle_m);
                let reach_m = extent_m + cylinder.speed_mps.abs() * radius_s;
                let value = Interval::point(distance_m) + Interval::within(reach_m);
                let slope = Interval::within(norm(&it.velocity).max + cylinder.speed_mps.abs());
                Jet { value, slope, error: it.errors[0] }
            }
        }
    }

    /// The distance changes by no more than the body moves. Seen from above it is not known.
    fn to_solid(&self, solid: &Solid, is_horizontal: bool, body: usize, it: &Enclosure, cell: [f64; 2]) -> Jet {
        if is_horizontal {
            return Jet::rough(Interval::ALL, 0.0);
        }
        let hull_m = self.scene.bodies[body].hull_m(cell);
        let centre_m: [f64; 3] =
            std::array::from_fn(|axis| hull_m.iter().map(|point| point[axis]).sum::<f64>() / hull_m.len() as f64);
        let offset_m = |point: &[f64; 3]| (0..3).map(|axis| (point[axis] - centre_m[axis]).powi(2)).sum::<f64>().sqrt();
        let radius_m = hull_m.iter().map(offset_m).fold(0.0, f64::max);
        let value = Interval::point(solid.signed_distance_m(centre_m)) + Interval::within(radius_m);
        Jet { value, slope: Interval::within(norm(&it.velocity).max), error: it.errors[0] }
    }

    fn to_volume(&self, volume: &Geofence, body: usize, it: &Enclosure, cell: [f64; 2]) -> Jet {
        let bounds = volume.margin_bounds_m(&self.scene.bodies[body].hull_m(cell));
        let slope = Interval::within(norm(&it.velocity).max);
        Jet { value: Interval::new(bounds.min, bounds.max), slope, error: it.errors[0] }
    }
}

/// Of position, velocity and acceleration of one body.
fn of_motion(signal: &Signal, it: &Enclosure) -> Jet {
    let horizontal = |vector: &[Interval; 3]| norm(&vector[..2]);
    let speed = |axes: std::ops::Range<usize>| {
        let velocity = &it.velocity[axes.clone()];
        let value = norm(velocity);
        let acceleration = &it.acceleration[axes];
        let slope = (dot(velocity, acceleration) / value).intersection(Interval::within(norm(acceleration).max));
        Jet { value, slope, error: it.errors[1] }
    };
    // A velocity turns by no more than its change over its magnitude. At rest it may have any direction.
    let turning = |value: Interval, velocity: &[Interval], acceleration: &[Interval], range: Interval| {
        let speed = norm(velocity);
        let certain_mps = speed.min - it.errors[1];
        if certain_mps <= 0.0 {
            return Jet::rough(range, f64::INFINITY).inside(range);
        }
        let (error, slope) = (1.6 * it.errors[1] / certain_mps, norm(acceleration).max / speed.min);
        Jet { value, slope: Interval::within(slope), error }.inside(range)
    };
    match signal.quantity {
        Quantity::East => coordinate(it, 0),
        Quantity::North => coordinate(it, 1),
        Quantity::Altitude => coordinate(it, 2),
        Quantity::ClimbRate => Jet { value: it.velocity[2], slope: it.acceleration[2], error: it.errors[1] },
        Quantity::Speed => speed(0..3),
        Quantity::GroundSpeed => speed(0..2),
        Quantity::FlightPath => {
            let [climb, forward] = [it.velocity[2], horizontal(&it.velocity)];
            let upward = |climb: Interval| angle(climb.maximum(Interval::point(0.0)), forward);
            let range = Interval::within(std::f64::consts::FRAC_PI_2);
            turning(upward(climb) - upward(-climb), &it.velocity, &it.acceleration, range)
        }
        Quantity::HeadingFrom => {
            let Some(Target::Bearing(bearing_rad)) = signal.target else { return Jet::rough(Interval::ALL, 0.0) };
            let [along, across] = [bearing_rad.cos(), bearing_rad.sin()].map(Interval::point);
            let [east, north, _] = it.velocity;
            let value = angle(east * across - north * along, east * along + north * across);
            turning(value, &it.velocity[..2], &it.acceleration[..2], Interval::new(0.0, std::f64::consts::PI))
        }
        Quantity::Acceleration => Jet::rough(norm(&it.acceleration), it.errors[2]),
        _ => Jet::rough(Interval::ALL, 0.0),
    }
}

fn coordinate(it: &Enclosure, axis: usize) -> Jet {
    Jet { value: it.position[axis], slope: it.velocity[axis], error: it.errors[0] }
}

/// The altitude above a terrain. Beyond its edges it is not known.
fn above_terrain(terrain: &TerrainGrid, it: &Enclosure) -> Jet {
    let [x_m, y_m] = [0, 1].map(|axis| [it.position[axis].min, it.position[axis].max]);
    let Some([low_m, high_m]) = terrain.height_range_m(x_m, y_m) else { return Jet::rough(Interval::ALL, 0.0) };
    let steepest = terrain.steepest();
    let climb_mps = it.velocity[2] + Interval::within(steepest * norm(&it.velocity[..2]).max);
    let value = it.position[2] - Interval::new(low_m, high_m);
    Jet { value, slope: climb_mps, error: (1.0 + steepest) * it.errors[0] }
}

/// One body as seen from another.
fn relative(one: &Enclosure, other: &Enclosure) -> Enclosure {
    let difference = |a: &[Interval; 3], b: &[Interval; 3]| std::array::from_fn(|axis| a[axis] - b[axis]);
    Enclosure {
        position: difference(&one.position, &other.position),
        velocity: difference(&one.velocity, &other.velocity),
        acceleration: difference(&one.acceleration, &other.acceleration),
        errors: std::array::from_fn(|order| one.errors[order] + other.errors[order]),
        jumps: one.jumps || other.jumps,
    }
}

fn from_point(it: &Enclosure, point_m: [f64; 3]) -> Enclosure {
    let position = std::array::from_fn(|axis| it.position[axis] - Interval::point(point_m[axis]));
    Enclosure { position, ..it.clone() }
}

/// The distance from the origin.
fn range(relative: &Enclosure, is_horizontal: bool) -> Jet {
    let axes = if is_horizontal { 0..2 } else { 0..3 };
    let (position, velocity) = (&relative.position[axes.clone()], &relative.velocity[axes]);
    let value = norm(position);
    let slope = (dot(position, velocity) / value).intersection(Interval::within(norm(velocity).max));
    let slope = if relative.jumps { Interval::ALL } else { slope };
    Jet { value, slope, error: relative.errors[0] }
}

/// The angle between the relative position of the load and straight down.
fn swing(load: &Enclosure) -> Jet {
    let (distance_m, speed_mps) = (norm(&load.position), norm(&load.velocity).max);
    let value = angle(norm(&load.position[..2]), -load.position[2]);
    let slope = if distance_m.min > 0.0 { speed_mps / distance_m.min } else { f64::INFINITY };
    let error = 1.6 * load.errors[0] / (distance_m.min - load.errors[0]).max(f64::MIN_POSITIVE);
    let slope = if load.jumps { Interval::ALL } else { Interval::within(slope) };
    Jet { value, slope, error }.inside(Interval::new(0.0, std::f64::consts::PI))
}
