use super::program::{Program, Sizes};

/// Where to begin.
#[derive(Clone, Debug, PartialEq)]
pub enum Start {
    /// At x, with multipliers that the method makes up.
    Cold(Vec<f64>),
    /// Near the solution of a similar programme.
    Warm(Warm),
}

/// A point with its multipliers.
#[derive(Clone, Debug, PartialEq)]
pub struct Warm {
    /// Variables.
    pub x: Vec<f64>,
    /// Multipliers of the equalities.
    pub y: Vec<f64>,
    /// Multipliers of the inequalities.
    pub v: Vec<f64>,
    /// Multipliers of lower and upper bounds, each as long as `x`.
    pub z: [Vec<f64>; 2],
}

/// A variable's bound: `slack = sign (x - bound) >= 0`.
#[derive(Clone, Copy, Debug)]
pub struct Side {
    pub index: usize,
    pub sign: f64,
    pub bound: f64,
}

/// The primal-dual point. Slacks and duals of the finite bounds come first, those of the rows `d(x) = s` after them.
#[derive(Clone, Debug)]
pub struct Iterate {
    pub x: Vec<f64>,
    pub y: Vec<f64>,
    pub slack: Vec<f64>,
    pub dual: Vec<f64>,
}

/// The finite bounds of a programme.
#[derive(Clone, Debug)]
pub struct Sides(pub Vec<Side>);

impl Sides {
    /// Those of `program`.
    pub fn of(program: &impl Program) -> Self {
        let (lower, upper) = program.bounds();
        let side =
            |sign: f64| move |(index, &bound): (usize, &f64)| bound.is_finite().then_some(Side { index, sign, bound });
        let lower = lower.iter().enumerate().filter_map(side(1.0));
        Self(lower.chain(upper.iter().enumerate().filter_map(side(-1.0))).collect())
    }

    /// Slacks at x.
    pub fn slacks(&self, x: &[f64], slack: &mut [f64]) {
        for (slack, side) in slack.iter_mut().zip(&self.0) {
            *slack = side.sign * (x[side.index] - side.bound);
        }
    }

    /// Their change with x.
    pub fn steps(&self, dx: &[f64], step: &mut [f64]) {
        for (step, side) in step.iter_mut().zip(&self.0) {
            *step = side.sign * dx[side.index];
        }
    }
}

impl Iterate {
    /// Room for a point.
    pub fn zero(sizes: Sizes, sides: &Sides) -> Self {
        let pairs = sides.0.len() + sizes.inequalities;
        Self {
            x: vec![0.0; sizes.variables],
            y: vec![0.0; sizes.equalities],
            slack: vec![0.0; pairs],
            dual: vec![0.0; pairs],
        }
    }

    /// A strictly interior point near `start`, its duals on the central path of μ.
    pub fn begin(program: &mut impl Program, sides: &Sides, start: &Start, at: (f64, f64)) -> Self {
        let mut point = Self::zero(program.sizes(), sides);
        match start {
            Start::Cold(x) => point.begin_cold(program, sides, x, at),
            Start::Warm(warm) => point.begin_warm(program, sides, warm, at),
        }
        point
    }

    fn begin_cold(&mut self, program: &mut impl Program, sides: &Sides, x: &[f64], (μ, push): (f64, f64)) {
        self.x.copy_from_slice(x);
        let (lower, upper) = program.bounds();
        for (x, (&lower, &upper)) in self.x.iter_mut().zip(lower.iter().zip(upper)) {
            *x = interior(*x, (lower, upper), push);
        }
        self.fill_slacks(program, sides);
        for slack in &mut self.slack[sides.0.len()..] {
            *slack = slack.max(push);
        }
        for (dual, slack) in self.dual.iter_mut().zip(&self.slack) {
            *dual = μ / slack;
        }
    }

    /// Of each pair the larger one is kept (in units in which both are of order one), the other follows from μ.
    fn begin_warm(
        &mut self,
        program: &mut impl Program,
        sides: &Sides,
        Warm { x, y, v, z }: &Warm,
        (μ, push): (f64, f64),
    ) {
        self.x.copy_from_slice(x);
        self.y.copy_from_slice(y);
        sides.slacks(x, &mut self.slack);
        for (j, side) in sides.0.iter().enumerate() {
            let dual = z[usize::from(side.sign < 0.0)][side.index];
            let slack = on_path(self.slack[j], dual, (μ, push));
            self.x[side.index] += side.sign * (slack - self.slack[j]);
        }
        let (lower, upper) = program.bounds();
        for (x, (&lower, &upper)) in self.x.iter_mut().zip(lower.iter().zip(upper)) {
            if !(lower < *x && *x < upper) {
                *x = interior(*x, (lower, upper), push);
            }
        }
        self.fill_slacks(program, sides);
        for (slack, &dual) in self.slack[sides.0.len()..].iter_mut().zip(v) {
            *slack = on_path(*slack, dual, (μ, push));
        }
        for (dual, slack) in self.dual.iter_mut().zip(&self.slack) {
            *dual = μ / slack;
        }
    }

    fn fill_slacks(&mut self, program: &mut impl Program, sides: &Sides) {
        let (bounds, rows) = self.slack.split_at_mut(sides.0.len());
        sides.slacks(&self.x, bounds);
        let mut c = vec![0.0; self.y.len()];
        program.values(&self.x, &mut c, rows);
    }
}

/// The slack of the pair on the central path that is nearest in spirit to what was there.
fn on_path(slack: f64, dual: f64, (μ, push): (f64, f64)) -> f64 {
    if dual > slack.max(μ.sqrt()) { μ / dual } else { slack.max(μ.sqrt().min(push)) }
}

/// `x` moved into the box, off its faces.
fn interior(x: f64, (lower, upper): (f64, f64), push: f64) -> f64 {
    let width = upper - lower;
    let margin =
        |bound: f64| (push * bound.abs().max(1.0)).min(if width.is_finite() { push * width } else { f64::MAX });
    let x = if lower.is_finite() { x.max(lower + margin(lower)) } else { x };
    if upper.is_finite() { x.min(upper - margin(upper)) } else { x }
}
