use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Range;

/// A gate for a quadrotor with a slung load: at one and the same instant the quadrotor is in its window and the load is in
/// the load's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gate {
    /// Name, unique among the gates.
    pub name: String,
    /// Where the quadrotor's centre has to be.
    pub quadrotor: Window,
    /// Where the load's centre has to be.
    pub load: Window,
}

/// A part of space with faces along the axes. An axis that is left out is not restricted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Window {
    /// West and east face, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub x_m: Option<Range>,
    /// South and north face, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub y_m: Option<Range>,
    /// Lower and upper face, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub z_m: Option<Range>,
}

impl Gate {
    /// How far inside its window that of the two is which is less so, m: negative while one of them is outside.
    pub fn margin_m(&self, quadrotor_m: [f64; 3], load_m: [f64; 3]) -> f64 {
        let (quadrotor_m, load_m) = (self.quadrotor.margin_m(quadrotor_m), self.load.margin_m(load_m));
        // of two numbers of which one is none, none is the smaller
        if quadrotor_m.is_nan() {
            quadrotor_m
        } else if load_m < quadrotor_m || load_m.is_nan() {
            load_m
        } else {
            quadrotor_m
        }
    }
}

impl Window {
    /// The faces in the order x, y, z.
    pub fn axes(&self) -> [Option<Range>; 3] {
        [self.x_m, self.y_m, self.z_m]
    }

    /// Distance from a point to the nearest face, m: negative outside, infinite where there are no faces.
    fn margin_m(&self, point_m: [f64; 3]) -> f64 {
        let faces = self.axes().into_iter().zip(point_m);
        let margins = faces.filter_map(|(range, at_m)| Some(range?.margin(at_m)));
        margins.fold(f64::INFINITY, |least, margin| if margin.is_nan() || margin < least { margin } else { least })
    }
}

#[cfg(test)]
mod tests {
    use super::{Gate, Range, Window};

    #[test]
    fn both_must_be_in_their_windows() {
        let quadrotor = Window { x_m: Some(Range::new(-1.0, 1.0)), z_m: Some(Range::new(0.0, 1.0)), y_m: None };
        let load = Window { z_m: Some(Range::new(2.0, 4.0)), ..Window::default() };
        let gate = Gate { name: "g".into(), quadrotor, load };
        let is = |quadrotor_m, load_m, margin_m: f64| (gate.margin_m(quadrotor_m, load_m) - margin_m).abs() < 1e-12;
        assert!(is([0.0, 9.0, 0.4], [5.0, 5.0, 3.0], 0.4));
        assert!(is([0.0, 9.0, 0.4], [5.0, 5.0, 2.1], 0.1));
        assert!(is([0.0, 9.0, 0.4], [5.0, 5.0, 1.7], -0.3));
        assert!(is([1.5, 9.0, 0.4], [5.0, 5.0, 1.7], -0.5));
        for (quadrotor_m, load_m) in [([0.0, 0.0, f64::NAN], [0.0, 0.0, 3.0]), ([0.0, 0.0, 0.5], [0.0, 0.0, f64::NAN])]
        {
            assert!(gate.margin_m(quadrotor_m, load_m).is_nan());
        }
    }
}
