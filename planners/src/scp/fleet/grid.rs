//! Broad phase of the conflict detection: pairs of nearby discs by a uniform grid.

use std::collections::HashMap;

use nalgebra::Vector2;

/// A disc that contains the motion of a vehicle during a time slice.
#[derive(Clone, Copy, Debug)]
pub struct Disc {
    /// Centre, m.
    pub center_m: Vector2<f64>,
    /// Radius, m.
    pub radius_m: f64,
}

impl Disc {
    /// Distance between two discs, m; negative if they overlap.
    pub fn gap_m(&self, other: &Self) -> f64 {
        let offset_m = self.center_m - other.center_m;
        offset_m.x.hypot(offset_m.y) - self.radius_m - other.radius_m
    }
}

/// All pairs (i < j) of discs less than `reach_m` apart, in ascending order of i, then of j. Vehicles that have arrived
/// have no disc.
///
/// A cell is as wide as the largest distance between the centres of two discs that are near each other, so all
/// neighbours of a disc lie in nine cells: the cost grows with the number of near pairs, not with that of all pairs.
pub fn near_pairs(discs: &[Option<Disc>], reach_m: f64) -> Vec<[usize; 2]> {
    let max_radius_m = discs.iter().flatten().map(|disc| disc.radius_m).fold(0.0, f64::max);
    let cell_m = reach_m + 2.0 * max_radius_m;
    let cell = |disc: &Disc| <[f64; 2]>::from(disc.center_m).map(|center| (center / cell_m).floor() as i64);
    let mut cells: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
    for (i, disc) in discs.iter().enumerate() {
        if let Some(disc) = disc {
            cells.entry(cell(disc)).or_default().push(i);
        }
    }
    let mut pairs = Vec::new();
    for (i, disc) in discs.iter().enumerate() {
        let Some(disc) = disc else { continue };
        let first = pairs.len();
        let [column, row] = cell(disc);
        for neighbour in (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [column + dx, row + dy])) {
            let others = cells.get(&neighbour).map_or(&[][..], Vec::as_slice);
            let is_near = |j: &&usize| **j > i && discs[**j].is_some_and(|other| disc.gap_m(&other) < reach_m);
            pairs.extend(others.iter().filter(is_near).map(|j| [i, *j]));
        }
        pairs[first..].sort_unstable();
    }
    pairs
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;

    #[test]
    fn agrees_with_the_test_of_all_pairs() {
        let mut rng = scenarios::stream(1, "test/grid");
        for reach_m in [0.5, 30.0, 400.0] {
            let mut coordinate = || 2000.0 * (rng.random::<f64>() - 0.5);
            let discs: Vec<Option<Disc>> = (0..150)
                .map(|i| {
                    let disc = Disc {
                        center_m: Vector2::new(coordinate(), coordinate()),
                        radius_m: coordinate().abs() / 20.0,
                    };
                    (i % 7 != 0).then_some(disc)
                })
                .collect();
            let mut expected = Vec::new();
            for i in 0..discs.len() {
                for j in i + 1..discs.len() {
                    if let (Some(a), Some(b)) = (discs[i], discs[j])
                        && a.gap_m(&b) < reach_m
                    {
                        expected.push([i, j]);
                    }
                }
            }
            assert!(!expected.is_empty());
            assert_eq!(near_pairs(&discs, reach_m), expected);
        }
    }
}
