//! Distances of four segments at once from an obstacle: the inner loop of every sampler.

use super::Obstacle;
use crate::simd::{Lanes, Simd4};

/// Squared length below which a segment counts as a point, m².
const MIN_SEGMENT_M2: f64 = 1e-18;

/// Lower bounds of the distances of four segments from `obstacle`, m, as by [`Obstacle::distance_lower_bound_m`].
///
/// - `p`, `q`: ends of the segments, m
/// - `cutoff_m`: bounds above it need not be tight; a bound between `cutoff_m` and the distance is returned instead
#[inline(always)]
pub fn distance_lower_bound_m<S: Simd4>(
    obstacle: &Obstacle,
    p: &[Lanes<S>; 3],
    q: &[Lanes<S>; 3],
    cutoff_m: f64,
) -> Lanes<S> {
    let far = bounding_circle_distance_m(obstacle, p, q);
    let cutoff = far.like(cutoff_m);
    if !cutoff.is_above(far).any() {
        return far;
    }
    let horizontal = planar_distance_m(obstacle, p, q) - far.like(obstacle.rounding_radius_m());
    let [low, high] = obstacle.altitude_m();
    if low == f64::NEG_INFINITY && high == f64::INFINITY {
        return horizontal;
    }
    let vertical = (far.like(low) - p[2].max(q[2])).max(p[2].min(q[2]) - far.like(high));
    let zero = far.like(0.0);
    let diagonal = horizontal.mul_add(horizontal, vertical * vertical).sqrt();
    let is_diagonal = horizontal.min(vertical).is_above(zero);
    is_diagonal.select(diagonal, horizontal.max(vertical))
}

/// Lower bound in the plane by the bounding circles of obstacle and segment.
#[inline(always)]
fn bounding_circle_distance_m<S: Simd4>(obstacle: &Obstacle, p: &[Lanes<S>; 3], q: &[Lanes<S>; 3]) -> Lanes<S> {
    let ([x, y], radius_m) = obstacle.bounding_circle();
    let half = p[0].like(0.5);
    let (dx, dy) = ((q[0] - p[0]) * half, (q[1] - p[1]) * half);
    let (mx, my) = (p[0] + dx - half.like(x), p[1] + dy - half.like(y));
    let radius = dx.mul_add(dx, dy * dy).sqrt();
    mx.mul_add(mx, my * my).sqrt() - radius - half.like(radius_m)
}

/// Distances in the plane, as by `Obstacle::planar_distance_m`.
#[inline(always)]
fn planar_distance_m<S: Simd4>(obstacle: &Obstacle, p: &[Lanes<S>; 3], q: &[Lanes<S>; 3]) -> Lanes<S> {
    let zero = p[0].like(0.0);
    let one = zero.like(1.0);
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    let length2 = dx.mul_add(dx, dy * dy);
    let is_segment = length2.is_above(zero.like(MIN_SEGMENT_M2));
    let inverse_length2 = is_segment.select(length2.recip(), zero);
    let mut nearest2 = zero.like(f64::INFINITY);
    let mut separation = zero.like(if obstacle.is_cylinder() { f64::INFINITY } else { f64::NEG_INFINITY });
    let (mut max_offset, mut min_offset) = (zero.like(f64::NEG_INFINITY), zero.like(f64::INFINITY));
    for edge in obstacle.edges() {
        let [x, y] = edge.corner.map(|coordinate| zero.like(coordinate));
        let [nx, ny] = edge.normal.map(|component| zero.like(component));
        let length = zero.like(edge.length_m);
        let (px, py, qx, qy) = (p[0] - x, p[1] - y, q[0] - x, q[1] - y);
        // signed distances of both ends from the edge's line
        let (hp, hq) = (nx.mul_add(px, ny * py), nx.mul_add(qx, ny * qy));
        separation = separation.max(hp.min(hq));
        // segment ends to edge
        let (sp, sq) = (nx.mul_add(py, -(ny * px)), nx.mul_add(qy, -(ny * qx)));
        let (bp, bq) = (sp - sp.max(zero).min(length), sq - sq.max(zero).min(length));
        nearest2 = nearest2.min(hp.mul_add(hp, bp * bp)).min(hq.mul_add(hq, bq * bq));
        // corner to segment
        let fraction = (-(px.mul_add(dx, py * dy)) * inverse_length2).max(zero).min(one);
        let (cx, cy) = (fraction.mul_add(dx, px), fraction.mul_add(dy, py));
        nearest2 = nearest2.min(cx.mul_add(cx, cy * cy));
        let offset = dy.mul_add(px, -(dx * py));
        max_offset = max_offset.max(offset);
        min_offset = min_offset.min(offset);
    }
    let normal_separation = min_offset.max(-max_offset) * inverse_length2.sqrt();
    let separation = is_segment.select(separation.max(normal_separation), separation);
    separation.is_above(zero).select(nearest2.sqrt(), separation)
}
