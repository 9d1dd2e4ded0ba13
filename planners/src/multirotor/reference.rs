//! Conversion between motions and the references that are exchanged in the loop.

use scenarios::in_loop::Node;

use super::{PointMassMotion, PointMassState};

/// Duration of the reference for a motion that is a single state, s.
const HOLD_S: f64 = 0.1;

/// The motion through `nodes`, with its time 0 at `zero_s`; `None` without nodes. Of several nodes at one time the last
/// one counts.
pub fn motion_from_nodes(nodes: &[Node], zero_s: f64) -> Option<PointMassMotion> {
    let mut knots: Vec<(f64, PointMassState)> = Vec::with_capacity(nodes.len());
    for node in nodes {
        let at_s = node.t_s - zero_s;
        if knots.last().is_some_and(|(last_s, _)| *last_s >= at_s) {
            knots.pop();
        }
        let state = PointMassState { position: node.position_m.into(), velocity: node.velocity_mps.into() };
        knots.push((at_s, state));
    }
    (!knots.is_empty()).then(|| PointMassMotion::through(knots))
}

/// The nodes of a motion, at least two, with its time 0 at `zero_s`.
pub fn nodes_from_motion(motion: &PointMassMotion, zero_s: f64) -> Vec<Node> {
    let node = |&(at_s, state): &(f64, PointMassState)| Node {
        t_s: zero_s + at_s,
        position_m: state.position.into(),
        velocity_mps: state.velocity.into(),
    };
    let mut nodes: Vec<Node> = motion.knots().iter().map(node).collect();
    let last = nodes[nodes.len() - 1];
    if nodes.len() == 1 {
        nodes.push(Node { t_s: last.t_s + HOLD_S, ..last });
    }
    nodes
}
