use nalgebra::{Vector2, Vector3};
use scenarios::Cylinder;

use crate::Sample;
use crate::collision::{horizontal, time_of_impact};

/// Two aircraft, or an aircraft and a pillar, begin to touch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Collision {
    /// Index of the time_chunk's step, from 0.
    pub step: usize,
    /// When during that step, as a share in [0, 1].
    pub share: f64,
    /// Index of the aircraft; the smaller one of two.
    pub aircraft: usize,
    /// What it touches.
    pub with: Obstacle,
}

/// What an aircraft touches, by its index.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Obstacle {
    Aircraft(usize),
    Pillar(usize),
}

/// The way of a ball on a time_chunk of steps: straight between one sample and the next, as the simulator moves it.
#[derive(Clone, Copy)]
pub(super) struct SweptPath<'a> {
    pub aircraft: usize,
    pub radius_m: f64,
    pub samples: &'a [Sample],
}

/// Everything that touches on a time_chunk, in the order of time, then of the aircraft. Each pair appears with its first
/// touch only. Nothing passes through anything between two steps.
pub(super) fn collisions(ways: &[SweptPath<'_>], pillars: &[Cylinder]) -> Vec<Collision> {
    let mut swept: Vec<Swept<'_>> = ways.iter().map(|way| Swept::by(*way)).collect();
    swept.sort_by(|a, b| a.west_m().total_cmp(&b.west_m()));
    let mut found: Vec<Collision> = Vec::new();
    for (rank, first) in swept.iter().enumerate() {
        let overlapping = swept[rank + 1..].iter().take_while(|other| other.west_m() <= first.east_m());
        found.extend(overlapping.filter_map(|second| first.touch(second)));
        found.extend(pillars.iter().enumerate().filter_map(|(index, pillar)| first.touch_pillar(index, pillar)));
    }
    let when = |collision: &Collision| collision.step as f64 + collision.share;
    found.sort_by(|a, b| when(a).total_cmp(&when(b)).then(a.aircraft.cmp(&b.aircraft)));
    found
}

/// A way within the ball that surely holds all of it.
struct Swept<'a> {
    way: SweptPath<'a>,
    center_m: Vector3<f64>,
    reach_m: f64,
}

impl<'a> Swept<'a> {
    fn by(way: SweptPath<'a>) -> Self {
        let center_m = position_m(&way.samples[0]);
        let distances_m = way.samples.iter().map(|sample| (position_m(sample) - center_m).norm());
        Self { way, center_m, reach_m: distances_m.fold(0.0, f64::max) + way.radius_m }
    }

    fn west_m(&self) -> f64 {
        self.center_m.x - self.reach_m
    }

    fn east_m(&self) -> f64 {
        self.center_m.x + self.reach_m
    }

    fn touch(&self, other: &Self) -> Option<Collision> {
        if (self.center_m - other.center_m).norm() > self.reach_m + other.reach_m {
            return None;
        }
        let (a, b) = if self.way.aircraft < other.way.aircraft { (self, other) } else { (other, self) };
        let relative_m = |index: usize| position_m(&a.way.samples[index]) - position_m(&b.way.samples[index]);
        let reach_m = a.way.radius_m + b.way.radius_m;
        let (step, share) =
            self.first_step(|step| time_of_impact(&relative_m(step), &relative_m(step + 1), reach_m))?;
        Some(Collision { step, share, aircraft: a.way.aircraft, with: Obstacle::Aircraft(b.way.aircraft) })
    }

    fn touch_pillar(&self, index: usize, pillar: &Cylinder) -> Option<Collision> {
        let center_m = Vector2::from(pillar.center_m);
        if (self.center_m.xy() - center_m).norm() > self.reach_m + pillar.radius_m {
            return None;
        }
        let axis_m = Vector3::new(center_m.x, center_m.y, 0.0);
        let relative_m = |index: usize| horizontal(&(position_m(&self.way.samples[index]) - axis_m));
        let reach_m = self.way.radius_m + pillar.radius_m;
        let (step, share) =
            self.first_step(|step| time_of_impact(&relative_m(step), &relative_m(step + 1), reach_m))?;
        Some(Collision { step, share, aircraft: self.way.aircraft, with: Obstacle::Pillar(index) })
    }

    fn first_step(&self, touch: impl Fn(usize) -> Option<f64>) -> Option<(usize, f64)> {
        (0..self.way.samples.len() - 1).find_map(|step| Some((step, touch(step)?)))
    }
}

fn position_m(sample: &Sample) -> Vector3<f64> {
    Vector3::from(sample.position_m)
}
