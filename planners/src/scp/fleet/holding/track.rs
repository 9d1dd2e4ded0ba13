//! Where a vehicle is at any time.

use super::super::super::iterate::Iterate;
use super::super::motion::{self, MotionSample, TimeSlice, VehicleMotion};

/// The horizontal motion of a vehicle as far as it is planned: until its arrival, and after it.
#[derive(Clone, Debug)]
pub struct Track {
    parts: Vec<Part>,
}

/// The motion along one trajectory.
#[derive(Clone, Debug)]
struct Part {
    from_s: f64,
    dt_s: f64,
    slices: Vec<TimeSlice>,
}

impl Track {
    /// The motion of `trajectory`, which begins at time 0.
    pub fn new(trajectory: &Iterate) -> Self {
        Self { parts: vec![Part::new(0.0, trajectory)] }
    }

    /// Adds the motion after the arrival.
    pub fn go_on(&mut self, hold: &Iterate) {
        self.parts.push(Part::new(self.end_s(), hold));
    }

    /// Until when it is planned, s.
    pub fn end_s(&self) -> f64 {
        self.parts.last().map_or(0.0, Part::end_s)
    }

    /// The motion at a time, s; beyond the end straight on.
    pub fn at(&self, t_s: f64) -> MotionSample {
        let part = self.parts.iter().find(|part| t_s <= part.end_s()).unwrap_or(&self.parts[self.parts.len() - 1]);
        motion::at(&part.slices, part.dt_s, t_s - part.from_s)
    }
}

impl Part {
    fn new(from_s: f64, trajectory: &Iterate) -> Self {
        let motion = VehicleMotion::new(trajectory);
        Self { from_s, dt_s: motion.dt_s, slices: motion.slices(motion.dt_s) }
    }

    fn end_s(&self) -> f64 {
        self.from_s + self.dt_s * self.slices.len() as f64
    }
}
