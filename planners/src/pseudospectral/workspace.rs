/// Work vectors of the Riccati recursion.
#[derive(Clone, Debug, Default)]
pub struct Workspace {
    /// Matrices of the cost-to-go after and before the present stage, and a product on the way to the latter.
    pub after: Vec<f64>,
    pub before: Vec<f64>,
    pub half: Vec<f64>,
    /// Vectors of the cost-to-go after and before the present stage.
    pub after_vector: Vec<f64>,
    pub before_vector: Vec<f64>,
    /// Negative of the right-hand side of the variables.
    pub gradient: Vec<f64>,
    /// Present state of the forward pass, and the first state of the next phase.
    pub state: Vec<f64>,
    pub next: Vec<f64>,
    /// Step of the parameters.
    pub parameters: Vec<f64>,
}

impl Workspace {
    /// Work vectors for these numbers of states, parameters and variables.
    pub fn new(states: usize, parameters: usize, variables: usize) -> Self {
        let size = states + parameters;
        let [after, before, half] = [(); 3].map(|()| vec![0.0; size * size]);
        let [after_vector, before_vector] = [(); 2].map(|()| vec![0.0; size]);
        let [state, next] = [(); 2].map(|()| vec![0.0; states]);
        let (gradient, parameters) = (vec![0.0; variables], vec![0.0; parameters]);
        Self { after, before, half, after_vector, before_vector, gradient, state, next, parameters }
    }
}
