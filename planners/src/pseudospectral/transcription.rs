use super::layout::{Layout, PhaseLayout};
use super::mesh::Mesh;
use super::motion::{Duration, EndDerivatives, EndValues, EndWeights, Motion, NodeDerivatives, NodeWeights};
use super::radau::Radau;
use super::small::add_scaled;
use super::sweep::{End, Linearisation, Sweep};

/// The nonlinear programme of a motion on a mesh.
pub struct Transcription<'a> {
    pub(super) motion: &'a dyn Motion,
    pub(super) mesh: Mesh,
    pub(super) layout: Layout,
    /// By order; the first is unused.
    pub(super) rules: Vec<Radau>,
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
    pub(super) point: Linearisation,
    pub(super) sweep: Sweep,
    pub(super) accelerations: Vec<f64>,
    end: EndValues,
    cost_gradient: Vec<f64>,
}

impl<'a> Transcription<'a> {
    /// The programme of `motion` on `mesh`.
    pub fn new(motion: &'a dyn Motion, mesh: Mesh) -> Self {
        let layout = Layout::new(motion, &mesh);
        let highest = mesh.phases.iter().flatten().map(|segment| segment.order).max().unwrap_or(1);
        let rules: Vec<Radau> = (0..=highest).map(|order| Radau::new(order.max(1))).collect();
        let (lower, upper) = bounds(motion, &layout);
        let sweep = Sweep::new(motion, &layout, &rules);
        let end = EndValues { events: Vec::new(), rows: Vec::new(), next: vec![0.0; layout.states()] };
        Self {
            motion,
            mesh,
            point: linearisation(&layout),
            accelerations: vec![0.0; highest * layout.coordinates],
            cost_gradient: vec![0.0; layout.width()],
            end,
            lower,
            upper,
            sweep,
            rules,
            layout,
        }
    }

    /// The mesh.
    pub fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// Duration of a phase, s.
    pub fn duration_s(&self, phase: usize, x: &[f64]) -> f64 {
        self.layout.phases[phase].duration.at(&x[self.layout.parameters_at..])
    }

    /// Variables from a guess: `guess(phase, share of its duration)` writes a node vector.
    pub fn guess(&self, guess: &dyn Fn(usize, f64, &mut [f64])) -> Vec<f64> {
        let (states, width) = (self.layout.states(), self.layout.width());
        let mut x = vec![0.0; self.layout.variables()];
        let mut node = vec![0.0; width];
        for (index, phase) in self.layout.phases.iter().enumerate() {
            for (k, share) in self.shares(phase).into_iter().enumerate() {
                guess(index, share, &mut node);
                let at = self.layout.node_at(phase, k);
                let count = if k < phase.nodes { width } else { states };
                x[at..at + count].copy_from_slice(&node[..count]);
            }
        }
        let free = self.motion.durations().iter().filter_map(|duration| match *duration {
            Duration::Free { guess_s, .. } => Some(guess_s),
            _ => None,
        });
        for (x, guess_s) in x[self.layout.parameters_at..].iter_mut().zip(free) {
            *x = guess_s;
        }
        x
    }

    /// When the nodes of a phase and its end come, as shares of its duration.
    pub(super) fn shares(&self, phase: &PhaseLayout) -> Vec<f64> {
        let mut shares = Vec::with_capacity(phase.nodes + 1);
        let mut begin = 0.0;
        for segment in &phase.segments {
            let points = &self.rules[segment.order].points[..segment.order];
            shares.extend(points.iter().map(|τ| begin + 0.5 * (τ + 1.0) * segment.share));
            begin += segment.share;
        }
        shares.push(1.0);
        shares
    }

    /// Half-length of every segment of a phase, s.
    pub(super) fn half_length(&self, phase: &PhaseLayout, segment: usize, x: &[f64]) -> f64 {
        0.5 * phase.segments[segment].share * phase.duration.at(&x[self.layout.parameters_at..])
    }

