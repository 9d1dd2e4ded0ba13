/// Vectors that a sweep over the horizon works in.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    /// Cost-to-go after and before what is looked at: matrix, and a product on the way to it.
    pub after: Vec<f64>,
    pub before: Vec<f64>,
    pub half: Vec<f64>,
    /// The same, its vector.
    pub after_vector: Vec<f64>,
    pub before_vector: Vec<f64>,
    /// Negative of the right-hand side of the variables.
    pub gradient: Vec<f64>,
    /// Where the forward sweep is, and the first state of the next phase.
    pub state: Vec<f64>,
    pub next: Vec<f64>,
    /// The parameters' step.
    pub parameters: Vec<f64>,
}

impl Workspace {
    /// Room for so many states, parameters and variables.
    pub fn new(states: usize, parameters: usize, variables: usize) -> Self {
        let size = states + parameters;
        let [after, before, half] = [(); 3].map(|()| vec![0.0; size * size]);
        let [after_vector, before_vector] = [(); 2].map(|()| vec![0.0; size]);
        let [state, next] = [(); 2].map(|()| vec![0.0; states]);
        let (gradient, parameters) = (vec![0.0; variables], vec![0.0; parameters]);
        Self { after, before, half, after_vector, before_vector, gradient, state, next, parameters }
    }
}
