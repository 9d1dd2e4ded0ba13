use crate::planner::Planner;
use crate::scp;

/// Every planner.
pub fn registry() -> &'static [Planner] {
    &[scp::parallel::PLANNER]
}

/// The planner of that name.
pub fn find(name: &str) -> Option<&'static Planner> {
    registry().iter().find(|planner| planner.name == name)
}
