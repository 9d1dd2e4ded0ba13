//! Up to four programmes of one shape side by side, one per lane.

use super::kernels::Matrix;
use super::lanes::{Lanes, Mask, Vector, WIDTH};
use super::program::{LINK, Plane, Program, STAGE};

/// Programmes side by side. Planes may differ in number: a lane that has fewer in a stage than its neighbours has empty
/// ones there, which count for nothing.
#[derive(Clone, Debug)]
pub struct Batch<S: Vector> {
    /// The machine's instructions.
    pub simd: S,
    /// q.
    pub theta_cost: Lanes<S>,
    /// μ.
    pub penalty: Lanes<S>,
    /// Links, K of them.
    pub links: Vec<Link<S>>,
    /// Pins: index into z, and value.
    pub pins: Vec<(usize, Lanes<S>)>,
    /// Planes in ascending order of the stage.
    pub planes: Vec<PlaneRow<S>>,
    /// First plane of every stage, and the end of the last.
    pub first_plane: Vec<usize>,
    /// Bounds of every variable.
    pub bounds: Vec<Bounds<S>>,
    /// Number of complementary pairs of every lane.
    pub pairs: Lanes<S>,
}

/// `left w_k + right w_{k+1} + theta θ = rhs`.
#[derive(Clone, Debug)]
pub struct Link<S: Vector> {
    /// Coefficients of w_k.
    pub left: Matrix<S, LINK, STAGE>,
    /// Coefficients of w_{k+1}.
    pub right: Matrix<S, LINK, STAGE>,
    /// Coefficients of θ.
    pub theta: [Lanes<S>; LINK],
    /// Right-hand side.
    pub rhs: [Lanes<S>; LINK],
}

/// `here · (w_k[0], w_k[1]) + next · (w_{k+1}[0], w_{k+1}[1]) <= bound`.
#[derive(Clone, Copy, Debug)]
pub struct PlaneRow<S: Vector> {
    /// Index into z of w_k[0].
    pub here_at: usize,
    /// Index into z of w_{k+1}[0]; of w_k[0] in the last stage, where `next` is zero.
    pub next_at: usize,
    /// Coefficients of stage k.
    pub here: [Lanes<S>; 2],
    /// Coefficients of stage k + 1.
    pub next: [Lanes<S>; 2],
    /// Right-hand side.
    pub bound: Lanes<S>,
    /// Has any lane a coefficient in stage k + 1?
    pub spans: bool,
    /// 1 where the lane has this plane, 0 where it is empty.
    pub present: Lanes<S>,
}

/// Bounds of one variable.
#[derive(Clone, Copy, Debug)]
pub struct Bounds<S: Vector> {
    /// Hard lower bound.
    pub box_lower: Lanes<S>,
    /// Hard upper bound.
    pub box_upper: Lanes<S>,
    /// Elastic lower bound.
    pub soft_lower: Lanes<S>,
    /// Elastic upper bound.
    pub soft_upper: Lanes<S>,
}

impl<S: Vector> Batch<S> {
    /// Nothing yet.
    pub fn new(simd: S) -> Self {
        let zero = Lanes::splat(simd, 0.0);
        Self {
            simd,
            theta_cost: zero,
            penalty: zero,
            links: Vec::new(),
            pins: Vec::new(),
            planes: Vec::new(),
            first_plane: Vec::new(),
            bounds: Vec::new(),
            pairs: zero,
        }
    }

    /// Number K of links.
    pub fn intervals(&self) -> usize {
        self.links.len()
    }

    /// Length of z.
    pub fn len(&self) -> usize {
        self.bounds.len()
    }

    /// Takes one programme per lane; they agree in the number of links and in the indices of their pins.
    pub fn set(&mut self, programs: [&Program; WIDTH]) {
        let simd = self.simd;
        let lanes = |value: &dyn Fn(&Program) -> f64| Lanes::new(simd, programs.map(value));
        self.theta_cost = lanes(&|program| program.theta_cost);
        self.penalty = lanes(&|program| program.penalty);
        self.pairs = lanes(&|program| 2.0 * (program.len() + program.equalities() + program.inequalities()) as f64);
        self.pins.clear();
        let pins = programs[0].pins.iter().enumerate();
        self.pins.extend(pins.map(|(i, pin)| (pin.index, lanes(&|program| program.pins[i].value))));
        self.bounds.clear();
        self.bounds.extend((0..programs[0].len()).map(|i| Bounds {
            box_lower: lanes(&|program| program.box_lower[i]),
            box_upper: lanes(&|program| program.box_upper[i]),
            soft_lower: lanes(&|program| program.soft_lower[i]),
            soft_upper: lanes(&|program| program.soft_upper[i]),
        }));
        self.set_links(programs);
        self.set_planes(programs);
    }

