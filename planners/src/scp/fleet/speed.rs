//! Speed profile along a route: change to a cruising speed, cruise, change to the speed at the goal.

/// Fraction of the acceleration limit that the profile uses: the planner's nodes cannot follow its corners.
pub const ACCELERATION_FRACTION: f64 = 0.8;

/// A speed profile over a route of a certain length.
#[derive(Clone, Copy, Debug)]
pub struct SpeedProfile {
    /// Speeds at the start, while cruising and at the goal, m/s.
    speeds_mps: [f64; 3],
    /// Magnitude of the changes, m/s².
    acceleration_mps2: f64,
    cruise_s: f64,
}

impl SpeedProfile {
    /// The profile over `length_m` with the cruising speed `cruise_mps`, or the nearest one for which the route is long
    /// enough for both changes of speed.
    pub fn cruising(length_m: f64, [start_mps, goal_mps]: [f64; 2], cruise_mps: f64, limit_mps2: f64) -> Self {
        let acceleration_mps2 = ACCELERATION_FRACTION * limit_mps2;
        let mean_square = 0.5 * (start_mps * start_mps + goal_mps * goal_mps);
        let max_mps = (mean_square + acceleration_mps2 * length_m).sqrt().max(start_mps.max(goal_mps));
        let min_mps = (mean_square - acceleration_mps2 * length_m).max(0.0).sqrt().min(start_mps.min(goal_mps));
        let cruise_mps = cruise_mps.clamp(min_mps, max_mps);
        let mut profile = Self { speeds_mps: [start_mps, cruise_mps, goal_mps], acceleration_mps2, cruise_s: 0.0 };
        let changes_m = profile.distance_m(profile.duration_s());
        profile.cruise_s = ((length_m - changes_m) / cruise_mps).max(0.0);
        profile
    }

    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        let [first_s, last_s] = self.changes_s();
        first_s + self.cruise_s + last_s
    }

    /// Distance along the route after `t_s`, m.
    pub fn distance_m(&self, t_s: f64) -> f64 {
        let [start_mps, cruise_mps, goal_mps] = self.speeds_mps;
        let [first_s, last_s] = self.changes_s();
        let during = |t_s: f64, change_s: f64, from: f64, to: f64| {
            let t_s = t_s.clamp(0.0, change_s);
            if change_s > 0.0 { t_s * (from + 0.5 * (to - from) * t_s / change_s) } else { 0.0 }
        };
        during(t_s, first_s, start_mps, cruise_mps)
            + cruise_mps * (t_s - first_s).clamp(0.0, self.cruise_s)
            + during(t_s - first_s - self.cruise_s, last_s, cruise_mps, goal_mps)
    }

    /// Speed after `t_s`, m/s.
    pub fn speed_mps(&self, t_s: f64) -> f64 {
        let [start_mps, cruise_mps, goal_mps] = self.speeds_mps;
        let [first_s, last_s] = self.changes_s();
        let fraction = |t_s: f64, change_s: f64| if change_s > 0.0 { (t_s / change_s).clamp(0.0, 1.0) } else { 1.0 };
        let last = if last_s > 0.0 { fraction(t_s - first_s - self.cruise_s, last_s) } else { 0.0 };
        start_mps + (cruise_mps - start_mps) * fraction(t_s, first_s) + (goal_mps - cruise_mps) * last
    }

    fn changes_s(&self) -> [f64; 2] {
        let [start_mps, cruise_mps, goal_mps] = self.speeds_mps;
        [start_mps, goal_mps].map(|speed| (cruise_mps - speed).abs() / self.acceleration_mps2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn profile_ends_at_the_goal_at_its_speed() {
        for cruise_mps in [30.0, 35.0, 40.0] {
            let profile = SpeedProfile::cruising(6000.0, [35.0, 33.0], cruise_mps, 2.0);
            let end_s = profile.duration_s();
            assert!((profile.distance_m(end_s) - 6000.0).abs() < 1e-9);
            assert!((profile.speed_mps(0.0) - 35.0).abs() < 1e-12 && (profile.speed_mps(end_s) - 33.0).abs() < 1e-12);
            assert!((profile.speed_mps(end_s / 2.0) - cruise_mps).abs() < 1e-12);
            let (before_m, after_m) = (profile.distance_m(99.9), profile.distance_m(100.1));
            assert!(((after_m - before_m) / 0.2 - profile.speed_mps(100.0)).abs() < 1e-9);
        }
    }
}
