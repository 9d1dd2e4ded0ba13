//! The signals of formulas, declared once.

use super::units::Dimension;

/// What a signal measures of its subject.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "described in the table of signals")]
pub enum Quantity {
    East,
    North,
    Altitude,
    Height,
    ClimbRate,
    Speed,
    GroundSpeed,
    FlightPath,
    HeadingFrom,
    Acceleration,
    Distance,
    HorizontalDistance,
    Inside,
    Swing,
    Airspeed,
    WindSpeed,
    TrackingError,
    Bank,
    /// Of an axis: x, y, z.
    LoadFactor(usize),
    Thrust,
    Tension,
}

impl Quantity {
    /// Whether it is known only at the samples of the flight log.
    pub fn is_logged(self) -> bool {
        SIGNALS.iter().any(|spec| spec.quantity == self && spec.is_logged)
    }
}

/// What a signal is relative to: its last argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TargetKind {
    /// Nothing.
    None,
    /// The goal, an obstacle, a vehicle, the load, a point, or `obstacles` or `vehicles`: the nearest of all.
    Place,
    /// A geofence.
    Geofence,
    /// An angle.
    Bearing,
}

/// The declaration of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SignalSpec {
    /// Its name in formulas.
    pub name: &'static str,
    /// What it measures.
    pub quantity: Quantity,
    pub(super) dimension: Dimension,
    /// What it is relative to.
    pub target: TargetKind,
    /// Whether it is known only at the samples of the flight log.
    pub is_logged: bool,
    /// In one sentence.
    pub description: &'static str,
}

impl SignalSpec {
    /// The unit in which it is shown.
    pub fn unit(&self) -> &'static str {
        self.dimension.display_unit().map_or("-", |(unit, _)| unit)
    }
}

const fn motion(
    name: &'static str,
    quantity: Quantity,
    dimension: Dimension,
    target: TargetKind,
    description: &'static str,
) -> SignalSpec {
    SignalSpec { name, quantity, dimension, target, is_logged: false, description }
}

const fn logged(name: &'static str, quantity: Quantity, dimension: Dimension, description: &'static str) -> SignalSpec {
    SignalSpec { name, quantity, dimension, target: TargetKind::None, is_logged: true, description }
}

/// Every signal.
#[rustfmt::skip]
pub const SIGNALS: &[SignalSpec] = {
    use Dimension as D;
    use TargetKind::{Bearing, Geofence, None, Place};
    &[
        motion("east", Quantity::East, D::LENGTH, None, "Coordinate x of the world frame."),
        motion("north", Quantity::North, D::LENGTH, None, "Coordinate y of the world frame."),
        motion("altitude", Quantity::Altitude, D::LENGTH, None, "Coordinate z of the world frame."),
        motion("height", Quantity::Height, D::LENGTH, None, "Altitude above the terrain below, or above `world.ground_m` where there is no terrain."),
        motion("climb_rate", Quantity::ClimbRate, D::SPEED, None, "Vertical velocity, positive upwards."),
        motion("speed", Quantity::Speed, D::SPEED, None, "Magnitude of the velocity over ground, in space."),
        motion("ground_speed", Quantity::GroundSpeed, D::SPEED, None, "Magnitude of the horizontal velocity over ground."),
        motion("flight_path", Quantity::FlightPath, D::ANGLE, None, "Angle of the velocity above the horizontal."),
        motion("heading_from", Quantity::HeadingFrom, D::ANGLE, Bearing, "Angle from 0 to 180 deg between the horizontal velocity and a direction, counterclockwise from east."),
        motion("acceleration", Quantity::Acceleration, D::ACCELERATION, None, "Magnitude of the acceleration, in space."),
        motion("distance", Quantity::Distance, D::LENGTH, Place, "Distance from the centre to a place, in space; to the surface of an obstacle, negative inside."),
        motion("horizontal_distance", Quantity::HorizontalDistance, D::LENGTH, Place, "The same in the horizontal plane."),
        motion("inside", Quantity::Inside, D::LENGTH, Geofence, "Distance to the boundary of a geofence's volume, positive inside, whatever its kind."),
        motion("swing", Quantity::Swing, D::ANGLE, None, "Angle between the line from the quadrotor to its load and straight down."),
        logged("airspeed", Quantity::Airspeed, D::SPEED, "Magnitude of the velocity through the air."),
        logged("wind_speed", Quantity::WindSpeed, D::SPEED, "Magnitude of the velocity of the air."),
        logged("tracking_error", Quantity::TrackingError, D::LENGTH, "Distance from the reference that is tracked."),
        logged("bank", Quantity::Bank, D::ANGLE, "Angle between the lateral axis of the body and the horizontal, without sign."),
        logged("load_factor_x", Quantity::LoadFactor(0), D::NUMBER, "Load factor along the velocity, as it acted."),
        logged("load_factor_y", Quantity::LoadFactor(1), D::NUMBER, "Load factor to the side, as it acted."),
        logged("load_factor_z", Quantity::LoadFactor(2), D::NUMBER, "Load factor upwards, as it acted."),
        logged("thrust", Quantity::Thrust, D::FORCE, "Largest thrust of a rotor, as it acted."),
        logged("tension", Quantity::Tension, D::FORCE, "Mean tension of the cable over one step of the log."),
    ]
};
