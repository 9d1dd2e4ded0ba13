//! Tables whose numbers were rounded when they were written.
//!
//! Differences of rounded rows are noise if the rows are dense: positions with four decimals, 10 ms apart, have second
//! differences of several m/s² that no vehicle flew. Of such a table only so many rows are kept that rounding contributes
//! little to an acceleration; those in between must lie on the motion through the others, up to their rounding.

use nalgebra::Vector3;
use scenarios::in_loop::Node;
use scenarios::multirotor::State;
use sim::multirotor::Reference;

use crate::verdict::RoundedRows;
use crate::verdict::reconstruction::{max_distance_from_chord_m, max_velocity_from_chord_mps};

/// Numbers with more decimals than this were not rounded.
const MAX_DECIMALS: usize = 9;
/// Kept rows are at most about this far apart, s; rows farther apart are not thinned.
const MAX_INTERVAL_S: f64 = 0.5;
/// Number of successive steps whose median speed is the speed there.
const MEDIAN_STEPS: usize = 5;
/// What rounding may contribute to an acceleration, as a fraction of its limit.
const MAX_NOISE: f64 = 0.02;

/// Half a unit in the last decimal of a table's numbers; 0 for numbers that were not rounded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rounding {
    /// Of a coordinate, m, the motion during the rounding of the time included.
    pub position_m: f64,
    /// Of a component of the velocity, m/s.
    pub velocity_mps: f64,
}

impl Rounding {
    /// The rounding of a table.
    ///
    /// - `velocities_mps`: empty if the table has none
    pub fn of(times_s: &[f64], positions_m: &[[f64; 3]], velocities_mps: &[[f64; 3]]) -> Self {
        let steps = positions_m.windows(2).zip(times_s.windows(2)).filter(|(_, times_s)| times_s[0] < times_s[1]);
        let speeds_mps: Vec<f64> = steps
            .map(|(p, times_s)| (Vector3::from(p[1]) - Vector3::from(p[0])).norm() / (times_s[1] - times_s[0]))
            .collect();
        let fastest_mps = fastest_mps(&speeds_mps);
        Self {
            position_m: half_unit(positions_m.iter().flatten()) + time_rounding_s(times_s) * fastest_mps,
            velocity_mps: half_unit(velocities_mps.iter().flatten()),
        }
    }

    /// What it may contribute to the acceleration of a cubic between two rows, m/s².
    fn noise_mps2(&self, interval_s: f64) -> f64 {
        12.0 * self.position_m / (interval_s * interval_s) + 6.0 * self.velocity_mps / interval_s
    }

    /// The rows to keep.
    ///
    /// - `acceleration_mps2`: what the vehicle can do
    /// - `is_between`: whether all rows between two rows lie on the motion through these two
    ///
    /// Returns `None` if rounding is no matter.
    pub fn rows_to_keep(
        &self,
        times_s: &[f64],
        acceleration_mps2: f64,
        is_between: impl Fn(usize, usize) -> bool,
    ) -> Option<Vec<usize>> {
        let max_noise_mps2 = MAX_NOISE * acceleration_mps2;
        let last = times_s.len() - 1;
        let mean_interval_s = (times_s[last] - times_s[0]) / last as f64;
        if mean_interval_s >= MAX_INTERVAL_S || self.noise_mps2(mean_interval_s) <= max_noise_mps2 {
            return None;
        }
        let is_long = |from: usize, to: usize| {
            let interval_s = times_s[to] - times_s[from];
            interval_s >= MAX_INTERVAL_S || self.noise_mps2(interval_s) <= max_noise_mps2
        };
        let is_jump = |row: usize| row < last && times_s[row] == times_s[row + 1];
        let mut kept = vec![0];
        while let Some(&from) = kept.last().filter(|row| **row < last) {
            let end = (from + 1..last).find(|to| is_jump(*to) || is_long(from, *to)).unwrap_or(last);
            // What is left at the end joins the last interval.
            let end = if (end..last).any(is_jump) || is_long(end, last) { end } else { last };
            let lengths = std::iter::successors(Some(end - from), |length| Some(length / 2));
            let fitting = lengths.take_while(|length| *length > 1).find(|length| is_between(from, from + length));
            kept.push(from + fitting.unwrap_or(1));
        }
        Some(kept)
    }

    /// What the report says of a thinned table.
    pub fn rows(&self, given: usize, kept: usize) -> RoundedRows {
        RoundedRows { given, kept, rounding_m: self.position_m }
    }

