//! Four segments at once against an obstacle: the inner loop of every swarm.

use super::Obstacle;
use crate::lanes::{Lanes, Vector};

/// A length below which a segment is a point, m².
const POINT_M2: f64 = 1e-18;

/// Bound from below of the distance of four segments to `obstacle`, m, as [`Obstacle::least_distance_m`]: each from `p`
/// to `q`. Distances above `horizon_m` need not be exact: something between `horizon_m` and the distance comes back.
#[inline(always)]
pub fn least_distance_m<S: Vector>(
    obstacle: &Obstacle,
    p: &[Lanes<S>; 3],
    q: &[Lanes<S>; 3],
    horizon_m: f64,
) -> Lanes<S> {
    let far = distance_to_circle_m(obstacle, p, q);
    let horizon = far.like(horizon_m);
    if !horizon.is_above(far).any() {
        return far;
    }
    let beside = planar_distance_m(obstacle, p, q) - far.like(obstacle.round_m());
    let [low, high] = obstacle.altitude_m();
    if low == f64::NEG_INFINITY && high == f64::INFINITY {
        return beside;
    }
    let above = (far.like(low) - p[2].max(q[2])).max(p[2].min(q[2]) - far.like(high));
    let zero = far.like(0.0);
    let diagonal = beside.mul_add(beside, above * above).sqrt();
    let is_diagonal = beside.min(above).is_above(zero);
    is_diagonal.select(diagonal, beside.max(above))
}

/// Bound from below by circles around obstacle and segment, in the plane.
#[inline(always)]
fn distance_to_circle_m<S: Vector>(obstacle: &Obstacle, p: &[Lanes<S>; 3], q: &[Lanes<S>; 3]) -> Lanes<S> {
    let ([x, y], radius_m) = obstacle.circle();
    let half = p[0].like(0.5);
    let (dx, dy) = ((q[0] - p[0]) * half, (q[1] - p[1]) * half);
    let (mx, my) = (p[0] + dx - half.like(x), p[1] + dy - half.like(y));
    let reach = dx.mul_add(dx, dy * dy).sqrt();
    mx.mul_add(mx, my * my).sqrt() - reach - half.like(radius_m)
}

#[inline(always)]
fn planar_distance_m<S: Vector>(obstacle: &Obstacle, p: &[Lanes<S>; 3], q: &[Lanes<S>; 3]) -> Lanes<S> {
    let zero = p[0].like(0.0);
    let one = zero.like(1.0);
    let (dx, dy) = (q[0] - p[0], q[1] - p[1]);
    let length2 = dx.mul_add(dx, dy * dy);
    let is_segment = length2.is_above(zero.like(POINT_M2));
    let per_length2 = is_segment.select(length2.recip(), zero);
    let mut nearest2 = zero.like(f64::INFINITY);
    let mut apart = zero.like(if obstacle.is_cylinder() { f64::INFINITY } else { f64::NEG_INFINITY });
    let (mut leftmost, mut rightmost) = (zero.like(f64::NEG_INFINITY), zero.like(f64::INFINITY));
    for edge in obstacle.edges() {
        let [x, y] = edge.corner.map(|coordinate| zero.like(coordinate));
        let [nx, ny] = edge.normal.map(|component| zero.like(component));
        let length = zero.like(edge.length_m);
        let (px, py, qx, qy) = (p[0] - x, p[1] - y, q[0] - x, q[1] - y);
        // heights of both ends above the edge's line
        let (hp, hq) = (nx.mul_add(px, ny * py), nx.mul_add(qx, ny * qy));
        apart = apart.max(hp.min(hq));
        // ends to edge
        let (sp, sq) = (nx.mul_add(py, -(ny * px)), nx.mul_add(qy, -(ny * qx)));
        let (bp, bq) = (sp - sp.max(zero).min(length), sq - sq.max(zero).min(length));
        nearest2 = nearest2.min(hp.mul_add(hp, bp * bp)).min(hq.mul_add(hq, bq * bq));
        // corner to segment
        let share = (-(px.mul_add(dx, py * dy)) * per_length2).max(zero).min(one);
        let (cx, cy) = (share.mul_add(dx, px), share.mul_add(dy, py));
        nearest2 = nearest2.min(cx.mul_add(cx, cy * cy));
        let side = dy.mul_add(px, -(dx * py));
        leftmost = leftmost.max(side);
        rightmost = rightmost.min(side);
    }
    let across = rightmost.max(-leftmost) * per_length2.sqrt();
    let apart = is_segment.select(apart.max(across), apart);
    apart.is_above(zero).select(nearest2.sqrt(), apart)
}
