//! Closest approach over continuous time: of two vehicles, of vehicles and cylinders, of a vehicle and a point.
//!
//! The squared distance of two cubics is a polynomial of degree 6 in time, and [`bernstein::minimise`] bounds its
//! smallest value. One search runs over all segments with the best distance so far, so that a segment, or a whole
//! [block](super::broad_phase) of them, that is farther away costs one look at a box.

mod cylinder;
mod search;

use std::ops::Range;

use rayon::prelude::*;
use scenarios::{Cylinder, SeparationMeasure};
use search::{Bound, Search};

use crate::verdict::broad_phase::{Block, Blocks, Frame};
use crate::verdict::motion::{Motion, Segment};

/// A smallest distance over continuous time, with bounds: the true one lies in [`lower_m`, `upper_m`]. Of curves they are
/// 1e-9 m apart or less, except where rounding allows no more (two vehicles meeting at a point: 1e-7 m); of motions that
/// are known up to a [deviation](Motion::deviation_m), farther by twice that.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestApproach {
    /// No distance is smaller, m.
    pub lower_m: f64,
    /// A distance that is reached at `at_s`, m.
    pub upper_m: f64,
    /// When, s.
    pub at_s: f64,
    /// Who: two vehicles, or a vehicle and an obstacle, by their indices.
    pub who: [usize; 2],
}

impl ClosestApproach {
    /// The smallest distance of two searches.
    pub fn closer(self, other: Self) -> Self {
        let upper_m = self.upper_m.min(other.upper_m);
        let closer = if other.lower_m < self.lower_m { other } else { self };
        Self { upper_m, ..closer }
    }
}

/// Smallest distance between any two of `motions` while both last. `None` with fewer than two.
pub fn between_vehicles(motions: &[Motion], measure: SeparationMeasure) -> Option<ClosestApproach> {
    let radii_m = vec![0.0; motions.len()];
    bounded(motions, |bound| sweep(motions, &radii_m, Search::new(bound), measure))
}

/// The deepest overlap, in space, of any two of `motions` while both last, each a ball of its radius: a negative distance.
/// `None` if no two touch.
pub fn overlap(motions: &[Motion], radii_m: &[f64]) -> Option<ClosestApproach> {
    sweep(motions, radii_m, Search::below(0.0, Bound::Curve), SeparationMeasure::Spatial)
}

/// Smallest signed horizontal distance from any of `motions`, balls of `radii_m`, to the surface of any of `cylinders`,
/// negative inside. `None` without either.
pub fn to_cylinders(motions: &[Motion], radii_m: &[f64], cylinders: &[Cylinder]) -> Option<ClosestApproach> {
    let frame = Frame::over(motions);
    bounded(motions, |bound| {
        let mut search = Search::new(bound);
        for (i, (motion, body_m)) in motions.iter().zip(radii_m).enumerate() {
            let blocks = Blocks::new(motion, &frame);
            for (m, cylinder) in cylinders.iter().enumerate() {
                let axis = [cylinder.center_m[0], cylinder.center_m[1], 0.0];
                let radius_m = cylinder.radius_m + body_m;
                let reach_m = bound.max_reach_m(radius_m, motion);
                let near = |search: &Search, block: &Block| {
                    search.may_be_within(block.gap_to_point_m(cylinder.center_m), reach_m)
                };
                for block in blocks.iter() {
                    if near(&search, block) {
                        for segment in block.segments.clone().map(|index| motion.segment(index)).filter(Segment::lasts)
                        {
                            let relative = horizontal(segment.points_m.map(|point| difference(&point, &axis)));
                            search.look(&relative, &segment, radius_m, [i, m]);
                        }
                    }
                }
            }
        }
        search.found()
    })
}

/// The bounds of a smallest distance. Of reconstructed motions the upper one needs a search of its own: the place where the
/// vehicle may be nearest is not the one where it certainly is.
fn bounded(motions: &[Motion], search: impl Fn(Bound) -> Option<ClosestApproach>) -> Option<ClosestApproach> {
    let closest = search(Bound::Possible)?;
    if !motions.iter().any(Motion::is_reconstructed) {
        return Some(closest);
    }
    let certain = search(Bound::Certain)?;
    Some(ClosestApproach { upper_m: closest.upper_m.min(certain.upper_m), ..closest })
}