    /// Whether the rows between two rows lie on the cubic through these two, up to the rounding of all of them.
    pub fn is_on_cubic(&self, times_s: &[f64], states: &[State], from: usize, to: usize) -> bool {
        let node = |row: usize| Node {
            t_s: times_s[row],
            position_m: states[row].position_m,
            velocity_mps: states[row].velocity_mps,
        };
        let interval_s = times_s[to] - times_s[from];
        let tolerance_m = 3.0 * self.position_m + self.velocity_mps * interval_s / 4.0;
        let tolerance_mps = 3.0 * self.position_m / interval_s + 3.0 * self.velocity_mps;
        let cubic = Reference::new(vec![node(from), node(to)]);
        (from + 1..to).all(|row| {
            let on_cubic = cubic.at(times_s[row]);
            (on_cubic.position_m - Vector3::from(states[row].position_m)).amax() <= tolerance_m
                && (on_cubic.velocity_mps - Vector3::from(states[row].velocity_mps)).amax() <= tolerance_mps
        })
    }

    /// Whether the vehicle can have been at the rows between two rows, up to the rounding of all of them.
    ///
    /// - `acceleration_mps2`: what the vehicle can do
    /// - `velocities_mps`: empty if the table has none
    pub fn is_within_reach(
        &self,
        times_s: &[f64],
        positions_m: &[[f64; 3]],
        velocities_mps: &[[f64; 3]],
        acceleration_mps2: f64,
        [from, to]: [usize; 2],
    ) -> bool {
        let interval_s = times_s[to] - times_s[from];
        let [begin_m, end_m] = [from, to].map(|row| Vector3::from(positions_m[row]));
        let chord_mps = (end_m - begin_m) / interval_s;
        // The ends of the chord and the row in between are rounded, in three coordinates each.
        let rounding_m = 2.0 * 3.0_f64.sqrt() * self.position_m;
        let rounding_mps = 3.0_f64.sqrt() * (2.0 * self.position_m / interval_s + self.velocity_mps);
        (from + 1..to).all(|row| {
            let u = (times_s[row] - times_s[from]) / interval_s;
            let off_m = (Vector3::from(positions_m[row]) - begin_m - chord_mps * (u * interval_s)).norm();
            let off_mps = velocities_mps.get(row).map_or(0.0, |given| (Vector3::from(*given) - chord_mps).norm());
            off_m <= max_distance_from_chord_m(acceleration_mps2, interval_s, u) + rounding_m
                && off_mps <= max_velocity_from_chord_mps(acceleration_mps2, interval_s, u) + rounding_mps
                && self.is_smooth_at(row, times_s, positions_m, velocities_mps, acceleration_mps2)
        })
    }

    /// Whether a row fits its two neighbours, up to rounding: the mean velocities of the intervals before and after it differ by
    /// a (h_1 + h_2)/2 at most, and given velocities by a h_1.
    fn is_smooth_at(
        &self,
        row: usize,
        times_s: &[f64],
        positions_m: &[[f64; 3]],
        velocities_mps: &[[f64; 3]],
        acceleration_mps2: f64,
    ) -> bool {
        let [before_s, after_s] = [times_s[row] - times_s[row - 1], times_s[row + 1] - times_s[row]];
        let slope_mps = |end: usize, duration_s: f64| {
            (Vector3::from(positions_m[end]) - Vector3::from(positions_m[end - 1])) / duration_s
        };
        let turn_mps = (slope_mps(row + 1, after_s) - slope_mps(row, before_s)).norm();
        let rounding_mps = 2.0 * 3.0_f64.sqrt() * self.position_m * (1.0 / before_s + 1.0 / after_s);
        let change_mps = velocities_mps
            .get(row)
            .map_or(0.0, |given_mps| (Vector3::from(*given_mps) - Vector3::from(velocities_mps[row - 1])).norm());
        turn_mps <= acceleration_mps2 * (before_s + after_s) / 2.0 + rounding_mps
            && change_mps <= acceleration_mps2 * before_s + 2.0 * 3.0_f64.sqrt() * self.velocity_mps
    }
}

/// The highest speed of a table, as the median of [`MEDIAN_STEPS`] successive steps: a single row that is off, which has two
/// steps, does not widen the tolerance by which it is judged.
fn fastest_mps(speeds_mps: &[f64]) -> f64 {
    let median = |steps: &[f64]| {
        let mut sorted = steps.to_vec();
        sorted.sort_by(f64::total_cmp);
        sorted[(sorted.len() - 1) / 2]
    };
    speeds_mps.windows(MEDIAN_STEPS.min(speeds_mps.len()).max(1)).map(median).fold(0.0, f64::max)
}

/// Half a unit of the last decimal that any of the numbers has; 0 without numbers.
fn half_unit<'a>(values: impl Iterator<Item = &'a f64>) -> f64 {
    match values.map(|value| decimals(*value)).max() {
        Some(decimals @ 0..=MAX_DECIMALS) => 0.5 * 10_f64.powi(-(decimals as i32)),
        _ => 0.0,
    }
}

/// Decimals of the shortest text that reads as this number.
fn decimals(value: f64) -> usize {
    format!("{value}").split_once('.').map_or(0, |(_, decimals)| decimals.len())
}

