use super::program::{Program, Sizes};

/// The initial point.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// Variables x; the method chooses the multipliers.
    Cold(Vec<f64>),
    /// A point near the solution, with its multipliers.
    Warm(WarmStart),
}

/// A primal-dual point.
#[derive(Clone, Debug, PartialEq)]
pub struct WarmStart {
    /// Variables.
    pub x: Vec<f64>,
    /// Multipliers of the equalities.
    pub y: Vec<f64>,
    /// Multipliers of the inequalities.
    pub v: Vec<f64>,
    /// Multipliers of the lower and of the upper bounds, each of the length of `x`.
    pub z: [Vec<f64>; 2],
}

/// A finite bound of a variable: `slack = sign (x - value) >= 0`.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    pub index: usize,
    pub sign: f64,
    pub value: f64,
}

/// The finite bounds of a program, lower bounds first.
#[derive(Clone, Debug)]
pub struct Bounds(pub Vec<Bound>);

/// The primal-dual point. Slacks and duals of the bounds come first, those of the inequalities `d(x) = s` follow.
#[derive(Clone, Debug)]
pub struct Iterate {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub slack: Vec<f64>,
    pub dual: Vec<f64>,
}

impl Bounds {
    /// The finite bounds of `program`.
    pub fn of(program: &impl Program) -> Self {
        let (lower, upper) = program.bounds();
        let finite =
            |sign: f64| move |(index, &value): (usize, &f64)| value.is_finite().then_some(Bound { index, sign, value });
        let lower = lower.iter().enumerate().filter_map(finite(1.0));
        Self(lower.chain(upper.iter().enumerate().filter_map(finite(-1.0))).collect())
    }

    /// Writes the slacks at x.
    pub fn slacks(&self, x: &[f64], slack: &mut [f64]) {
        for (slack, bound) in slack.iter_mut().zip(&self.0) {
            *slack = bound.sign * (x[bound.index] - bound.value);
        }
    }

    /// Writes the steps of the slacks for a step dx.
    pub fn steps(&self, dx: &[f64], step: &mut [f64]) {
        for (step, bound) in step.iter_mut().zip(&self.0) {
            *step = bound.sign * dx[bound.index];
        }
    }
}

impl Iterate {
    /// All zero.
    pub fn zero(sizes: Sizes, bounds: &Bounds) -> Self {
        let pairs = bounds.0.len() + sizes.inequalities;
        Self {
            x: vec![0.0; sizes.variables],
            y: vec![0.0; sizes.equalities],
            slack: vec![0.0; pairs],
            dual: vec![0.0; pairs],
        }
    }

    /// A strictly interior point near `start`, with duals `μ/s`.
    pub fn initial(program: &mut impl Program, bounds: &Bounds, start: &Start, (μ, push): (f64, f64)) -> Self {
        let mut point = Self::zero(program.sizes(), bounds);
        match start {
            Start::Cold(x) => point.start_cold(program, bounds, x, push),
            Start::Warm(warm) => point.start_warm(program, bounds, warm, (μ, push)),
        }
        for (dual, slack) in point.dual.iter_mut().zip(&point.slack) {
            *dual = μ / slack;
        }
        point
    }

    fn start_cold(&mut self, program: &mut impl Program, bounds: &Bounds, x: &[f64], push: f64) {
        self.x.copy_from_slice(x);
        let (lower, upper) = program.bounds();
        for (x, (&lower, &upper)) in self.x.iter_mut().zip(lower.iter().zip(upper)) {
            *x = push_inside(*x, (lower, upper), push);
        }
        self.compute_slacks(program, bounds);
        for slack in &mut self.slack[bounds.0.len()..] {
            *slack = slack.max(push);
        }
    }

    /// Keeps the larger of slack and dual of each pair (scaled to order one); the other follows from μ.
    fn start_warm(
        &mut self,
        program: &mut impl Program,
        bounds: &Bounds,
        WarmStart { x, y, v, z }: &WarmStart,
        (μ, push): (f64, f64),
    ) {
        self.x.copy_from_slice(x);
        self.y.copy_from_slice(y);
        bounds.slacks(x, &mut self.slack);
        for (j, bound) in bounds.0.iter().enumerate() {
            let dual = z[usize::from(bound.sign < 0.0)][bound.index];
            let slack = central_slack(self.slack[j], dual, (μ, push));
            self.x[bound.index] += bound.sign * (slack - self.slack[j]);
        }
        let (lower, upper) = program.bounds();
        for (x, (&lower, &upper)) in self.x.iter_mut().zip(lower.iter().zip(upper)) {
            if !(lower < *x && *x < upper) {
                *x = push_inside(*x, (lower, upper), push);
            }
        }
        self.compute_slacks(program, bounds);
        for (slack, &dual) in self.slack[bounds.0.len()..].iter_mut().zip(v) {
            *slack = central_slack(*slack, dual, (μ, push));
        }
    }

    /// Slacks of the bounds at x, and `s = d(x)`.
    fn compute_slacks(&mut self, program: &mut impl Program, bounds: &Bounds) {
        let (of_bounds, of_inequalities) = self.slack.split_at_mut(bounds.0.len());
        bounds.slacks(&self.x, of_bounds);
        let mut c = vec![0.0; self.y.len()];
        program.evaluate(&self.x, &mut c, of_inequalities);
    }
}

/// The slack of a pair on the central path: `μ/dual` if the constraint is active, else the slack, kept off zero.
fn central_slack(slack: f64, dual: f64, (μ, push): (f64, f64)) -> f64 {
    if dual > slack.max(μ.sqrt()) { μ / dual } else { slack.max(μ.sqrt().min(push)) }
}

/// `x` projected into the box, off its faces (Wächter and Biegler 2006, section 3.6).
fn push_inside(x: f64, (lower, upper): (f64, f64), push: f64) -> f64 {
    let width = upper - lower;
    let margin =
        |bound: f64| (push * bound.abs().max(1.0)).min(if width.is_finite() { push * width } else { f64::MAX });
    let x = if lower.is_finite() { x.max(lower + margin(lower)) } else { x };
    if upper.is_finite() { x.min(upper - margin(upper)) } else { x }
}