    /// Defects of a segment, from the accelerations at its nodes.
    pub(super) fn defects(&self, phase: &PhaseLayout, segment: usize, x: &[f64], accelerations: &[f64], c: &mut [f64]) {
        let (nq, n, width) = (self.layout.coordinates, self.layout.states(), self.layout.width());
        let (first, order) = (phase.segments[segment].first, phase.segments[segment].order);
        let η = self.half_length(phase, segment, x);
        let x = &x[self.layout.node_at(phase, first)..];
        let c = &mut c[self.layout.defect_at(phase, first)..][..order * n];
        c.fill(0.0);
        let differentiation = &self.rules[order].differentiation;
        for (k, c) in c.chunks_exact_mut(n).enumerate() {
            for i in 0..=order {
                add_scaled(c, differentiation[(k, i)], &x[i * width..i * width + n]);
            }
            add_scaled(&mut c[..nq], -η, &x[k * width + nq..k * width + n]);
            add_scaled(&mut c[nq..], -η, &accelerations[k * nq..(k + 1) * nq]);
        }
    }

    pub(super) fn end_evaluate(&mut self, index: usize, x: &[f64], c: &mut [f64], d: &mut [f64]) {
        let n = self.layout.states();
        let phase = &self.layout.phases[index];
        let is_last = index + 1 == self.layout.phases.len();
        self.end.events.resize(phase.events, 0.0);
        self.end.rows.resize(phase.end_rows, 0.0);
        self.end.next.resize(if is_last { 0 } else { n }, 0.0);
        let state = &x[self.layout.node_at(phase, phase.nodes)..][..n];
        self.motion.end_values(index, state, &mut self.end);
        c[phase.events_at..][..phase.events].copy_from_slice(&self.end.events);
        d[phase.end_rows_at..][..phase.end_rows].copy_from_slice(&self.end.rows);
        if !is_last {
            let next = &x[self.layout.phases[index + 1].variables_at..][..n];
            for (c, (next, link)) in c[phase.link_at..][..n].iter_mut().zip(next.iter().zip(&self.end.next)) {
                *c = next - link;
            }
        }
    }

    pub(super) fn end_linearise(&mut self, index: usize, x: &[f64], y: &[f64], v: &[f64]) {
        let n = self.layout.states();
        let phase = &self.layout.phases[index];
        let end = &mut self.point.ends[index];
        let links = if end.next.is_empty() { 0 } else { n };
        let (mut rows, mut next) = ([0.0; 64], [0.0; 32]);
        for (to, v) in rows.iter_mut().zip(&v[phase.end_rows_at..][..phase.end_rows]) {
            *to = -v;
        }
        for (to, y) in next.iter_mut().zip(&y[phase.link_at..][..links]) {
            *to = -y;
        }
        let events = &y[phase.events_at..][..phase.events];
        let weights = EndWeights { events, rows: &rows[..phase.end_rows], next: &next[..links] };
        for values in [&mut end.events, &mut end.rows, &mut end.next, &mut end.hessian] {
            values.fill(0.0);
        }
        let derivatives = EndDerivatives {
            events: &mut end.events,
            rows: &mut end.rows,
            next: &mut end.next,
            hessian: &mut end.hessian,
        };
        let state = &x[self.layout.node_at(phase, phase.nodes)..][..n];
        self.motion.end_differentiate(index, state, weights, derivatives);
    }

