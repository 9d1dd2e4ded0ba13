/// Steps after which an interval is shorter than 1e-12 of its length.
const STEPS: usize = 58;

/// The place of the minimum of a function that falls before it and rises after it, by golden-section search.
pub fn argmin(value: impl Fn(f64) -> f64, [mut from, mut to]: [f64; 2]) -> f64 {
    let ratio = (5.0_f64.sqrt() - 1.0) / 2.0;
    let mut inner = [to - ratio * (to - from), from + ratio * (to - from)];
    let mut values = inner.map(&value);
    for _ in 0..STEPS {
        if values[0] < values[1] {
            to = inner[1];
            inner = [to - ratio * (to - from), inner[0]];
            values = [value(inner[0]), values[0]];
        } else {
            from = inner[0];
            inner = [inner[1], from + ratio * (to - from)];
            values = [values[1], value(inner[1])];
        }
    }
    f64::midpoint(from, to)
}

#[cfg(test)]
mod tests {
    use super::argmin;

    #[test]
    fn minima_lie_inside_or_at_an_end() {
        for (at, expected) in [(0.3, 0.3), (-1.0, 0.0), (2.0, 1.0)] {
            assert!((argmin(|x| (x - at).abs(), [0.0, 1.0]) - expected).abs() < 1e-11, "{at}");
        }
    }
}
