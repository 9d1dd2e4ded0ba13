//! A formula about certain vehicles.

use scenarios::requirement::{Formula, Predicate, Signal, Target, Term};

use crate::verdict::requirements::interval::Interval;
use crate::verdict::requirements::scene::Scene;

/// A formula, a vehicle for each of its variables, and the time during which all bodies that it names move.
#[derive(Clone)]
pub struct Instance<'a> {
    pub formula: &'a Formula,
    pub scene: &'a Scene<'a>,
    /// The vehicle of every variable.
    pub assigned: Vec<usize>,
    /// Beginning and end, s.
    pub lifetime_s: [f64; 2],
    /// Of every predicate, what must not be negative.
    differences: Vec<Term>,
}

impl<'a> Instance<'a> {
    /// `None` if the bodies have no time in common.
    pub fn new(formula: &'a Formula, scene: &'a Scene<'a>, assigned: &[usize]) -> Option<Self> {
        let mut named: Vec<usize> = Vec::new();
        formula.each_signal(&mut |signal| named.extend(bodies_of(signal, scene, assigned)));
        let whole = scene.bodies.iter().map(|body| body.lifetime_s());
        let longest = whole.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])?;
        let of_named = named.iter().map(|&body| scene.bodies[body].lifetime_s());
        let common = of_named.reduce(|a, b| [a[0].max(b[0]), a[1].min(b[1])]).unwrap_or(longest);
        let differences = formula.predicates.iter().map(difference).collect();
        let instance = Self { formula, scene, assigned: assigned.to_vec(), lifetime_s: common, differences };
        (common[0] < common[1]).then_some(instance)
    }

    /// Bounds of the robustness of a predicate over the cell, in its unit: positive where it holds. Then the part of their
    /// width that no refinement takes away.
    ///
    /// - `predicate`: its index in the formula
    pub fn robustness(&self, predicate: usize, cell: [f64; 2]) -> (Interval, f64) {
        let unit_size = self.formula.predicates[predicate].unit_size;
        let (difference, error) = self.bounds(&self.differences[predicate], cell);
        (Interval::new(difference.min / unit_size, difference.max / unit_size), 2.0 * error / unit_size)
    }

    /// Names of the bodies and obstacles that a predicate is about, each once.
    pub fn concerned(&self, predicate: &Predicate) -> Vec<String> {
        let mut names: Vec<String> = Vec::new();
        let mut add = |name: &str| {
            if !names.iter().any(|known| known == name) {
                names.push(name.to_owned());
            }
        };
        for side in &predicate.sides {
            side.each_signal(&mut |signal| {
                let bodies = bodies_of(signal, self.scene, &self.assigned);
                bodies.into_iter().for_each(|body| add(self.scene.bodies[body].name()));
                match &signal.target {
                    Some(Target::Obstacle(name)) => add(name),
                    Some(Target::Geofence(index)) => add(&self.scene.geofences[*index].name),
                    _ => {}
                }
            });
        }
        names
    }
}

/// The larger side of a predicate less the smaller one.
fn difference(predicate: &Predicate) -> Term {
    let [left, right] = predicate.sides.clone().map(Box::new);
    if predicate.is_greater { Term::Subtract(left, right) } else { Term::Subtract(right, left) }
}

fn bodies_of(signal: &Signal, scene: &Scene<'_>, assigned: &[usize]) -> Vec<usize> {
    let target = match signal.target {
        Some(Target::Body(subject)) => Some(subject),
        _ => None,
    };
    std::iter::once(signal.subject).chain(target).map(|subject| scene.body_of(subject, assigned)).collect()
}
