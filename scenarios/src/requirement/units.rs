//! Units and dimensions.

/// Exponents of metre, second, radian and newton.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Dimension(pub [i8; 4]);

impl Dimension {
    pub const NUMBER: Self = Self([0; 4]);
    pub const LENGTH: Self = Self([1, 0, 0, 0]);
    pub const TIME: Self = Self([0, 1, 0, 0]);
    pub const SPEED: Self = Self([1, -1, 0, 0]);
    pub const ACCELERATION: Self = Self([1, -2, 0, 0]);
    pub const ANGLE: Self = Self([0, 0, 1, 0]);
    pub const FORCE: Self = Self([0, 0, 0, 1]);

    /// That of a product.
    pub fn times(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].saturating_add(other.0[i])))
    }

    /// That of a quotient.
    pub fn per(self, other: Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i].saturating_sub(other.0[i])))
    }

    /// The unit in which people read it, and its size in SI units and radians; `None` where there is none.
    pub fn display_unit(self) -> Option<(&'static str, f64)> {
        let known = [
            (Self::NUMBER, "-", 1.0),
            (Self::LENGTH, "m", 1.0),
            (Self::TIME, "s", 1.0),
            (Self::SPEED, "m/s", 1.0),
            (Self::ACCELERATION, "m/s²", 1.0),
            (Self::ANGLE, "deg", DEGREE),
            (Self::FORCE, "N", 1.0),
            (Self([2, 0, 0, 0]), "m²", 1.0),
            (Self([0, -1, 1, 0]), "deg/s", DEGREE),
        ];
        known.into_iter().find(|(dimension, ..)| *dimension == self).map(|(_, unit, size)| (unit, size))
    }

    /// In words, for messages.
    pub fn describe(self) -> String {
        match self.display_unit() {
            Some(("-", _)) => "a number without unit".to_owned(),
            Some((unit, _)) => format!("a quantity in {unit}"),
            None => {
                let part = |(name, &power): (&str, &i8)| (power != 0).then(|| format!("{name}^{power}"));
                let parts: Vec<String> = ["m", "s", "rad", "N"].into_iter().zip(&self.0).filter_map(part).collect();
                format!("a quantity in {}", parts.join(" "))
            }
        }
    }
}

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// A unit of a constant.
#[derive(Debug)]
pub(super) struct Unit {
    pub name: &'static str,
    pub dimension: Dimension,
    /// Its size in SI units and radians.
    pub size: f64,
}

const fn unit(name: &'static str, dimension: Dimension, size: f64) -> Unit {
    Unit { name, dimension, size }
}

/// Every unit; of two that begin alike, the longer one first.
pub(super) const UNITS: &[Unit] = &[
    unit("m/s^2", Dimension::ACCELERATION, 1.0),
    unit("m/s²", Dimension::ACCELERATION, 1.0),
    unit("m/s", Dimension::SPEED, 1.0),
    unit("km/h", Dimension::SPEED, 1.0 / 3.6),
    unit("kt", Dimension::SPEED, 1852.0 / 3600.0),
    unit("kn", Dimension::SPEED, 1852.0 / 3600.0),
    unit("deg/s", Dimension([0, -1, 1, 0]), DEGREE),
    unit("rad/s", Dimension([0, -1, 1, 0]), 1.0),
    unit("deg", Dimension::ANGLE, DEGREE),
    unit("rad", Dimension::ANGLE, 1.0),
    unit("min", Dimension::TIME, 60.0),
    unit("ms", Dimension::TIME, 1e-3),
    unit("s", Dimension::TIME, 1.0),
    unit("nmi", Dimension::LENGTH, 1852.0),
    unit("km", Dimension::LENGTH, 1000.0),
    unit("ft", Dimension::LENGTH, 0.3048),
    unit("m", Dimension::LENGTH, 1.0),
    unit("N", Dimension::FORCE, 1.0),
];
