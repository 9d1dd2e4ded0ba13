//! Which references are flown. Whether they are safe is for the judge to decide.

use nalgebra::Vector3;
use scenarios::in_loop::Node;
use scenarios::multirotor::Limits;

use crate::multirotor::reference::{Reference, ReferencePoint};

/// Maximum magnitude of a position, m, or velocity, m/s: no map is larger.
const MAX_MAGNITUDE: f64 = 1e6;
/// Maximum number of nodes of a reference.
const MAX_NODES: usize = 100_000;
/// Times that differ by less than this, s, are equal up to rounding.
const SAME_TIME_S: f64 = 1e-9;
/// Factor of the limits within which rounded nodes remain.
const LIMIT_ROUNDING: f64 = 1.01;

/// What a new reference has to continue, and within which limits.
pub(super) struct Continuation {
    /// Time at which a result in time takes effect, s.
    pub takes_effect_s: f64,
    /// Time from the measurement to that time, s.
    pub lead_s: f64,
    /// The reference in force at that time.
    pub expected: ReferencePoint,
    /// Measured position relative to the reference in force, at the time of the measurement, m.
    pub position_error_m: Vector3<f64>,
    /// Measured velocity relative to the reference in force, at the time of the measurement, m/s.
    pub velocity_error_mps: Vector3<f64>,
    /// Physical limits of the vehicle.
    pub limits: Limits,
    /// Step of the simulator, s.
    pub step_s: f64,
}

/// The reason why a reference cannot be flown, if it cannot: it is malformed, begins too late, jumps, or exceeds the
/// limits of the vehicle.
pub(super) fn defect(nodes: &[Node], continuation: &Continuation) -> Option<String> {
    malformation(nodes, continuation.takes_effect_s)
        .or_else(|| jump(nodes, continuation))
        .or_else(|| excess(nodes, continuation))
}

fn malformation(nodes: &[Node], takes_effect_s: f64) -> Option<String> {
    let [first, .., last] = nodes else {
        return Some(format!("{} nodes, at least two are needed", nodes.len()));
    };
    if nodes.len() > MAX_NODES {
        return Some(format!("{} nodes, at most {MAX_NODES} are allowed", nodes.len()));
    }
    let is_valid = |node: &Node| {
        node.t_s.is_finite()
            && node.position_m.iter().chain(&node.velocity_mps).all(|value| value.abs() <= MAX_MAGNITUDE)
    };
    if let Some(node) = nodes.iter().find(|node| !is_valid(node)) {
        return Some(format!(
            "the node at {} s has a number that is not finite or larger than {MAX_MAGNITUDE}",
            node.t_s
        ));
    }
    if let Some(pair) = nodes.windows(2).find(|pair| pair[0].t_s >= pair[1].t_s) {
        return Some(format!("the times must increase, but {} s is followed by {} s", pair[0].t_s, pair[1].t_s));
    }
    if first.t_s > takes_effect_s + SAME_TIME_S {
        return Some(format!("it begins at {:.3} s, after it takes effect at {takes_effect_s:.3} s", first.t_s));
    }
    (last.t_s < takes_effect_s)
        .then(|| format!("it ends at {:.3} s, before it takes effect at {takes_effect_s:.3} s", last.t_s))
}

/// A reference continues the one in force, or the measured state, or anything between the two.
///
/// ```text
/// |p - p_f| <= |e_p| + |e_v| T + v_max h          e: measured minus reference, T: lead time
/// |v - v_f| <= |e_v| + a_max h                    h: step, over which a jump is no more than a motion at the limit
/// ```
fn jump(nodes: &[Node], continuation: &Continuation) -> Option<String> {
    let Continuation { takes_effect_s, lead_s, expected, limits, step_s, .. } = continuation;
    let begin = Reference::new(nodes.to_vec()).at(*takes_effect_s);
    let [error_m, error_mps] =
        [continuation.position_error_m, continuation.velocity_error_mps].map(|error| error.norm());
    let jump_m = (begin.position_m - expected.position_m).norm();
    let allowed_m = error_m + error_mps * lead_s + limits.speed_mps * step_s;
    if jump_m > allowed_m {
        return Some(format!("at {takes_effect_s:.3} s it is {jump_m:.3} m away from the reference in force"));
    }
    let jump_mps = (begin.velocity_mps - expected.velocity_mps).norm();
    let allowed_mps = error_mps + limits.acceleration_mps2 * step_s;
    (jump_mps > allowed_mps).then(|| {
        format!(
            "at {takes_effect_s:.3} s its velocity differs by {jump_mps:.3} m/s from that of the reference in force"
        )
    })
}

