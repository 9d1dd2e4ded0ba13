//! The separation rule of a fleet: a volume around every vehicle that no other vehicle may enter.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{FleetRules, Scenario};

/// One foot, m.
const FOOT_M: f64 = 0.3048;

/// Shape of the volume around a vehicle that no other vehicle may enter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SeparationShape {
    /// A vertical cylinder of any height: distances are horizontal.
    Horizontal,
    /// A sphere: distances are in space.
    Sphere,
    /// A vertical cylinder of radius `separation_m` that reaches `separation_height_m` up and down.
    Cylinder,
    /// An upright ellipsoid of the semi-axes `separation_m` (horizontal) and `separation_height_m` (vertical).
    Ellipsoid,
}

/// A volume with a name in aviation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SeparationVolume {
    /// Near mid-air collision: a cylinder of 500 ft that reaches 100 ft up and down (RTCA DO-365).
    Nmac,
    /// Well clear of small unmanned aircraft: a cylinder of 2000 ft that reaches 250 ft up and down (ASTM F3442; Weinert,
    /// Campbell, Vela, Schuldt, Kurucar 2018).
    WellClear,
}

/// How the distance of two vehicles is measured. Two vehicles that move by a metre change it by a metre at most.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeparationMeasure {
    /// In the horizontal plane.
    Horizontal,
    /// In space.
    Spatial,
    /// The larger one of the horizontal distance and of the vertical one, which counts from `height_m` - `radius_m`.
    Cylinder {
        /// Horizontal distance that is enough, m.
        radius_m: f64,
        /// Vertical distance that is enough, m.
        height_m: f64,
    },
    /// In space, each direction as a share of its semi-axis, times the smaller semi-axis.
    Ellipsoid {
        /// Horizontal semi-axis, m.
        radius_m: f64,
        /// Vertical semi-axis, m.
        height_m: f64,
    },
}

/// A separation rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Separation {
    /// How distances are measured.
    pub measure: SeparationMeasure,
    /// The smallest one that is allowed, m.
    pub limit_m: f64,
    /// A horizontal distance with which the rule holds, whatever the altitudes, m.
    pub horizontal_m: f64,
    /// A distance in space with which the rule holds, m; none if only horizontal distances count.
    pub spatial_m: Option<f64>,
}

impl SeparationMeasure {
    /// The distance, m.
    ///
    /// - `relative_m`: position of one vehicle relative to the other
    pub fn distance_m(self, relative_m: [f64; 3]) -> f64 {
        let [x_m, y_m, z_m] = relative_m;
        let horizontal_m = x_m.hypot(y_m);
        match self {
            Self::Horizontal => horizontal_m,
            Self::Spatial => horizontal_m.hypot(z_m),
            Self::Cylinder { radius_m, height_m } => {
                let vertical_m = z_m.abs() - height_m + radius_m;
                // NaN is larger than any distance that is known.
                if vertical_m > horizontal_m || vertical_m.is_nan() { vertical_m } else { horizontal_m }
            }
            Self::Ellipsoid { .. } => {
                let [x, y, z] = self.scale();
                (x * x_m).hypot(y * y_m).hypot(z * z_m)
            }
        }
    }

    /// Factors of the three coordinates, each at most 1, with which the measure is the length of the relative position; of a
    /// cylinder, whose measure is no length, one that is not larger.
    pub fn scale(self) -> [f64; 3] {
        match self {
            Self::Horizontal | Self::Cylinder { .. } => [1.0, 1.0, 0.0],
            Self::Spatial => [1.0; 3],
            Self::Ellipsoid { radius_m, height_m } => {
                let smaller_m = radius_m.min(height_m);
                [smaller_m / radius_m, smaller_m / radius_m, smaller_m / height_m]
            }
        }
    }

    /// In words, for titles.
    pub fn describe(self) -> &'static str {
        match self {
            Self::Horizontal => "horizontal",
            Self::Spatial => "in space",
            Self::Cylinder { .. } => "cylinder",
            Self::Ellipsoid { .. } => "ellipsoid",
        }
    }
}

