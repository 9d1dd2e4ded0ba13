use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Range;

/// A gate for a quadrotor with a slung load: at one instant, the quadrotor must be in its window and the load in its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gate {
    /// Name, unique among the gates.
    pub name: String,
    /// Window of the centre of the quadrotor.
    pub quadrotor: Window,
    /// Window of the centre of the load.
    pub load: Window,
}

/// An axis-aligned region. An axis that is left out is unbounded.
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
    /// Depth inside the window, of quadrotor or load, whichever is less, m; negative if one of them is outside. NaN if a
    /// position is NaN.
    pub fn margin_m(&self, quadrotor_m: [f64; 3], load_m: [f64; 3]) -> f64 {
        let (quadrotor_m, load_m) = (self.quadrotor.margin_m(quadrotor_m), self.load.margin_m(load_m));
        // f64::min would ignore NaN.
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

    /// Distance from a point to the nearest face, m; negative outside, infinite without faces.
    fn margin_m(&self, point_m: [f64; 3]) -> f64 {
        let faces = self.axes().into_iter().zip(point_m);
        let margins = faces.filter_map(|(range, at_m)| Some(range?.margin(at_m)));
        margins.fold(f64::INFINITY, |min, margin| if margin.is_nan() || margin < min { margin } else { min })
    }
}

#[cfg(test)]
mod tests {
    use super::{Gate, Range, Window};

    #[test]
    fn quadrotor_and_load_must_be_in_their_windows() {
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
