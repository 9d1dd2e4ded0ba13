//! References, as they go over the seam, and motions.

use scenarios::in_loop::Node;

use super::motion::{Motion, State};

/// Time for which a motion without any way is told to stand, s.
const STAND_S: f64 = 0.1;

/// The motion through `nodes`, with its time 0 at `zero_s`; nothing if there are none. Of two nodes at one time the later
/// one holds.
pub fn motion(nodes: &[Node], zero_s: f64) -> Option<Motion> {
    let mut knots: Vec<(f64, State)> = Vec::with_capacity(nodes.len());
    for node in nodes {
        let at_s = node.t_s - zero_s;
        if knots.last().is_some_and(|(last_s, _)| *last_s >= at_s) {
            knots.pop();
        }
        knots.push((at_s, State { position: node.position_m, velocity: node.velocity_mps }));
    }
    (!knots.is_empty()).then(|| Motion::through(knots))
}

/// A motion as nodes, two at least, with its time 0 at `zero_s`.
pub fn nodes(motion: &Motion, zero_s: f64) -> Vec<Node> {
    let node = |&(at_s, state): &(f64, State)| Node {
        t_s: zero_s + at_s,
        position_m: state.position,
        velocity_mps: state.velocity,
    };
    let mut nodes: Vec<Node> = motion.knots().iter().map(node).collect();
    let last = nodes[nodes.len() - 1];
    if nodes.len() == 1 {
        nodes.push(Node { t_s: last.t_s + STAND_S, ..last });
    }
    nodes
}