/// Rounding of times that should be evenly spaced and are so up to one unit of the last decimal; 0 for others, s.
fn time_rounding_s(times_s: &[f64]) -> f64 {
    let half_unit_s = half_unit(times_s.iter());
    let intervals_s = times_s.windows(2).map(|pair| pair[1] - pair[0]).filter(|interval_s| *interval_s > 0.0);
    let (shortest_s, longest_s) =
        intervals_s.fold((f64::INFINITY, 0.0_f64), |(low, high), it| (low.min(it), high.max(it)));
    let jitter_s = longest_s - shortest_s;
    if jitter_s > 0.1 * half_unit_s && jitter_s < 2.2 * half_unit_s { half_unit_s } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_of_the_shortest_text_tell_the_rounding() {
        assert_eq!(half_unit([1.25, 3.0, -0.5].iter()), 0.005);
        assert_eq!(half_unit([1.0, 20.0].iter()), 0.5);
        assert_eq!(half_unit([1.0 / 3.0, 2.0].iter()), 0.0);
        assert_eq!(half_unit([].iter()), 0.0);
    }

    #[test]
    fn even_times_are_exact_and_jitter_of_one_unit_is_rounding() {
        let even: Vec<f64> = (0..100).map(|k| f64::from(k) / 100.0).collect();
        assert_eq!(time_rounding_s(&even), 0.0);
        let rounded: Vec<f64> = (0..100).map(|k| (f64::from(k) / 120.0 * 1000.0).round() / 1000.0).collect();
        assert_eq!(time_rounding_s(&rounded), 0.0005);
        assert_eq!(time_rounding_s(&[0.0, 1.0, 2.5, 4.0]), 0.0);
    }

    /// Rows of x = sin t with four decimals, every 10 ms.
    fn rounded_sine() -> (Vec<f64>, Vec<State>) {
        let four = |value: f64| (value * 1e4).round() / 1e4;
        let times_s: Vec<f64> = (0..=500).map(|k| f64::from(k) / 100.0).collect();
        let state =
            |t_s: &f64| State { position_m: [four(t_s.sin()), 0.0, 2.0], velocity_mps: [four(t_s.cos()), 0.0, 0.0] };
        let states = times_s.iter().map(state).collect();
        (times_s, states)
    }

    fn kept(times_s: &[f64], states: &[State]) -> Option<Vec<usize>> {
        let positions_m: Vec<_> = states.iter().map(|state| state.position_m).collect();
        let velocities_mps: Vec<_> = states.iter().map(|state| state.velocity_mps).collect();
        let rounding = Rounding::of(times_s, &positions_m, &velocities_mps);
        rounding.rows_to_keep(times_s, 5.0, |from, to| rounding.is_on_cubic(times_s, states, from, to))
    }

    #[test]
    fn a_rounded_table_is_thinned_and_keeps_its_ends() {
        let (times_s, states) = rounded_sine();
        let kept = kept(&times_s, &states).expect("rounding matters");
        assert_eq!((kept.first(), kept.last()), (Some(&0), Some(&500)));
        assert!(kept.len() < 80, "{} rows", kept.len());
    }

    #[test]
    fn rows_off_the_motion_are_kept() {
        let (times_s, mut states) = rounded_sine();
        states[250].position_m[1] = 0.01;
        assert!(kept(&times_s, &states).expect("rounding matters").contains(&250));
    }

    /// Stamps in ms of rows at 120 Hz, at 10 m/s: 5 mm, and not the 18 m of a step of 300 m.
    #[test]
    fn a_row_that_is_off_does_not_widen_its_own_tolerance() {
        let times_s: Vec<f64> = (0..=600).map(|k| (f64::from(k) / 120.0 * 1000.0).round() / 1000.0).collect();
        let mut positions_m: Vec<[f64; 3]> = (0..=600).map(|k| [f64::from(k) / 12.0, 0.0, 2.0]).collect();
        for row in [0, 300, 600] {
            positions_m[row][1] = 300.0;
        }
        let position_m = Rounding::of(&times_s, &positions_m, &[]).position_m;
        assert!((0.005..0.006).contains(&position_m), "{position_m}");
        assert_eq!(fastest_mps(&[]), 0.0);
        assert_eq!(fastest_mps(&[3.0]), 3.0);
    }

    #[test]
    fn exact_and_sparse_tables_are_left_alone() {
        let (times_s, states) = rounded_sine();
        let exact: Vec<State> = times_s
            .iter()
            .map(|t| State { position_m: [t.sin(), 0.0, 2.0], velocity_mps: [t.cos(), 0.0, 1.0 / 3.0] })
            .collect();
        assert_eq!(kept(&times_s, &exact), None);
        let sparse = |k: usize| k * 20;
        let times: Vec<f64> = (0..=25).map(|k| times_s[sparse(k)]).collect();
        let states: Vec<State> = (0..=25).map(|k| states[sparse(k)]).collect();
        assert_eq!(kept(&times, &states), None);
    }
}