    /// Derivatives at a node; `weight` is that of the quadrature.
    #[expect(clippy::too_many_arguments, reason = "a node's place in the vectors")]
    pub(super) fn node_linearise(
        &mut self,
        index: usize,
        node: usize,
        (η, weight): (f64, f64),
        x: &[f64],
        y: &[f64],
        v: &[f64],
        gradient: &mut [f64],
    ) {
        let (nq, n, width) = (self.layout.coordinates, self.layout.states(), self.layout.width());
        let phase = &self.layout.phases[index];
        let at = self.layout.node_at(phase, node);
        let k = phase.first_node + node;
        let y = &y[self.layout.defect_at(phase, node)..][..n];
        let row_offset = phase.rows_at + node * phase.rows;
        let mut acceleration = [0.0; 16];
        let mut row_weights = [0.0; 64];
        for (to, y) in acceleration.iter_mut().zip(&y[nq..]) {
            *to = -η * y;
        }
        for (to, v) in row_weights.iter_mut().zip(&v[row_offset..row_offset + phase.rows]) {
            *to = -v;
        }
        let weights =
            NodeWeights { cost: η * weight, acceleration: &acceleration[..nq], rows: &row_weights[..phase.rows] };
        self.cost_gradient.fill(0.0);
        let point = &mut self.point;
        let jacobian = &mut point.jacobians[k * nq * width..][..nq * width];
        let rows = &mut point.rows[row_offset * width..][..phase.rows * width];
        let hessian = &mut point.hessians[k * width * width..][..width * width];
        jacobian.fill(0.0);
        rows.fill(0.0);
        hessian.fill(0.0);
        let derivatives = NodeDerivatives { acceleration: jacobian, cost: &mut self.cost_gradient, rows, hessian };
        self.motion.differentiate(index, &x[at..at + width], weights, derivatives);
        add_scaled(&mut gradient[at..at + width], η * weight, &self.cost_gradient);
        if self.layout.parameters > 0 {
            // d/dη of the gradient of the Lagrangian: w ∇l - y^T ∇f
            let cross = &mut point.cross[k * width..][..width];
            cross.fill(0.0);
            add_scaled(cross, weight, &self.cost_gradient);
            add_scaled(&mut cross[nq..n], -1.0, &y[..nq]);
            for (jacobian, y) in point.jacobians[k * nq * width..][..nq * width].chunks_exact(width).zip(&y[nq..]) {
                add_scaled(cross, -y, jacobian);
            }
        }
    }

    /// Running cost and accelerations of a segment's nodes; path rows are written.
    pub(super) fn segment_values(
        &mut self,
        (index, k): (usize, usize),
        x: &[f64],
        accelerations: &mut [f64],
        d: &mut [f64],
    ) -> f64 {
        let (nq, width) = (self.layout.coordinates, self.layout.width());
        let phase = &self.layout.phases[index];
        let (first, order) = (phase.segments[k].first, phase.segments[k].order);
        let mut cost = 0.0;
        for i in 0..order {
            let at = self.layout.node_at(phase, first + i);
            let rows = &mut d[phase.rows_at + (first + i) * phase.rows..][..phase.rows];
            let acceleration = &mut accelerations[i * nq..(i + 1) * nq];
            cost += self.rules[order].weights[i] * self.motion.values(index, &x[at..at + width], acceleration, rows);
        }
        cost
    }
}

fn bounds(motion: &dyn Motion, layout: &Layout) -> (Vec<f64>, Vec<f64>) {
    let mut lower = vec![f64::NEG_INFINITY; layout.variables()];
    let mut upper = vec![f64::INFINITY; layout.variables()];
    for (index, phase) in layout.phases.iter().enumerate() {
        let (low, high) = motion.bounds(index);
        // where phases begin and end, events and links say what the states are: a bound that holds with equality there
        // would leave no interior
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
    let free = motion.durations().iter().filter_map(|duration| match *duration {
        Duration::Free { least_s, most_s, .. } => Some((least_s, most_s)),
        _ => None,
    });
    for (k, (least_s, most_s)) in free.enumerate() {
        lower[layout.parameters_at + k] = least_s;
        upper[layout.parameters_at + k] = most_s;
    }
    (lower, upper)
}

fn linearisation(layout: &Layout) -> Linearisation {
    let (nodes, n, width) = (layout.nodes(), layout.states(), layout.width());
    let last = layout.phases.len() - 1;
    let end = |(index, phase): (usize, &PhaseLayout)| End {
        events: vec![0.0; phase.events * n],
        rows: vec![0.0; phase.end_rows * n],
        next: if index < last { vec![0.0; n * n] } else { Vec::new() },
        hessian: vec![0.0; n * n],
        weighted: vec![0.0; n * n],
    };
    Linearisation {
        hessians: vec![0.0; nodes * width * width],
        weighted: vec![0.0; nodes * width * width],
        jacobians: vec![0.0; nodes * layout.coordinates * width],
        accelerations: vec![0.0; nodes * layout.coordinates],
        rows: vec![0.0; layout.inequalities * width],
        cross: vec![0.0; nodes * width],
        variables: vec![0.0; layout.variables()],
        ends: layout.phases.iter().enumerate().map(end).collect(),
        parameter_diagonal: vec![0.0; layout.parameters],
    }
}
