//! Planning in the loop: when each planner is called, what it observes, and when its result takes effect.

mod acceptance;
mod planning_loop;
mod planning_time;
mod reference_manager;
mod sensed_world;

pub(super) use planning_loop::PlanningLoop;
