//! Priorities of the vehicles (Xu, Wang, Cao, Sun, Long 2022, eq. 14-17).
//!
//! A vehicle with a short flight has more freedom to deviate: it ranks lower and avoids the vehicles above it. The
//! paper keeps a relation between pairs, and swaps a pair when the order of its flight times has changed by more than a
//! threshold. Pairwise swaps can create a cycle (three vehicles, where only the first and the last differ by more than
//! the threshold). Here the relation is a ranking of all vehicles in which only neighbours are swapped, until no pair
//! of neighbours is left to swap. It is a strict total order at all times, so a cycle is impossible.

use rand::RngExt;

/// A ranking of the fleet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Priority {
    /// Vehicles, the highest first.
    order: Vec<usize>,
    /// Rank of every vehicle, 0 for the highest.
    rank: Vec<usize>,
}

impl Priority {
    /// Ranks longer flights higher; ties are broken at random by `seed`.
    pub fn new(flight_times_s: &[f64], seed: u64) -> Self {
        let mut order: Vec<usize> = (0..flight_times_s.len()).collect();
        let mut rng = scenarios::stream(seed, "scp/priority");
        let tie_breaks: Vec<f64> = order.iter().map(|_| rng.random()).collect();
        order.sort_by(|&a, &b| {
            flight_times_s[b].total_cmp(&flight_times_s[a]).then(tie_breaks[a].total_cmp(&tie_breaks[b]))
        });
        let mut priority = Self { rank: vec![0; order.len()], order };
        priority.update_ranks();
        priority
    }

    /// Does i avoid j, that is, does j rank higher?
    pub fn avoids(&self, i: usize, j: usize) -> bool {
        self.rank[j] < self.rank[i]
    }

    /// The vehicles, the highest first.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// Updates the ranking: neighbours are swapped where the flight of the higher one is shorter by more than
    /// `threshold_s`.
    pub fn update(&mut self, flight_times_s: &[f64], threshold_s: f64) {
        // every swap moves a longer flight up, so their number is finite
        for end in 1..self.order.len() {
            for rank in (1..=end).rev() {
                let [upper, lower] = [self.order[rank - 1], self.order[rank]];
                if flight_times_s[lower] - flight_times_s[upper] > threshold_s {
                    self.order.swap(rank - 1, rank);
                } else {
                    break;
                }
            }
        }
        self.update_ranks();
    }

    fn update_ranks(&mut self) {
        for (rank, &vehicle) in self.order.iter().enumerate() {
            self.rank[vehicle] = rank;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longer_flights_rank_higher() {
        let priority = Priority::new(&[150.0, 200.0, 180.0], 0);
        assert_eq!(priority.order(), [1, 2, 0]);
        assert!(priority.avoids(0, 1) && priority.avoids(0, 2) && priority.avoids(2, 1));
        assert!(!priority.avoids(1, 0) && !priority.avoids(0, 0));
    }

    #[test]
    fn equal_flights_are_ordered_by_the_seed() {
        let flights_s = [171.0; 20];
        let order = |seed| Priority::new(&flights_s, seed).order().to_vec();
        assert_eq!(order(1), order(1));
        assert_ne!(order(1), order(2));
    }

    #[test]
    fn order_stays_within_the_threshold_and_swaps_beyond_it() {
        let mut priority = Priority::new(&[200.0, 190.0], 0);
        priority.update(&[200.0, 200.4], 0.5);
        assert_eq!(priority.order(), [0, 1]);
        priority.update(&[200.0, 200.6], 0.5);
        assert_eq!(priority.order(), [1, 0]);
        priority.update(&[200.0, 200.0], 0.5);
        assert_eq!(priority.order(), [1, 0]);
    }

    #[test]
    fn a_chain_within_the_threshold_does_not_create_a_cycle() {
        // pairwise, only the first and the last would swap: a cycle
        let mut priority = Priority::new(&[12.0, 11.0, 10.0], 0);
        priority.update(&[10.0, 10.9, 11.8], 1.0);
        assert_eq!(priority.order(), [0, 1, 2]);
    }

    #[test]
    fn any_history_leaves_a_strict_total_order() {
        let mut rng = scenarios::stream(7, "test/priority");
        let n = 12;
        let mut flights = || -> Vec<f64> { (0..n).map(|_| 190.0 + 20.0 * rng.random::<f64>()).collect() };
        let mut priority = Priority::new(&flights(), 3);
        for _ in 0..200 {
            let flights_s = flights();
            priority.update(&flights_s, 2.0);
            for i in 0..n {
                assert!(!priority.avoids(i, i));
                for j in 0..n {
                    assert!(i == j || priority.avoids(i, j) != priority.avoids(j, i));
                    for k in 0..n {
                        assert!(!(priority.avoids(i, j) && priority.avoids(j, k)) || priority.avoids(i, k));
                    }
                }
            }
            let neighbours = priority.order().windows(2);
            assert!(neighbours.clone().all(|pair| flights_s[pair[1]] - flights_s[pair[0]] <= 2.0), "{priority:?}");
        }
    }
}
