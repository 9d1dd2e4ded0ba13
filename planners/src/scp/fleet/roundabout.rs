//! Breaks a symmetry that no row can: many who meet at one point at one time.
//!
//! Everybody is then everybody's neighbour on all sides, and the normals of the rows say nothing. Moved to the right, all
//! of them circle the point in one sense. n vehicles that keep R from each other on a circle need a radius of
//! R / (2 sin(π/n)).

use std::f64::consts::PI;

use super::guess::Start;
use super::traffic::{Encounter, Traffic};

/// Vehicles from which on a crowd is more than a few pairs.
const CROWD: usize = 4;

/// Share of all pairs of a crowd that must be in conflict.
const DENSE: f64 = 0.5;

/// Radius over the smallest possible one.
const ROOMY: f64 = 1.25;

/// A place where many meet.
#[derive(Clone, Debug)]
pub struct Crowd {
    /// Who.
    pub vehicles: Vec<usize>,
    /// When, s.
    pub at_s: f64,
}

/// Moves everybody in a crowd to his right.
pub fn bow(starts: &mut [Start], crowds: &[Crowd], wanted_m: f64) {
    for crowd in crowds {
        let radius_m = ROOMY * wanted_m / (2.0 * (PI / crowd.vehicles.len() as f64).sin());
        for &who in &crowd.vehicles {
            let length_m = starts[who].route.length_m();
            let peak_m = length_m * (crowd.at_s / starts[who].flight_time_s).clamp(0.2, 0.8);
            starts[who].route = starts[who].route.bowed(-radius_m, peak_m, length_m);
        }
    }
}

/// Groups of vehicles most of whose pairs come nearer to each other than half of `wanted_m` at about the same time.
pub fn crowds(traffic: &Traffic, wanted_m: f64) -> Vec<Crowd> {
    let encounters = traffic.encounters(0.5 * wanted_m);
    let mut left: Vec<&Encounter> = encounters.iter().collect();
    let mut crowds = Vec::new();
    while let Some(first) = left.first() {
        let group = connected(first, &left);
        let pairs = left.iter().filter(|encounter| encounter.who.iter().all(|who| group.contains(who)));
        let (count, sum_s) = pairs.fold((0, 0.0), |(count, sum_s), encounter| (count + 1, sum_s + encounter.at_s));
        let all = group.len() * (group.len() - 1) / 2;
        if group.len() >= CROWD && count as f64 >= DENSE * all as f64 {
            crowds.push(Crowd { at_s: sum_s / f64::from(count), vehicles: group.clone() });
        }
        left.retain(|encounter| !encounter.who.iter().any(|who| group.contains(who)));
    }
    crowds
}

/// Everybody whom a chain of encounters connects with `first`, ascending.
fn connected(first: &Encounter, encounters: &[&Encounter]) -> Vec<usize> {
    let mut group = first.who.to_vec();
    loop {
        let before = group.len();
        for encounter in encounters {
            let [a, b] = encounter.who.map(|who| group.contains(&who));
            match (a, b) {
                (true, false) => group.push(encounter.who[1]),
                (false, true) => group.push(encounter.who[0]),
                _ => {}
            }
        }
        if group.len() == before {
            group.sort_unstable();
            return group;
        }
    }
}