impl SeparationVolume {
    /// Radius and height, m.
    fn size_m(self) -> [f64; 2] {
        let feet = match self {
            Self::Nmac => [500.0, 100.0],
            Self::WellClear => [2000.0, 250.0],
        };
        feet.map(|length| length * FOOT_M)
    }
}

impl Separation {
    fn new(shape: SeparationShape, radius_m: f64, height_m: Option<f64>) -> Option<Self> {
        let sized = match shape {
            SeparationShape::Horizontal => (SeparationMeasure::Horizontal, radius_m, None),
            SeparationShape::Sphere => (SeparationMeasure::Spatial, radius_m, Some(radius_m)),
            SeparationShape::Cylinder => {
                let height_m = height_m?;
                (SeparationMeasure::Cylinder { radius_m, height_m }, radius_m, Some(radius_m.hypot(height_m)))
            }
            SeparationShape::Ellipsoid => {
                let height_m = height_m?;
                let measure = SeparationMeasure::Ellipsoid { radius_m, height_m };
                (measure, radius_m.min(height_m), Some(radius_m.max(height_m)))
            }
        };
        let (measure, limit_m, spatial_m) = sized;
        Some(Self { measure, limit_m, horizontal_m: radius_m, spatial_m })
    }
}

impl FleetRules {
    /// The rule; none if the fleet has none.
    ///
    /// - `default_shape`: where the file names none
    pub(crate) fn separation(&self, default_shape: SeparationShape) -> Option<Separation> {
        if let Some(volume) = self.separation_volume {
            let [radius_m, height_m] = volume.size_m();
            return Separation::new(SeparationShape::Cylinder, radius_m, Some(height_m));
        }
        Separation::new(self.separation_shape.unwrap_or(default_shape), self.separation_m?, self.separation_height_m)
    }
}

impl Scenario {
    /// The separation rule of the fleet. Where the file names no shape, it is horizontal between fixed wings and in space
    /// between vehicles that hover.
    pub fn separation(&self) -> Option<Separation> {
        self.fleet.separation(self.default_separation_shape())
    }

    /// Horizontal distance between two vehicles with which the separation rule holds at any altitudes, m; none without a rule.
    pub fn horizontal_separation_m(&self) -> Option<f64> {
        Some(self.separation()?.horizontal_m)
    }

    /// How the distance between two vehicles is measured, with a rule or without.
    pub fn separation_measure(&self) -> SeparationMeasure {
        match (self.separation(), self.default_separation_shape()) {
            (Some(separation), _) => separation.measure,
            (None, SeparationShape::Horizontal) => SeparationMeasure::Horizontal,
            (None, _) => SeparationMeasure::Spatial,
        }
    }

    /// The rules of the fleet with the shape and the size of the separation filled in: a named volume as its cylinder.
    pub fn resolved_fleet(&self) -> FleetRules {
        let mut fleet = self.fleet.clone();
        if let Some(volume) = fleet.separation_volume.take() {
            let [radius_m, height_m] = volume.size_m();
            fleet.separation_shape = Some(SeparationShape::Cylinder);
            (fleet.separation_m, fleet.separation_height_m) = (Some(radius_m), Some(height_m));
        }
        if fleet.separation_m.is_some() {
            fleet.separation_shape = fleet.separation_shape.or(Some(self.default_separation_shape()));
        }
        fleet
    }

