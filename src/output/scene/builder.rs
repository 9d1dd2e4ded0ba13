//! Builds the scene of a run.

use super::{Scene, closest, end_s, events, map, obstacles, paths};
use crate::families;
use crate::output::run::JudgedRun;

/// The scene of a run: what all families share, and what the family of its vehicles adds.
pub fn build<'a>(run: &JudgedRun<'a>) -> Scene<'a> {
    let family = &families::of(run.scenario.family()).scene;
    let mut scene = Scene { end_s: run.flight.map_or(0.0, end_s), ..Scene::default() };
    map::add(&mut scene, run.scenario);
    obstacles::add(&mut scene, run);
    paths::add_planned(&mut scene, run);
    if let Some(flight) = run.flight {
        paths::add_flown(&mut scene, flight);
        closest::add(&mut scene, run, flight);
        (family.add)(&mut scene, run, flight);
    }
    scene.events = events::all(run, family.end_of_plan);
    scene.legend = (family.legend)(run);
    scene
}
