//! The planned motion of a vehicle that was planned before, as a function of time.

/// Samples of a motion in the plane, between which it is a cubic: units of the program.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighbour {
    /// Times, ascending from 0.
    pub times: Vec<f64>,
    /// Positions (x, y).
    pub positions: Vec<[f64; 2]>,
    /// Velocities.
    pub velocities: Vec<[f64; 2]>,
}

impl Neighbour {
    /// Position with its first and second derivative at a time; at rest at its ends outside its duration.
    pub fn at(&self, time: f64) -> [[f64; 2]; 3] {
        let last = self.times.len() - 1;
        if time <= self.times[0] || time >= self.times[last] {
            let end = if time <= self.times[0] { 0 } else { last };
            return [self.positions[end], [0.0; 2], [0.0; 2]];
        }
        let next = self.times.partition_point(|at| *at <= time);
        let (from, step) = (next - 1, self.times[next] - self.times[next - 1]);
        let s = (time - self.times[from]) / step;
        // Hermite basis: values at both ends, slopes at both ends
        let basis = [
            [(1.0 + 2.0 * s) * (1.0 - s).powi(2), 6.0 * s * s - 6.0 * s, 12.0 * s - 6.0],
            [s * s * (3.0 - 2.0 * s), 6.0 * s - 6.0 * s * s, 6.0 - 12.0 * s],
            [s * (1.0 - s).powi(2), 3.0 * s * s - 4.0 * s + 1.0, 6.0 * s - 4.0],
            [s * s * (s - 1.0), 3.0 * s * s - 2.0 * s, 6.0 * s - 2.0],
        ];
        let scale = [1.0, 1.0 / step, 1.0 / (step * step)];
        std::array::from_fn(|order| {
            std::array::from_fn(|axis| {
                let values = [
                    self.positions[from][axis],
                    self.positions[next][axis],
                    step * self.velocities[from][axis],
                    step * self.velocities[next][axis],
                ];
                scale[order] * values.iter().zip(&basis).map(|(value, basis)| value * basis[order]).sum::<f64>()
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::Neighbour;

    /// A cubic motion is reproduced with its derivatives.
    #[test]
    fn a_cubic_is_exact() {
        let position = |t: f64| [t * t * t - t, 2.0 * t * t];
        let velocity = |t: f64| [3.0 * t * t - 1.0, 4.0 * t];
        let times = vec![0.0, 0.7, 2.0];
        let neighbour = Neighbour {
            positions: times.iter().map(|t| position(*t)).collect(),
            velocities: times.iter().map(|t| velocity(*t)).collect(),
            times,
        };
        for t in [0.2, 0.7, 1.1, 1.9] {
            let found = neighbour.at(t);
            for (found, expected) in found.into_iter().zip([position(t), velocity(t), [6.0 * t, 4.0]]) {
                for axis in 0..2 {
                    assert!((found[axis] - expected[axis]).abs() < 1e-12, "{t}");
                }
            }
        }
        assert_eq!(neighbour.at(5.0), [position(2.0), [0.0; 2], [0.0; 2]]);
    }
}
