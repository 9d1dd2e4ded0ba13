use crate::planner::Planner;
use crate::{horizon, scp, search, slung};

/// Every planner.
pub fn registry() -> &'static [Planner] {
    &[
        scp::fleet::PLANNER,
        scp::coupled::PLANNER,
        scp::serial::PLANNER,
        scp::parallel::PLANNER,
        scp::dynamic_priority::PLANNER,
        slung::PLANNER,
        horizon::RHC,
        horizon::RHC_PSO,
        horizon::RHC_FPSO,
        horizon::RHC_APF,
        search::SPARSE_ASTAR,
        search::RRT,
        search::RRT_STAR,
    ]
}

/// The planner of that name.
pub fn find(name: &str) -> Option<&'static Planner> {
    registry().iter().find(|planner| planner.name == name)
}
