use nalgebra::{Vector2, Vector3};
use scenarios::Cylinder;

use crate::collision::time_of_impact;
use crate::flight::Sample;
use crate::obstacles::Obstacles as OtherObstacles;

/// First contact of two aircraft, or of an aircraft and an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Collision {
    /// Index of the step in the time chunk, from 0.
    pub step: usize,
    /// Time within that step, as a fraction in [0, 1].
    pub fraction: f64,
    /// Index of the aircraft; the smaller one of two.
    pub aircraft: usize,
    /// What it collides with.
    pub with: Obstacle,
}

/// What an aircraft collides with, by its index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Obstacle {
    Aircraft(usize),
    Cylinder(usize),
    Other(usize),
    Ground,
}

/// What aircraft collide with, beside each other.
pub(super) struct Obstacles<'a> {
    pub cylinders: &'a [Cylinder],
    /// Those of all other shapes, at rest.
    pub others: OtherObstacles,
    /// Altitude of the ground, if there is one, m.
    pub ground_m: Option<f64>,
}

/// Path of a ball over a time chunk: straight from one sample to the next, as the simulator moves it.
#[derive(Clone, Copy)]
pub(super) struct SweptPath<'a> {
    pub aircraft: usize,
    pub radius_m: f64,
    pub samples: &'a [Sample],
}

/// All collisions within a time chunk, in the order of time, then of the aircraft. Each pair appears with its first
/// contact only. Contacts between two steps are found, too.
///
/// Candidate pairs are found by sweep and prune along x.
pub(super) fn collisions(paths: &[SweptPath<'_>], obstacles: &Obstacles<'_>) -> Vec<Collision> {
    let mut swept: Vec<BoundedPath<'_>> = paths.iter().map(|path| BoundedPath::new(*path)).collect();
    swept.sort_by(|a, b| a.west_m().total_cmp(&b.west_m()));
    let mut found: Vec<Collision> = Vec::new();
    for (rank, first) in swept.iter().enumerate() {
        let overlapping = swept[rank + 1..].iter().take_while(|other| other.west_m() <= first.east_m());
        found.extend(overlapping.filter_map(|second| first.collision(second)));
        let cylinders = obstacles.cylinders.iter().enumerate();
        found.extend(cylinders.filter_map(|(index, cylinder)| first.collision_with_cylinder(index, cylinder)));
        found.extend(first.collision_with_others(&obstacles.others));
        found.extend(obstacles.ground_m.and_then(|ground_m| first.collision_with_ground(ground_m)));
    }
    let when = |collision: &Collision| collision.step as f64 + collision.fraction;
    found.sort_by(|a, b| when(a).total_cmp(&when(b)).then(a.aircraft.cmp(&b.aircraft)));
    found
}

/// A path and a ball that contains it.
struct BoundedPath<'a> {
    path: SweptPath<'a>,
    center_m: Vector3<f64>,
    reach_m: f64,
}

impl<'a> BoundedPath<'a> {
    fn new(path: SweptPath<'a>) -> Self {
        let center_m = position_m(&path.samples[0]);
        let distances_m = path.samples.iter().map(|sample| (position_m(sample) - center_m).norm());
        Self { path, center_m, reach_m: distances_m.fold(0.0, f64::max) + path.radius_m }
    }

    fn west_m(&self) -> f64 {
        self.center_m.x - self.reach_m
    }

    fn east_m(&self) -> f64 {
        self.center_m.x + self.reach_m
    }

    fn collision(&self, other: &Self) -> Option<Collision> {
        if (self.center_m - other.center_m).norm() > self.reach_m + other.reach_m {
            return None;
        }
        let (a, b) = if self.path.aircraft < other.path.aircraft { (self, other) } else { (other, self) };
        let relative_m = |index: usize| position_m(&a.path.samples[index]) - position_m(&b.path.samples[index]);
        let reach_m = a.path.radius_m + b.path.radius_m;
        let (step, fraction) =
            self.first_step(|step| time_of_impact(&relative_m(step), &relative_m(step + 1), reach_m))?;
        Some(Collision { step, fraction, aircraft: a.path.aircraft, with: Obstacle::Aircraft(b.path.aircraft) })
    }

    fn collision_with_cylinder(&self, index: usize, cylinder: &Cylinder) -> Option<Collision> {
        let center_m = Vector2::from(cylinder.center_m);
        if (self.center_m.xy() - center_m).norm() > self.reach_m + cylinder.radius_m {
            return None;
        }
        let axis_m = Vector3::new(center_m.x, center_m.y, 0.0);
        let relative_m = |index: usize| horizontal(&(position_m(&self.path.samples[index]) - axis_m));
        let reach_m = self.path.radius_m + cylinder.radius_m;
        let (step, fraction) =
            self.first_step(|step| time_of_impact(&relative_m(step), &relative_m(step + 1), reach_m))?;
        Some(Collision { step, fraction, aircraft: self.path.aircraft, with: Obstacle::Cylinder(index) })
    }

    /// The first contact with an obstacle of another shape.
    fn collision_with_others(&self, others: &OtherObstacles) -> Option<Collision> {
        let is_near = |other| others.distance_m(other, 0.0, self.center_m.into()) <= self.reach_m;
        if !(0..others.count()).any(is_near) {
            return None;
        }
        let ends_m = |step: usize| [step, step + 1].map(|index| position_m(&self.path.samples[index]));
        let contact = |step: usize| others.time_of_impact([0.0, 1.0], ends_m(step), self.path.radius_m);
        let (step, (fraction, other)) =
            (0..self.path.samples.len() - 1).find_map(|step| Some((step, contact(step)?)))?;
        Some(Collision { step, fraction, aircraft: self.path.aircraft, with: Obstacle::Other(other) })
    }

    fn collision_with_ground(&self, ground_m: f64) -> Option<Collision> {
        if self.center_m.z - self.reach_m > ground_m {
            return None;
        }
        let height_m = |index: usize| position_m(&self.path.samples[index]).z - self.path.radius_m - ground_m;
        let (step, fraction) = self.first_step(|step| touchdown(height_m(step), height_m(step + 1)))?;
        Some(Collision { step, fraction, aircraft: self.path.aircraft, with: Obstacle::Ground })
    }

    fn first_step(&self, contact: impl Fn(usize) -> Option<f64>) -> Option<(usize, f64)> {
        (0..self.path.samples.len() - 1).find_map(|step| Some((step, contact(step)?)))
    }
}

/// The fraction of a step at which a height that changes linearly from `start_m` to `end_m` reaches 0: 0 if it begins there,
/// `None` if it stays above.
fn touchdown(start_m: f64, end_m: f64) -> Option<f64> {
    if start_m <= 0.0 {
        return Some(0.0);
    }
    (end_m <= 0.0).then(|| start_m / (start_m - end_m))
}

/// The horizontal part of a vector: only that matters for the distance from a vertical cylinder.
fn horizontal(vector: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(vector.x, vector.y, 0.0)
}

fn position_m(sample: &Sample) -> Vector3<f64> {
    Vector3::from(sample.position_m)
}
