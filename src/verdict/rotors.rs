/// Rotors together, which follow their command with a lag, if they have one.
#[derive(Clone, Copy, Debug)]
pub struct Rotors {
    /// Total thrust now, N.
    total_n: f64,
    time_constant_s: Option<f64>,
}

impl Rotors {
    /// As they are when the flight begins, with this total thrust, N.
    pub fn new(total_n: f64, time_constant_s: Option<f64>) -> Self {
        Self { total_n, time_constant_s }
    }

    /// Mean total thrust over a step for which this one is commanded, N.
    ///
    /// ```text
    /// T' = (T_c - T)/τ  =>  mean T = T_c + (T_0 - T_c) τ/h (1 - exp(-h/τ))                      over a step h
    /// ```
    pub fn mean_n(&mut self, command_n: f64, step_s: f64) -> f64 {
        let Some(time_s) = self.time_constant_s else { return command_n };
        let ahead_n = self.total_n - command_n;
        let lag = (-step_s / time_s).exp();
        self.total_n = command_n + ahead_n * lag;
        command_n + ahead_n * (1.0 - lag) * time_s / step_s
    }
}

#[cfg(test)]
mod tests {
    use super::Rotors;

    #[test]
    fn the_mean_is_that_of_an_exponential_and_without_lag_the_command() {
        let (mut rotors, [mut sum, steps]) = (Rotors::new(1.0, Some(0.05)), [0.0, 1000.0]);
        let whole = rotors.mean_n(3.0, 0.1);
        let mut fine = Rotors::new(1.0, Some(0.05));
        for _ in 0..1000 {
            sum += fine.mean_n(3.0, 0.1 / steps);
        }
        assert!((whole - sum / steps).abs() < 1e-12);
        // 3 - 2 · 0.5 (1 - e⁻²)
        assert!((whole - 2.135_335_283_236_613).abs() < 1e-12, "{whole}");
        assert_eq!(Rotors::new(1.0, None).mean_n(3.0, 0.1), 3.0);
    }
}
