//! How quickly a vehicle manoeuvres. It sets the length of the intervals, the width of the trust region and the radius
//! of initial turns, so that slow and fast vehicles are planned alike.

use scenarios::fixed_wing::{GRAVITY_MPS2, Limits};

use super::super::dynamics::State;

/// Change of heading, rad, of flight-path angle and of speed, as fractions of their ranges, that fit into one interval.
const CHANGE_PER_INTERVAL: [f64; 3] = [0.25, 1.3, 0.8];

/// Bounds of the number of intervals of a flight.
const INTERVALS: [usize; 2] = [20, 1000];

/// Bounds of the scale of the trust region of the position.
const POSITION_SCALES: [f64; 2] = [0.02, 2.0];

/// The vehicle for which the trust region is given, that of the paper: speed, m/s, and its range, m/s; horizontal load
/// factor; range of the flight-path angle, deg.
const REFERENCE_SPEED_MPS: f64 = 35.0;
const REFERENCE_SPEED_RANGE_MPS: f64 = 10.0;
const REFERENCE_N_Y: f64 = 0.2;
const REFERENCE_CLIMB_RANGE_DEG: f64 = 10.0;

/// Smallest load factor that counts as one.
const MIN_LOAD_FACTOR: f64 = 0.01;

/// The agility of a vehicle within its planning limits.
#[derive(Clone, Copy, Debug)]
pub struct Agility<'a> {
    limits: &'a Limits,
    mean_speed_mps: f64,
}

impl<'a> Agility<'a> {
    /// The agility within `limits`.
    pub fn new(limits: &'a Limits) -> Self {
        Self { limits, mean_speed_mps: 0.5 * (limits.speed_mps.min + limits.speed_mps.max) }
    }

    /// Smallest turn radius at a speed, m.
    pub fn turn_radius_m(&self, speed_mps: f64) -> f64 {
        speed_mps * speed_mps / (GRAVITY_MPS2 * self.n_y())
    }

    /// Magnitude of the acceleration along the path that is available in both directions, m/s².
    pub fn acceleration_mps2(&self) -> f64 {
        GRAVITY_MPS2 * self.limits.n_x.max.min(-self.limits.n_x.min).max(MIN_LOAD_FACTOR)
    }

    /// Number of intervals for a flight of `flight_time_s`.
    pub fn intervals(&self, flight_time_s: f64) -> usize {
        let [min, max] = INTERVALS;
        let count = (flight_time_s / self.interval_s()).ceil();
        if count < max as f64 { (count as usize).max(min) } else { max }
    }

    /// Longest interval within which a linear change of the controls describes what the vehicle can do, s.
    pub fn interval_s(&self) -> f64 {
        let [turn, climb, speed] = CHANGE_PER_INTERVAL;
        let n_z = (self.limits.n_z.max - 1.0).min(1.0 - self.limits.n_z.min).max(MIN_LOAD_FACTOR);
        let turn_s = turn * self.mean_speed_mps / (GRAVITY_MPS2 * self.n_y());
        let climb_range_rad = self.limits.flight_path_deg.width().to_radians();
        let climb_s = climb * climb_range_rad * self.mean_speed_mps / (GRAVITY_MPS2 * n_z);
        let speed_s = speed * self.limits.speed_mps.width() / self.acceleration_mps2();
        turn_s.min(climb_s.max(0.3 * turn_s)).min(speed_s.max(0.3 * turn_s))
    }

    /// Factors on the half-widths of a trust region that is given for the paper's vehicle.
    pub fn trust_region_scale(&self) -> State {
        let reference_m = REFERENCE_SPEED_MPS * REFERENCE_SPEED_MPS / (GRAVITY_MPS2 * REFERENCE_N_Y);
        let [min, max] = POSITION_SCALES;
        let position = (self.turn_radius_m(self.mean_speed_mps) / reference_m).clamp(min, max);
        let speed = (self.limits.speed_mps.width() / REFERENCE_SPEED_RANGE_MPS).clamp(min, max);
        let climb = (self.limits.flight_path_deg.width() / REFERENCE_CLIMB_RANGE_DEG).clamp(min, max);
        State::new(position, position, 1.0, speed, 1.0, climb)
    }

    fn n_y(&self) -> f64 {
        self.limits.n_y.max.min(-self.limits.n_y.min).max(MIN_LOAD_FACTOR)
    }
}

#[cfg(test)]
mod tests {
    use scenarios::Range;

    use super::*;

    fn limits(speed_mps: Range, n_y: f64) -> Limits {
        Limits {
            altitude_m: Range::new(300.0, 500.0),
            speed_mps,
            flight_path_deg: Range::new(-5.0, 5.0),
            n_x: Range::new(-0.2, 0.2),
            n_y: Range::new(-n_y, n_y),
            n_z: Range::new(0.8, 1.2),
        }
    }

    #[test]
    fn the_paper_s_vehicle_has_its_intervals_and_its_trust_region() {
        let limits = limits(Range::new(30.0, 40.0), 0.2);
        let agility = Agility::new(&limits);
        assert_eq!(agility.trust_region_scale(), State::repeat(1.0));
        assert!((3.5..5.0).contains(&agility.interval_s()), "{} s", agility.interval_s());
        assert_eq!((agility.intervals(10.0), agility.intervals(1e9)), (20, 1000));
    }

    #[test]
    fn slow_vehicles_have_shorter_intervals_and_narrower_trust_regions() {
        let limits = limits(Range::new(10.0, 14.0), 0.3);
        let agility = Agility::new(&limits);
        assert!((0.5..1.5).contains(&agility.interval_s()), "{} s", agility.interval_s());
        assert!((agility.turn_radius_m(12.0) - 48.9).abs() < 0.2);
        assert!(agility.trust_region_scale()[0] < 0.1);
    }
}
