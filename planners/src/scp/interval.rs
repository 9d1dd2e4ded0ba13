//! One interval between two nodes, and its defect.

use nalgebra::SMatrix;

use super::dynamics::{Control, ControlJacobian, State, StateJacobian};

/// One interval of a trajectory: its two nodes and its length.
#[derive(Clone, Copy, Debug)]
pub struct Interval {
    /// States at the beginning and at the end.
    pub states: [State; 2],
    /// Controls at the beginning and at the end.
    pub controls: [Control; 2],
    /// Length dt, s.
    pub dt_s: f64,
    /// Fraction of the interval, from its beginning, during which the control changes linearly from the first to the
    /// second value; it is constant afterwards. 1: first-order hold.
    pub ramp: f64,
}

impl Interval {
    /// Control at a fraction of the interval.
    pub fn control_at(&self, fraction: f64) -> Control {
        let progress = (fraction / self.ramp).min(1.0);
        self.controls[0] * (1.0 - progress) + self.controls[1] * progress
    }
}

/// Defect of an interval and its derivatives. The defect is zero when the trajectory satisfies the transcribed
/// equations of motion.
#[derive(Clone, Debug)]
pub struct Defect {
    /// The defect, in the units of the state.
    pub value: State,
    /// Derivatives with respect to both states.
    pub by_states: [StateJacobian; 2],
    /// Derivatives with respect to both controls.
    pub by_controls: [ControlJacobian; 2],
    /// Derivative with respect to dt, per second.
    pub by_dt: State,
}

impl Defect {
    /// ∂(defect)/∂(s, u) at one end, 6 x 9.
    pub fn by_node(&self, end: usize) -> SMatrix<f64, 6, 9> {
        let mut jacobian = SMatrix::<f64, 6, 9>::zeros();
        jacobian.fixed_columns_mut::<6>(0).copy_from(&self.by_states[end]);
        jacobian.fixed_columns_mut::<3>(6).copy_from(&self.by_controls[end]);
        jacobian
    }
}
