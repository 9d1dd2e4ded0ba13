use super::{Piece, PieceRounding};

/// A B-spline over time.
#[derive(Clone, Debug, PartialEq)]
pub struct BSpline {
    /// Degree p, at least 1.
    pub degree: usize,
    /// Knots, s, non-decreasing: as many as control points, plus p + 1. The curve lasts from the knot p to the one after
    /// the last control point's own, `knots_s[points_m.len()]`.
    pub knots_s: Vec<f64>,
    /// Control points, m.
    pub points_m: Vec<[f64; 3]>,
}

impl BSpline {
    /// The spline with knots `interval_s` apart, that begins at 0 s: the form of planners of the EGO-Planner family.
    pub fn uniform(degree: usize, interval_s: f64, points_m: Vec<[f64; 3]>) -> Self {
        let knot = |index: usize| interval_s * (index as f64 - degree as f64);
        Self { degree, knots_s: (0..points_m.len() + degree + 1).map(knot).collect(), points_m }
    }

    /// Whether the numbers of knots and control points fit the degree, and the knots do not decrease.
    pub fn is_consistent(&self) -> bool {
        self.degree >= 1
            && self.points_m.len() > self.degree
            && self.knots_s.len() == self.points_m.len() + self.degree + 1
            && self.knots_s.windows(2).all(|pair| pair[0] <= pair[1])
    }

    /// Its polynomial pieces, one for every interval between different knots.
    ///
    /// The control points of the piece between u_k and u_{k+1} are values of the blossom (polar form) of the spline,
    ///
    /// ```text
    /// b_j = B[u_k, ..., u_k, u_{k+1}, ..., u_{k+1}]      (p - j times u_k, j times u_{k+1})        [Farin 2002, chapter 8]
    /// ```
    ///
    /// # Panics
    ///
    /// If the spline is not [consistent](Self::is_consistent).
    pub fn pieces(&self) -> Vec<Piece> {
        assert!(self.is_consistent(), "numbers of knots and control points fit the degree");
        let spans = self.degree..self.points_m.len();
        spans.filter(|span| self.knots_s[*span] < self.knots_s[span + 1]).map(|span| self.piece(span)).collect()
    }

    fn piece(&self, span: usize) -> Piece {
        let [begin_s, end_s] = [self.knots_s[span], self.knots_s[span + 1]];
        let argument = |j: usize, level: usize| if level <= self.degree - j { begin_s } else { end_s };
        let points_m = (0..=self.degree).map(|j| self.blossom(span, |level| argument(j, level))).collect();
        Piece { t_s: [begin_s, end_s], points_m, rounding: PieceRounding::default() }
    }

    /// The blossom on the interval after the knot `span`, by de Boor's recursion with its own argument on every level.
    fn blossom(&self, span: usize, argument: impl Fn(usize) -> f64) -> [f64; 3] {
        let (p, u) = (self.degree, &self.knots_s);
        let mut d = self.points_m[span - p..=span].to_vec();
        for level in 1..=p {
            let t = argument(level);
            for i in (level..=p).rev() {
                let (low, high) = (u[span - p + i], u[span + i + 1 - level]);
                let share = (t - low) / (high - low);
                d[i] = std::array::from_fn(|axis| (1.0 - share) * d[i - 1][axis] + share * d[i][axis]);
            }
        }
        d[p]
    }
}
