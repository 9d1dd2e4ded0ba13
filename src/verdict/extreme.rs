/// The smallest or largest value of a coordinate.
#[derive(Clone, Copy, Debug)]
pub struct Extreme {
    /// On the curve, m.
    pub value: f64,
    /// How far the true motion may be from the curve there, m: 0 unless it was reconstructed.
    pub error: f64,
    /// When, s.
    pub t_s: f64,
}