/// The smallest distance between any two of `motions`, balls of `radii_m`.
///
/// Block by block in time, a sweep from west to east: a pair is looked at only if its boxes are nearer to each other in
/// x than the best so far, so that the cost grows with the number of neighbours, not with that of pairs.
fn sweep(
    motions: &[Motion],
    radii_m: &[f64],
    mut search: Search,
    measure: SeparationMeasure,
) -> Option<ClosestApproach> {
    let frame = Frame::over(motions);
    let of_motion: Vec<Blocks> = motions.par_iter().map(|motion| Blocks::new(motion, &frame)).collect();
    let reaches_m: Vec<f64> =
        motions.iter().zip(radii_m).map(|(motion, &radius_m)| search.bound().max_reach_m(radius_m, motion)).collect();
    let horizontal = measure.scale()[0];
    let widest_m = 2.0 * reaches_m.iter().copied().fold(0.0, f64::max);
    for index in 0..frame.count() {
        let blocks: Vec<&Block> = of_motion.iter().map(|of_motion| &of_motion[index]).collect();
        let mut eastward: Vec<usize> = (0..motions.len()).filter(|&i| !blocks[i].segments.is_empty()).collect();
        eastward.sort_by(|&i, &j| blocks[i].west_m().total_cmp(&blocks[j].west_m()));
        for (place, &i) in eastward.iter().enumerate() {
            for &j in &eastward[place + 1..] {
                if !search.may_be_within(horizontal * (blocks[j].west_m() - blocks[i].east_m()), widest_m) {
                    break;
                }
                let who = [i.min(j), i.max(j)];
                if search.may_be_within(horizontal * blocks[i].gap_m(blocks[j]), reaches_m[i] + reaches_m[j]) {
                    let segments = who.map(|i| blocks[i].segments.clone());
                    each_common_span(who.map(|i| &motions[i]), segments, |relative_m, span| {
                        search.look_at_pair(&relative_m, span, radii_m[i] + radii_m[j], who, measure);
                    });
                }
            }
        }
    }
    search.found()
}

/// Smallest distance, in space, from `motion` to `point_m` between two times, s. `None` if it does not last until the first.
pub fn to_point(motion: &Motion, [from_s, to_s]: [f64; 2], point_m: [f64; 3]) -> Option<ClosestApproach> {
    let mut search = Search::new(Bound::Curve);
    for segment in motion.segments().filter(|segment| segment.t_s[1] > from_s && segment.t_s[0] < to_s) {
        let part = segment.during(segment.t_s[0].max(from_s), segment.t_s[1].min(to_s));
        search.look(&part.points_m.map(|point| difference(&point, &point_m)), &part, 0.0, [0, 0]);
    }
    search.found()
}