    /// The shape where the file names none.
    fn default_separation_shape(&self) -> SeparationShape {
        let hovers = |name: &str| self.models.get(name).is_some_and(|model| model.family().hovers());
        if self.vehicles.first().is_some_and(|vehicle| hovers(&vehicle.model)) {
            SeparationShape::Sphere
        } else {
            SeparationShape::Horizontal
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rule(text: &str) -> Separation {
        let fleet: FleetRules = toml::from_str(text).expect("fleet rules");
        fleet.separation(SeparationShape::Sphere).expect("a rule")
    }

    #[test]
    fn distances_reach_the_limit_on_the_surface_of_the_volume() {
        let cylinder = rule("separation_m = 5\nseparation_shape = \"cylinder\"\nseparation_height_m = 2");
        let ellipsoid = rule("separation_m = 0.4\nseparation_shape = \"ellipsoid\"\nseparation_height_m = 1.2");
        let (cosine, sine) = (0.6, 0.8);
        for (separation, on_surface_m) in [
            (cylinder, vec![[5.0, 0.0, 1.0], [0.0, -5.0, -1.9], [3.0, 1.0, 2.0], [0.0, 0.0, -2.0]]),
            (ellipsoid, vec![[0.4, 0.0, 0.0], [0.0, 0.0, -1.2], [0.0, 0.4 * cosine, 1.2 * sine]]),
            (rule("separation_m = 3"), vec![[3.0, 0.0, 0.0], [1.0, 2.0, -2.0]]),
            (rule("separation_m = 3\nseparation_shape = \"horizontal\""), vec![[0.0, 3.0, 70.0]]),
        ] {
            for relative_m in on_surface_m {
                let distance_m = separation.measure.distance_m(relative_m);
                assert!((distance_m - separation.limit_m).abs() < 1e-12, "{separation:?} {relative_m:?}: {distance_m}");
            }
        }
        assert_eq!(cylinder.measure.distance_m([0.0, 0.0, 0.0]), 3.0);
        assert!([0, 1, 2].iter().all(|&axis| {
            let mut relative_m = [6.0; 3];
            relative_m[axis] = f64::NAN;
            cylinder.measure.distance_m(relative_m).is_nan() && ellipsoid.measure.distance_m(relative_m).is_nan()
        }));
    }

    /// The rule holds at the distances that are stated to be enough.
    #[test]
    fn distances_that_are_enough_are_enough() {
        for text in [
            "separation_volume = \"nmac\"",
            "separation_volume = \"well-clear\"",
            "separation_m = 4",
            "separation_m = 4\nseparation_shape = \"ellipsoid\"\nseparation_height_m = 9",
            "separation_m = 4\nseparation_shape = \"cylinder\"\nseparation_height_m = 0.5",
        ] {
            let separation = rule(text);
            let spatial_m = separation.spatial_m.expect("in space");
            for step in 0..=200 {
                let (sine, cosine) = (f64::from(step) / 100.0 * std::f64::consts::PI).sin_cos();
                let apart_m = [cosine * spatial_m, 0.0, sine * spatial_m];
                let level_m = [0.0, separation.horizontal_m, 1e3 * sine];
                for relative_m in [apart_m, level_m] {
                    let distance_m = separation.measure.distance_m(relative_m);
                    assert!(distance_m >= separation.limit_m - 1e-9, "{text} {relative_m:?}: {distance_m}");
                }
            }
        }
    }

    #[test]
    fn resolved_rules_name_shape_and_size() {
        let mut scenario = crate::load("shipped:rendezvous-2".as_ref()).expect("a shipped scenario");
        let rule = |scenario: &Scenario| {
            let fleet = scenario.resolved_fleet();
            assert_eq!(fleet.separation(SeparationShape::Sphere), scenario.separation());
            (fleet.separation_m, fleet.separation_shape, fleet.separation_height_m, fleet.separation_volume)
        };
        assert_eq!(rule(&scenario), (Some(100.0), Some(SeparationShape::Horizontal), None, None));
        scenario.fleet = FleetRules { separation_volume: Some(SeparationVolume::Nmac), ..FleetRules::default() };
        assert_eq!(rule(&scenario), (Some(152.4), Some(SeparationShape::Cylinder), Some(30.48), None));
        scenario.fleet = FleetRules::default();
        assert_eq!(rule(&scenario), (None, None, None, None));
    }

    #[test]
    fn named_volumes_are_in_feet() {
        let nmac = rule("separation_volume = \"nmac\"");
        assert_eq!(nmac.measure, SeparationMeasure::Cylinder { radius_m: 152.4, height_m: 30.48 });
        assert_eq!(nmac.limit_m, 152.4);
    }
}
