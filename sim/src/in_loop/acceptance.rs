use scenarios::in_loop::Node;

/// Largest position, m, and velocity, m/s, that an answer may name: beyond it there is no map.
const LARGEST: f64 = 1e6;
/// Most nodes of an answer.
const MOST_NODES: usize = 100_000;
/// What rounding leaves of two times that should be the same, s.
const SAME_TIME_S: f64 = 1e-9;

/// Why an answer cannot be flown, if it cannot: it is no motion, or one that begins too late. Whether the motion is a good
/// one is for the judge to say.
pub(super) fn defect(nodes: &[Node], takes_effect_s: f64) -> Option<String> {
    let [first, .., last] = nodes else {
        return Some(format!("{} nodes, two at least are needed", nodes.len()));
    };
    if nodes.len() > MOST_NODES {
        return Some(format!("{} nodes, {MOST_NODES} at most are taken", nodes.len()));
    }
    let is_sound = |node: &Node| {
        node.t_s.is_finite() && node.position_m.iter().chain(&node.velocity_mps).all(|value| value.abs() <= LARGEST)
    };
    if let Some(node) = nodes.iter().find(|node| !is_sound(node)) {
        return Some(format!("the node at {} s holds a number that is none, or one without measure", node.t_s));
    }
    if let Some(pair) = nodes.windows(2).find(|pair| pair[0].t_s >= pair[1].t_s) {
        return Some(format!("after the time {} s comes {} s", pair[0].t_s, pair[1].t_s));
    }
    if first.t_s > takes_effect_s + SAME_TIME_S {
        return Some(format!("it begins at {} s, but is flown from {takes_effect_s} s on", first.t_s));
    }
    (last.t_s < takes_effect_s).then(|| format!("it ends at {} s, but is flown from {takes_effect_s} s on", last.t_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(times_s: &[f64]) -> Vec<Node> {
        times_s.iter().map(|&t_s| Node { t_s, position_m: [t_s, 0.0, 1.0], velocity_mps: [1.0, 0.0, 0.0] }).collect()
    }

    #[test]
    fn a_motion_that_begins_in_time_is_accepted() {
        assert_eq!(defect(&line(&[0.9, 1.5, 2.0]), 1.0), None);
        assert_eq!(defect(&line(&[1.0, 1.5]), 1.0), None);
    }

    #[test]
    fn what_is_no_motion_is_refused_and_never_panics() {
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
            assert!(defect(&nodes, 1.0).is_some(), "{nodes:?}");
        }
    }
}