fn difference(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn horizontal(points_m: [[f64; 3]; 4]) -> [[f64; 3]; 4] {
    points_m.map(|[x, y, _]| [x, y, 0.0])
}

/// Calls `look` with the motion of the first of two vehicles relative to the second, for each span of time in which neither
/// goes on to its next segment. The deviation of the span is that of both together.
fn each_common_span(
    [first, second]: [&Motion; 2],
    [mut a, mut b]: [Range<usize>; 2],
    mut look: impl FnMut([[f64; 3]; 4], &Segment),
) {
    while a.start < a.end && b.start < b.end {
        let (one, other) = (first.segment(a.start), second.segment(b.start));
        let (from_s, to_s) = (one.t_s[0].max(other.t_s[0]), one.t_s[1].min(other.t_s[1]));
        if from_s < to_s {
            let (one, other) = (one.during(from_s, to_s), other.during(from_s, to_s));
            let span = Segment { deviation_m: one.deviation_m + other.deviation_m, ..one };
            look(std::array::from_fn(|k| difference(&one.points_m[k], &other.points_m[k])), &span);
        }
        let (one_end_s, other_end_s) = (one.t_s[1], other.t_s[1]);
        a.start += usize::from(one_end_s <= other_end_s);
        b.start += usize::from(other_end_s <= one_end_s);
    }
}

#[cfg(test)]
mod tests {
    use scenarios::{Cylinder, SeparationMeasure};

    use super::{ClosestApproach, between_vehicles, to_cylinders, to_point};
    use crate::verdict::motion::{Knot, Motion};
    use crate::verdict::random::Uniform;

    /// p = p0 + v t, with knots every `step_s` until `end_s`.
    fn line(position_m: [f64; 3], velocity_mps: [f64; 3], step_s: f64, end_s: f64) -> Motion {
        let steps = (end_s / step_s).round() as usize;
        let knot = |step: usize| {
            let t_s = if step == steps { end_s } else { step as f64 * step_s };
            let position_m = std::array::from_fn(|axis| position_m[axis] + velocity_mps[axis] * t_s);
            Knot { t_s, position_m, velocity_mps }
        };
        Motion::new("uav", (0..=steps).map(knot).collect()).unwrap()
    }

    fn assert_is(approach: &ClosestApproach, distance_m: f64, at_s: f64) {
        assert!(approach.lower_m <= distance_m + 1e-12 && distance_m <= approach.upper_m + 1e-9, "{approach:?}");
        assert!(approach.upper_m - approach.lower_m <= 1e-9, "{approach:?}");
        assert!((approach.at_s - at_s).abs() < 1e-4, "{approach:?}, not {at_s} s");
    }

    /// (-700, 0) + (35, 0) t and (0, -710) + (0, 35) t: relative (-700, 710) + (35, -35) t, nearest at 705/35 s,
    /// where it is (5, 5). On grids of any step, the same or not.
    #[test]
    fn crossing_lines_meet_where_geometry_says_on_any_grid() {
        for (one_s, other_s) in [(0.01, 0.01), (0.01, 0.03), (40.0, 40.0), (40.0, 0.7), (7.3, 5.1)] {
            let crossing = [
                line([-700.0, 0.0, 300.0], [35.0, 0.0, 0.0], one_s, 40.0),
                line([0.0, -710.0, 500.0], [0.0, 35.0, 1.0], other_s, 40.0),
            ];
            assert_is(
                &between_vehicles(&crossing, SeparationMeasure::Horizontal).unwrap(),
                50.0_f64.sqrt(),
                705.0 / 35.0,
            );
        }
    }

    #[test]
    fn three_vehicles_have_their_nearest_pair_named() {
        let north = |y_m| line([0.0, y_m, 0.0], [30.0, 0.0, 0.0], 0.05, 10.0);
        let nearest =
            between_vehicles(&[north(0.0), north(170.0), north(300.0)], SeparationMeasure::Horizontal).unwrap();
        assert_eq!(nearest.who, [1, 2]);
        assert!(between_vehicles(&[north(0.0)], SeparationMeasure::Horizontal).is_none());
    }

    /// Two lines 10 m apart, of which one is known up to 2 m: 8 m are possible, 12 m certain.
    #[test]
    fn one_motion_in_a_tube_widens_the_bounds_of_a_pair() {
        let exact = line([0.0; 3], [30.0, 0.0, 0.0], 0.5, 10.0);
        let tube = line([0.0, 10.0, 0.0], [30.0, 0.0, 0.0], 0.5, 10.0).within(|_| 2.0);
        for pair in [[exact.clone(), tube.clone()], [tube, exact]] {
            let found = between_vehicles(&pair, SeparationMeasure::Spatial).unwrap();
            assert!((found.lower_m - 8.0).abs() < 1e-6 && (found.upper_m - 12.0).abs() < 1e-6, "{found:?}");
        }
    }

    #[test]
    fn vehicles_are_compared_while_both_last() {
        // At 10 s they would meet; the second motion ends at 8 s, 40 m earlier.
        let first = line([-100.0, 0.0, 0.0], [10.0, 0.0, 0.0], 0.1, 20.0);
        let second = line([100.0, 0.0, 0.0], [-10.0, 0.0, 0.0], 0.1, 8.0);
        assert_is(&between_vehicles(&[first, second], SeparationMeasure::Horizontal).unwrap(), 40.0, 8.0);
    }

    #[test]
    fn a_line_passes_a_cylinder_at_its_offset() {
        let cylinder = |x_m, y_m, radius_m| Cylinder { name: "pillar".to_owned(), center_m: [x_m, y_m], radius_m };
        let motion = [line([0.0, 0.0, 50.0], [35.0, 0.0, 0.0], 0.05, 20.0)];
        let pillars = [cylinder(350.0, 420.0, 400.0), cylinder(100.0, -30.0, 5.0)];
        assert_is(&to_cylinders(&motion, &[0.0], &pillars).unwrap(), 20.0, 10.0);
        assert_eq!(to_cylinders(&motion, &[0.0], &pillars).unwrap().who, [0, 0]);
        // Inside a large one, a small one is never nearer.
        let nested = [cylinder(351.0, 3.0, 1.0), cylinder(350.0, 4.0, 400.0)];
        assert_is(&to_cylinders(&motion, &[1.0], &nested).unwrap(), -397.0, 10.0);
        assert!(to_cylinders(&motion, &[0.0], &[]).is_none());
    }

    #[test]
    fn a_goal_is_passed_in_space_and_inside_the_window() {
        let motion = line([0.0, 0.0, 50.0], [35.0, 0.0, 0.0], 0.05, 20.0);
        assert_is(&to_point(&motion, [0.0, 20.0], [350.0, 3.0, 54.0]).unwrap(), 5.0, 10.0);
        assert_is(&to_point(&motion, [12.025, 20.0], [350.0, 0.0, 50.0]).unwrap(), 70.875, 12.025);
        assert!(to_point(&motion, [20.0, 30.0], [350.0, 0.0, 50.0]).is_none());
        assert_is(&to_point(&motion, [0.0, 6.0], [350.0, 0.0, 50.0]).unwrap(), 350.0 - 35.0 * 6.0, 6.0);
    }

    /// Knots at random times, places and velocities.
    fn wild(uniform: &mut Uniform) -> Motion {
        let mut t_s = 0.0;
        let knots = (0..40).map(|_| {
            let position_m = std::array::from_fn(|_| uniform.between(-60.0, 60.0));
            let velocity_mps = std::array::from_fn(|_| uniform.between(-50.0, 50.0));
            let knot = Knot { t_s, position_m, velocity_mps };
            t_s += uniform.between(0.1, 2.0);
            knot
        });
        Motion::new("uav", knots.collect()).unwrap()
    }

    #[test]
    fn no_sample_of_wild_motions_is_nearer_than_the_bound() {
        let mut uniform = Uniform::seeded(3);
        for round in 0..40 {
            let motions: Vec<Motion> = (0..3).map(|_| wild(&mut uniform)).collect();
            let nearest = between_vehicles(&motions, SeparationMeasure::Horizontal).unwrap();
            let distance_at = |i: usize, j: usize, t_s: f64| {
                let (a, b) = (motions[i].position_m(t_s)?, motions[j].position_m(t_s)?);
                Some((a[0] - b[0]).hypot(a[1] - b[1]))
            };
            let mut sampled = f64::INFINITY;
            for step in 0..40_000 {
                for (i, j) in [(0, 1), (0, 2), (1, 2)] {
                    sampled = distance_at(i, j, f64::from(step) * 0.002).unwrap_or(f64::INFINITY).min(sampled);
                }
            }
            assert!(sampled >= nearest.lower_m - 1e-9, "round {round}: {sampled} below {nearest:?}");
            let taken = distance_at(nearest.who[0], nearest.who[1], nearest.at_s).unwrap();
            assert!((taken - nearest.upper_m).abs() < 1e-6, "round {round}: {taken}, {nearest:?}");
        }
    }
}
