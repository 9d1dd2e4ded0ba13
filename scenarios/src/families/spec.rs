use crate::plan_input::columns::Columns;
use crate::plan_input::{ColumnTable, ImportedTrajectory};
use crate::{AppliedLimits, Family, Issue, Scenario, Waypoint, World};

/// One row of the table of families: what differs between them, apart from their types.
pub(crate) struct FamilySpec {
    /// Key in scenario and plan files: `fixed-wing`.
    pub key: &'static str,
    /// Name in prose: `fixed wing`.
    pub name: &'static str,
    /// Whether it hovers at its goal once it has arrived; otherwise it flies on.
    pub hovers: bool,
    /// Whether it carries a load.
    pub carries_load: bool,
    /// Whether it senses obstacles and other vehicles in flight.
    pub senses_obstacles: bool,
    /// Limits of the verdict where the scenario gives none.
    pub verdict_limits: AppliedLimits,
    /// Columns of a plan file.
    pub columns: &'static Columns,
    /// Columns of the log of a flight flown elsewhere; `None` if it is not judged.
    pub flight_columns: Option<&'static Columns>,
    /// The trajectory in a table whose columns have been checked and converted.
    pub import: fn(&ColumnTable) -> ImportedTrajectory,
    /// What simulator and judge do not support for this family. It is refused, so that nothing is ignored silently.
    pub unsupported: fn(&Scenario) -> Vec<Issue>,
}

/// What every vehicle model provides, whatever its family.
pub trait VehicleModel {
    /// The family.
    fn family(&self) -> Family;

    /// Radius of the sphere about the vehicle's centre that encloses it, without its load, m.
    fn body_radius_m(&self) -> f64;

    /// The fields that would let moving air act on it; `None` if it does already.
    fn missing_drag(&self) -> Option<&'static str>;

    /// Whether it has rotors that tilt it, so that its attitude is measured.
    fn has_attitude(&self) -> bool;

    /// Parameters that are out of range or inconsistent. `field` is the model's path in the file.
    fn issues(&self, field: &str) -> Vec<Issue>;

    /// What makes `waypoint`, at the path `field`, impossible for this vehicle, beyond the rules for all families.
    fn waypoint_issues(&self, world: &World, field: &str, waypoint: &Waypoint) -> Vec<Issue>;
}

/// An issue with the list at `field` if it has more than `max` elements.
pub(crate) fn surplus(field: &str, count: usize, max: usize, expected: &str, remedy: &str) -> Option<Issue> {
    (count > max).then(|| Issue::new(field, format!("{count} of them"), expected).remedy(remedy))
}
