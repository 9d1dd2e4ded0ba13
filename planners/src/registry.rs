use std::sync::LazyLock;

use crate::FAMILIES;
use crate::planner::Planner;

/// All planners.
pub fn registry() -> &'static [Planner] {
    static PLANNERS: LazyLock<Vec<Planner>> = LazyLock::new(|| FAMILIES.concat());
    &PLANNERS
}

/// The planner of that name; `None` if there is none.
pub fn find(name: &str) -> Option<&'static Planner> {
    registry().iter().find(|planner| planner.name == name)
}