/// Speeds at the nodes, mean speeds between them and accelerations of the cubics between them that are beyond the limits of
/// the vehicle. The acceleration of a cubic is linear in time, so that it is largest at an end:
///
/// ```text
/// a_0 = (6 m - 4 v_0 - 2 v_1)/T,   a_1 = (2 v_0 + 4 v_1 - 6 m)/T          m: mean velocity, T: duration
/// ```
fn excess(nodes: &[Node], continuation: &Continuation) -> Option<String> {
    let Continuation { takes_effect_s, limits, .. } = continuation;
    let pairs = nodes.windows(2).filter(|pair| pair[1].t_s > *takes_effect_s);
    let excess_of = |pair: &[Node]| {
        let dt_s = pair[1].t_s - pair[0].t_s;
        let [from_m, to_m] = [0, 1].map(|node| Vector3::from(pair[node].position_m));
        let [from_mps, to_mps] = [0, 1].map(|node| Vector3::from(pair[node].velocity_mps));
        let mean_mps = (to_m - from_m) / dt_s;
        let speed_mps = to_mps.norm().max(mean_mps.norm());
        let begins = (mean_mps * 6.0 - from_mps * 4.0 - to_mps * 2.0) / dt_s;
        let ends = (from_mps * 2.0 + to_mps * 4.0 - mean_mps * 6.0) / dt_s;
        let acceleration_mps2 = begins.norm().max(ends.norm());
        let beyond = |value: f64, limit: f64, unit: &str| {
            let at_s = pair[0].t_s;
            (value > LIMIT_ROUNDING * limit).then(|| {
                format!("after {at_s:.3} s it asks for {value:.3} {unit}, the vehicle's limit is {limit} {unit}")
            })
        };
        beyond(speed_mps, limits.speed_mps, "m/s")
            .or_else(|| beyond(acceleration_mps2, limits.acceleration_mps2, "m/s²"))
    };
    pairs.into_iter().find_map(excess_of)
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { speed_mps: 2.0, acceleration_mps2: 3.0 };

    fn line(times_s: &[f64]) -> Vec<Node> {
        times_s.iter().map(|&t_s| Node { t_s, position_m: [t_s, 0.0, 1.0], velocity_mps: [1.0, 0.0, 0.0] }).collect()
    }

    /// Of a vehicle that flies along [`line`], off by an error, and is to continue at 1 s.
    fn defect_of(nodes: &[Node], error_m: f64, error_mps: f64) -> Option<String> {
        let continuation = Continuation {
            takes_effect_s: 1.0,
            lead_s: 0.1,
            expected: Reference::new(line(&[0.0, 9.0])).at(1.0),
            position_error_m: Vector3::new(0.0, error_m, 0.0),
            velocity_error_mps: Vector3::new(0.0, error_mps, 0.0),
            limits: LIMITS,
            step_s: 0.01,
        };
        defect(nodes, &continuation)
    }

    fn moved(nodes: &[Node], by_m: f64, by_mps: f64) -> Vec<Node> {
        let moved = |node: &Node| {
            let ([x_m, y_m, z_m], [vx, vy, vz]) = (node.position_m, node.velocity_mps);
            Node { position_m: [x_m, y_m + by_m, z_m], velocity_mps: [vx, vy + by_mps, vz], ..*node }
        };
        nodes.iter().map(moved).collect()
    }

    #[test]
    fn a_reference_that_begins_in_time_is_accepted() {
        assert_eq!(defect_of(&line(&[0.9, 1.5, 2.0]), 0.0, 0.0), None);
        assert_eq!(defect_of(&line(&[1.0, 1.5]), 0.0, 0.0), None);
    }

    #[test]
    fn a_jump_is_rejected_unless_it_leads_to_the_measured_state() {
        let nodes = line(&[1.0, 1.5, 2.0]);
        assert_eq!(defect_of(&moved(&nodes, 0.019, 0.0), 0.0, 0.0), None);
        assert!(defect_of(&moved(&nodes, 0.021, 0.0), 0.0, 0.0).unwrap().contains("0.021 m away"));
        assert_eq!(defect_of(&moved(&nodes, 0.2, 0.0), 0.2, 0.0), None);
        assert!(defect_of(&moved(&nodes, 0.3, 0.0), 0.2, 0.0).is_some());
        assert_eq!(defect_of(&moved(&nodes, 0.0, 0.029), 0.0, 0.0), None);
        assert!(defect_of(&moved(&nodes, 0.0, 0.031), 0.0, 0.0).unwrap().contains("0.031 m/s"));
        assert_eq!(defect_of(&moved(&nodes, 0.02, 0.2), 0.0, 0.2), None);
    }

    #[test]
    fn a_reference_beyond_the_limits_is_rejected() {
        let with_end = |t_s: f64, x_m: f64, vx_mps: f64| {
            let end = Node { t_s, position_m: [x_m, 0.0, 1.0], velocity_mps: [vx_mps, 0.0, 0.0] };
            [line(&[0.5, 1.0, 2.0]), vec![end]].concat()
        };
        assert_eq!(defect_of(&with_end(3.0, 3.6, 2.0), 0.0, 0.0), None);
        assert!(defect_of(&with_end(3.0, 4.1, 2.0), 0.0, 0.0).unwrap().contains("2.100 m/s, the vehicle's limit is 2"));
        assert!(defect_of(&with_end(3.0, 3.5, 2.1), 0.0, 0.0).is_some());
        assert!(defect_of(&with_end(2.3, 2.2, 0.0), 0.0, 0.0).unwrap().contains("6.667 m/s²"));
        // To the side and back: the mean acceleration is none.
        let hop = Node { t_s: 1.6, position_m: [1.6, 0.1, 1.0], velocity_mps: [1.0, 0.0, 0.0] };
        let hopping = [line(&[0.5, 1.0, 1.5]), vec![hop], line(&[1.7, 2.5])].concat();
        assert!(defect_of(&hopping, 0.0, 0.0).unwrap().contains("60.000 m/s²"));
        let past = [vec![Node::at_rest(0.4, [-9.0, 0.0, 1.0])], line(&[0.5, 1.0, 2.0])].concat();
        assert_eq!(defect_of(&past, 0.0, 0.0), None, "what lies before is not flown");
    }

    #[test]
    fn a_malformed_reference_is_rejected_without_a_panic() {
        let broken = |change: &dyn Fn(&mut Node)| {
            let mut nodes = line(&[1.0, 2.0, 3.0]);
            change(&mut nodes[1]);
            nodes
        };
        let bad = [
            Vec::new(),
            line(&[1.0]),
            line(&[1.0, 1.0]),
            line(&[2.0, 1.0]),
            line(&[1.1, 2.0]),
            line(&[0.0, 0.5]),
            broken(&|node| node.t_s = f64::NAN),
            broken(&|node| node.position_m[2] = f64::NAN),
            broken(&|node| node.velocity_mps[0] = f64::INFINITY),
            broken(&|node| node.position_m[0] = 1e300),
        ];
        for nodes in bad {
            assert!(defect_of(&nodes, 0.0, 0.0).is_some(), "{nodes:?}");
        }
    }
}
