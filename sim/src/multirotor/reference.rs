use nalgebra::Vector3;
use scenarios::in_loop::Node;

/// Times that differ by less than this, s, are equal up to rounding.
const ROUNDING_S: f64 = 1e-9;

/// Nodes as a continuous motion, for a tracker to follow: between two nodes the cubic with their positions and
/// velocities; hover before the first node and after the last one.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    nodes: Vec<Node>,
}

/// A reference at one instant. World frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReferencePoint {
    /// Time, s.
    pub t_s: f64,
    /// Position, m.
    pub position_m: Vector3<f64>,
    /// Velocity, m/s.
    pub velocity_mps: Vector3<f64>,
    /// Acceleration, m/s².
    pub acceleration_mps2: Vector3<f64>,
}

impl Reference {
    /// The reference through at least one node, with times in order.
    ///
    /// # Panics
    ///
    /// If there is no node.
    pub fn new(nodes: Vec<Node>) -> Self {
        assert!(!nodes.is_empty(), "a reference has a node");
        Self { nodes }
    }

    /// Its nodes.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The reference just before `t_s`, s: at its end, up to rounding, the end itself and not the hover after it.
    pub fn before(&self, t_s: f64) -> ReferencePoint {
        match self.nodes.last() {
            Some(last) if (last.t_s - t_s).abs() <= ROUNDING_S => ReferencePoint { t_s, ..hovering(last, last.t_s) },
            _ => self.at(t_s),
        }
    }

    /// The reference at `t_s`, s. At a discontinuity, the limit from the right.
    pub fn at(&self, t_s: f64) -> ReferencePoint {
        let after = self.nodes.partition_point(|node| node.t_s <= t_s);
        match (after.checked_sub(1).map(|before| &self.nodes[before]), self.nodes.get(after)) {
            (Some(from), Some(to)) => between(from, to, t_s),
            (Some(only), None) | (None, Some(only)) => hovering(only, t_s),
            (None, None) => unreachable!("a reference has a node"),
        }
    }
}

impl ReferencePoint {
    /// As a node.
    pub fn node(&self) -> Node {
        Node { t_s: self.t_s, position_m: self.position_m.into(), velocity_mps: self.velocity_mps.into() }
    }
}

fn hovering(node: &Node, t_s: f64) -> ReferencePoint {
    ReferencePoint {
        t_s,
        position_m: node.position_m.into(),
        // At the node itself its own velocity applies: the end of a plan need not be at rest.
        velocity_mps: if t_s == node.t_s { node.velocity_mps.into() } else { Vector3::zeros() },
        acceleration_mps2: Vector3::zeros(),
    }
}

/// The cubic with the positions and velocities of two nodes, and its derivatives.
fn between(from: &Node, to: &Node, t_s: f64) -> ReferencePoint {
    let dt_s = to.t_s - from.t_s;
    let s = (t_s - from.t_s) / dt_s;
    let [p0, p1] = [from, to].map(|node| Vector3::from(node.position_m));
    let [v0, v1] = [from, to].map(|node| Vector3::from(node.velocity_mps));
    let mean_mps = (p1 - p0) / dt_s;
    // p = p0 + dt (v0 s + (3 m - 2 v0 - v1) s² + (v0 + v1 - 2 m) s³), m the mean velocity
    let (second, third) = (mean_mps * 3.0 - v0 * 2.0 - v1, v0 + v1 - mean_mps * 2.0);
    ReferencePoint {
        t_s,
        position_m: p0 + (v0 + (second + third * s) * s) * (s * dt_s),
        velocity_mps: v0 + (second * 2.0 + third * (3.0 * s)) * s,
        acceleration_mps2: (second * 2.0 + third * (6.0 * s)) / dt_s,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constant_acceleration_is_interpolated_exactly() {
        let (v, a) = (Vector3::new(1.0, -0.5, 0.2), Vector3::new(-2.0, 1.0, 0.4));
        let truth = |t: f64| (v * t + a * (t * t / 2.0), v + a * t);
        let node = |t_s: f64| {
            let (position, velocity) = truth(t_s);
            Node { t_s, position_m: position.into(), velocity_mps: velocity.into() }
        };
        let reference = Reference::new(vec![node(0.0), node(0.25), node(1.0)]);
        for t_s in [0.0, 0.1, 0.25, 0.6, 0.99] {
            let (point, (position, velocity)) = (reference.at(t_s), truth(t_s));
            assert!((point.position_m - position).norm() < 1e-14 && (point.velocity_mps - velocity).norm() < 1e-13);
            assert!((point.acceleration_mps2 - a).norm() < 1e-12);
        }
        assert_eq!(reference.at(2.0).position_m, truth(1.0).0);
        assert_eq!(reference.at(2.0).velocity_mps, Vector3::zeros());
    }

    #[test]
    fn just_before_its_end_a_reference_has_not_stopped() {
        let node = |t_s: f64| Node { t_s, position_m: [t_s, 0.0, 1.0], velocity_mps: [1.0, 0.0, 0.0] };
        let reference = Reference::new(vec![node(2.0), node(2.3)]);
        let end_s = 2.300_000_000_000_000_3;
        assert!(end_s > 2.3 && reference.at(end_s).velocity_mps == Vector3::zeros());
        assert_eq!(reference.before(end_s).velocity_mps.x, 1.0);
        assert_eq!(reference.before(end_s).t_s, end_s);
        assert_eq!(reference.before(2.31).velocity_mps, Vector3::zeros());
    }
}
