/// One segment of a phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Fraction of the phase's duration, in (0, 1].
    pub fraction: f64,
    /// Number N of collocation points.
    pub order: usize,
}

/// The segments of every phase, in the order of time.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// Segments by phase; the fractions of a phase sum to 1.
    pub phases: Vec<Vec<Segment>>,
}

impl Mesh {
    /// Equal segments: `(segments, order)` per phase.
    pub fn uniform(phases: &[(usize, usize)]) -> Self {
        let phase = |&(count, order): &(usize, usize)| vec![Segment { fraction: 1.0 / count as f64, order }; count];
        Self { phases: phases.iter().map(phase).collect() }
    }

    /// Segments between Chebyshev points: `(segments, order)` per phase.
    ///
    /// The segments are short near both ends of a phase, where a motion from rest to rest changes fastest.
    pub fn graded(phases: &[(usize, usize)]) -> Self {
        let phase = |&(count, order): &(usize, usize)| {
            let end = |k: usize| 0.5 - 0.5 * (std::f64::consts::PI * k as f64 / count as f64).cos();
            (0..count).map(|k| Segment { fraction: end(k + 1) - end(k), order }).collect()
        };
        Self { phases: phases.iter().map(phase).collect() }
    }

    /// Number of segments of all phases.
    pub fn segments(&self) -> usize {
        self.phases.iter().map(Vec::len).sum()
    }

    /// Number of collocation points of all phases.
    pub fn nodes(&self) -> usize {
        self.phases.iter().flatten().map(|segment| segment.order).sum()
    }
}
