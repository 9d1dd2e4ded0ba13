//! Who gives way to whom (Xu, Wang, Cao, Sun, Long 2022, eq. 14-17).
//!
//! A vehicle with a short flight has more room to dodge: it stands lower, and avoids those above it. The paper keeps a
//! relation between pairs and swaps two of them when their flight times have changed sides by more than a threshold.
//! Pair by pair that could close a circle (three vehicles, neighbours within the threshold of each other, the outer two
//! not). Here the relation is one ranking of all vehicles, and only neighbours in it change places, until no two
//! neighbours are left that should: a strict total order at all times, so that the relation can never close a circle.

use rand::RngExt;

/// A ranking of the fleet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Priority {
    /// Vehicles, the highest first.
    order: Vec<usize>,
    /// Place of every vehicle in it.
    rank: Vec<usize>,
}

impl Priority {
    /// Longer flights stand higher; equal ones are ordered at random by `seed`.
    pub fn new(flight_times_s: &[f64], seed: u64) -> Self {
        let mut order: Vec<usize> = (0..flight_times_s.len()).collect();
        let mut rng = scenarios::stream(seed, "scp/priority");
        let lots: Vec<f64> = order.iter().map(|_| rng.random()).collect();
        order.sort_by(|&a, &b| flight_times_s[b].total_cmp(&flight_times_s[a]).then(lots[a].total_cmp(&lots[b])));
        let mut priority = Self { rank: vec![0; order.len()], order };
        priority.count_places();
        priority
    }

    /// Does i avoid j, that is, does j stand above i?
    pub fn avoids(&self, i: usize, j: usize) -> bool {
        self.rank[j] < self.rank[i]
    }

    /// The vehicles, the highest first.
    pub fn order(&self) -> &[usize] {
        &self.order
    }

    /// Takes note of new flight times: two neighbours change places where the upper one's flight is now shorter by more
    /// than `threshold_s`.
    pub fn update(&mut self, flight_times_s: &[f64], threshold_s: f64) {
        // every change moves a longer flight up: there are finitely many
        for end in 1..self.order.len() {
            for place in (1..=end).rev() {
                let [upper, lower] = [self.order[place - 1], self.order[place]];
                if flight_times_s[lower] - flight_times_s[upper] > threshold_s {
                    self.order.swap(place - 1, place);
                } else {
                    break;
                }
            }
        }
        self.count_places();
    }

    fn count_places(&mut self) {
        for (place, &vehicle) in self.order.iter().enumerate() {
            self.rank[vehicle] = place;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longer_flights_stand_higher() {
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
    fn a_chain_within_the_threshold_does_not_close_a_circle() {
        // pair by pair the first and the last would swap, and nobody else: a circle
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
