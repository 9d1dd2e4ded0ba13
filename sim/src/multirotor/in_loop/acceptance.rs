use scenarios::in_loop::Node;

/// Maximum magnitude of a position, m, or velocity, m/s: no map is larger.
const MAX_MAGNITUDE: f64 = 1e6;
/// Maximum number of nodes of a reference.
const MAX_NODES: usize = 100_000;
/// Times that differ by less than this, s, are equal up to rounding.
const SAME_TIME_S: f64 = 1e-9;

/// The reason why a reference cannot be flown, if it cannot: it is malformed, or begins too late. Whether it is safe is
/// for the judge to decide.
pub(super) fn defect(nodes: &[Node], takes_effect_s: f64) -> Option<String> {
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
        return Some(format!("it begins at {} s, after it takes effect at {takes_effect_s} s", first.t_s));
    }
    (last.t_s < takes_effect_s)
        .then(|| format!("it ends at {} s, before it takes effect at {takes_effect_s} s", last.t_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(times_s: &[f64]) -> Vec<Node> {
        times_s.iter().map(|&t_s| Node { t_s, position_m: [t_s, 0.0, 1.0], velocity_mps: [1.0, 0.0, 0.0] }).collect()
    }

    #[test]
    fn a_reference_that_begins_in_time_is_accepted() {
        assert_eq!(defect(&line(&[0.9, 1.5, 2.0]), 1.0), None);
        assert_eq!(defect(&line(&[1.0, 1.5]), 1.0), None);
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
            assert!(defect(&nodes, 1.0).is_some(), "{nodes:?}");
        }
    }
}
