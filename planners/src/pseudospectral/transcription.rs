use super::layout::{Layout, PhaseLayout};
use super::linearisation::Linearisation;
use super::mesh::Mesh;
use super::multiphase_system::{Duration, MultiphaseSystem, TerminalValues};
use super::radau::Radau;
use super::riccati_recursion::RiccatiRecursion;

/// The nonlinear program of a [`MultiphaseSystem`] on a [`Mesh`].
///
/// The constraints are the collocation defects `Σ_i D_ki X_i - η f(X_k, U_k) = 0` (Kang, Huang, Wen 2020, eq. 25 to 27)
/// with those of the system; the objective is the Gauss quadrature `Σ η w_k l(X_k, U_k)` and the cost of time.
pub struct Transcription<'a> {
    pub(super) system: &'a dyn MultiphaseSystem,
    pub(super) mesh: Mesh,
    pub(super) layout: Layout,
    /// Indexed by order; entry 0 is unused.
    pub(super) rules: Vec<Radau>,
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
    pub(super) point: Linearisation,
    pub(super) recursion: RiccatiRecursion,
    pub(super) work: Work,
}

/// Work arrays of evaluation and differentiation.
#[derive(Clone, Debug)]
pub(super) struct Work {
    /// Accelerations at the nodes of a segment.
    pub accelerations: Vec<f64>,
    /// Path constraints of a node.
    pub path_constraints: Vec<f64>,
    pub end: TerminalValues,
    pub cost_gradient: Vec<f64>,
    /// Weights of second derivatives.
    pub acceleration_weights: Vec<f64>,
    pub inequality_weights: Vec<f64>,
    pub linkage_weights: Vec<f64>,
}

impl Work {
    fn new(layout: &Layout, max_order: usize) -> Self {
        let phases = || layout.phases.iter();
        let path_constraints = phases().map(|phase| phase.path_constraints).max().unwrap_or(0);
        let terminal = phases().map(|phase| phase.terminal_inequalities).max().unwrap_or(0);
        Self {
            accelerations: vec![0.0; max_order * layout.coordinates],
            path_constraints: vec![0.0; path_constraints],
            end: TerminalValues::default(),
            cost_gradient: vec![0.0; layout.width()],
            acceleration_weights: vec![0.0; layout.coordinates],
            inequality_weights: vec![0.0; path_constraints.max(terminal)],
            linkage_weights: vec![0.0; layout.states()],
        }
    }
}

impl<'a> Transcription<'a> {
    /// The nonlinear program of `system` on `mesh`.
    ///
    /// # Panics
    ///
    /// Panics unless mesh and system have the same number of phases.
    pub fn new(system: &'a dyn MultiphaseSystem, mesh: Mesh) -> Self {
        let layout = Layout::new(system, &mesh);
        let max_order = mesh.phases.iter().flatten().map(|segment| segment.order).max().unwrap_or(1);
        let rules: Vec<Radau> = (0..=max_order).map(|order| Radau::new(order.max(1))).collect();
        let (lower, upper) = bounds(system, &layout);
        let recursion = RiccatiRecursion::new(system, &layout, &rules);
        Self {
            system,
            mesh,
            point: Linearisation::zero(&layout),
            work: Work::new(&layout, max_order),
            lower,
            upper,
            recursion,
            rules,
            layout,
        }
    }

    /// The mesh of the transcription.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Duration of a phase at the variables `x`, s.
    pub fn duration_s(&self, phase: usize, x: &[f64]) -> f64 {
        self.layout.phases[phase].duration.at(&x[self.layout.parameters_at..])
    }

    /// Variables from an initial guess.
    ///
    /// `guess(phase, fraction of its duration, node)` writes a node vector. Free durations take their own guesses.
    pub fn variables_from(&self, guess: &dyn Fn(usize, f64, &mut [f64])) -> Vec<f64> {
        let (states, width) = (self.layout.states(), self.layout.width());
        let mut x = vec![0.0; self.layout.variables()];
        let mut node = vec![0.0; width];
        for (index, phase) in self.layout.phases.iter().enumerate() {
            for (k, fraction) in self.node_fractions(phase).into_iter().enumerate() {
                guess(index, fraction, &mut node);
                let at = self.layout.node_at(phase, k);
                let count = if k < phase.nodes { width } else { states };
                x[at..at + count].copy_from_slice(&node[..count]);
            }
        }
        let free = self.system.durations().iter().filter_map(|duration| match *duration {
            Duration::Free { guess_s, .. } => Some(guess_s),
            _ => None,
        });
        for (x, guess_s) in x[self.layout.parameters_at..].iter_mut().zip(free) {
            *x = guess_s;
        }
        x
    }

    /// Times of the nodes of a phase and of its end, as fractions of its duration.
    pub(super) fn node_fractions(&self, phase: &PhaseLayout) -> Vec<f64> {
        let mut fractions = Vec::with_capacity(phase.nodes + 1);
        let mut begin = 0.0;
        for segment in &phase.segments {
            let points = &self.rules[segment.order].points[..segment.order];
            fractions.extend(points.iter().map(|τ| begin + 0.5 * (τ + 1.0) * segment.fraction));
            begin += segment.fraction;
        }
        fractions.push(1.0);
        fractions
    }

    /// Half-length η of a segment, s.
    pub(super) fn half_length(&self, phase: &PhaseLayout, segment: usize, x: &[f64]) -> f64 {
        0.5 * phase.segments[segment].fraction * phase.duration.at(&x[self.layout.parameters_at..])
    }
}

/// Lower and upper bounds of the variables.
fn bounds(system: &dyn MultiphaseSystem, layout: &Layout) -> (Vec<f64>, Vec<f64>) {
    let mut lower = vec![f64::NEG_INFINITY; layout.variables()];
    let mut upper = vec![f64::INFINITY; layout.variables()];
    for (index, phase) in layout.phases.iter().enumerate() {
        let (low, high) = system.bounds(index);
        // the initial state, terminal equalities and linkages fix the states at both ends of a phase: a bound that is
        // active there would leave no interior
        for k in 0..=phase.nodes {
            let at = layout.node_at(phase, k);
            let from = if k == 0 { layout.states() } else { 0 };
            let to = if k < phase.nodes { layout.width() } else { 0 };
            if from < to {
                lower[at + from..at + to].copy_from_slice(&low[from..to]);
                upper[at + from..at + to].copy_from_slice(&high[from..to]);
            }
        }
    }
    let free = system.durations().iter().filter_map(|duration| match *duration {
        Duration::Free { min_s, max_s, .. } => Some((min_s, max_s)),
        _ => None,
    });
    for (k, (min_s, max_s)) in free.enumerate() {
        lower[layout.parameters_at + k] = min_s;
        upper[layout.parameters_at + k] = max_s;
    }
    (lower, upper)
}