    fn set_links(&mut self, programs: [&Program; WIDTH]) {
        let simd = self.simd;
        let zero = Lanes::splat(simd, 0.0);
        let empty =
            Link { left: [[zero; STAGE]; LINK], right: [[zero; STAGE]; LINK], theta: [zero; LINK], rhs: [zero; LINK] };
        self.links.resize(programs[0].intervals(), empty);
        for (k, link) in self.links.iter_mut().enumerate() {
            let [a, b, c, d] = programs.map(|program| &program.links[k]);
            for i in 0..LINK {
                for j in 0..STAGE {
                    let at = (i, j);
                    link.left[i][j] = Lanes::new(simd, [a.left[at], b.left[at], c.left[at], d.left[at]]);
                    link.right[i][j] = Lanes::new(simd, [a.right[at], b.right[at], c.right[at], d.right[at]]);
                }
                link.theta[i] = Lanes::new(simd, [a.theta[i], b.theta[i], c.theta[i], d.theta[i]]);
                link.rhs[i] = Lanes::new(simd, [a.rhs[i], b.rhs[i], c.rhs[i], d.rhs[i]]);
            }
        }
    }

    fn set_planes(&mut self, programs: [&Program; WIDTH]) {
        let stages = programs[0].intervals() + 1;
        let mut rest = programs.map(|program| program.planes.as_slice());
        self.planes.clear();
        self.first_plane.clear();
        for stage in 0..stages {
            self.first_plane.push(self.planes.len());
            let own = rest.map(|planes| planes.iter().take_while(|plane| plane.stage == stage).count());
            for i in 0..own.into_iter().max().unwrap_or(0) {
                let planes = std::array::from_fn(|lane| (i < own[lane]).then(|| &rest[lane][i]));
                self.planes.push(PlaneRow::new(self.simd, stage, stages, planes));
            }
            rest = std::array::from_fn(|lane| &rest[lane][own[lane]..]);
        }
        self.first_plane.push(self.planes.len());
    }
}

impl<S: Vector> PlaneRow<S> {
    fn new(simd: S, stage: usize, stages: usize, planes: [Option<&Plane>; WIDTH]) -> Self {
        let lanes =
            |value: &dyn Fn(&Plane) -> f64, empty: f64| Lanes::new(simd, planes.map(|p| p.map_or(empty, value)));
        Self {
            here_at: STAGE * stage,
            next_at: STAGE * (stage + 1).min(stages - 1),
            here: [lanes(&|plane| plane.here[0], 0.0), lanes(&|plane| plane.here[1], 0.0)],
            next: [lanes(&|plane| plane.next[0], 0.0), lanes(&|plane| plane.next[1], 0.0)],
            bound: lanes(&|plane| plane.bound, 1.0),
            spans: planes.into_iter().flatten().any(Plane::spans_two_stages),
            present: lanes(&|_| 1.0, 0.0),
        }
    }

    /// Which lanes have this plane?
    #[inline(always)]
    pub fn is_present(&self) -> Mask<S> {
        self.present.is_above(self.present.like(0.5))
    }

    /// `here · w_k + next · w_{k+1}`.
    #[inline(always)]
    pub fn value(&self, z: &[Lanes<S>]) -> Lanes<S> {
        let here = self.here[0] * z[self.here_at] + self.here[1] * z[self.here_at + 1];
        here + (self.next[0] * z[self.next_at] + self.next[1] * z[self.next_at + 1])
    }

    /// Adds the row times `multiplier` to `out`.
    #[inline(always)]
    pub fn add(&self, multiplier: Lanes<S>, out: &mut [Lanes<S>]) {
        for i in 0..2 {
            out[self.here_at + i] += self.here[i] * multiplier;
            out[self.next_at + i] += self.next[i] * multiplier;
        }
    }
}
