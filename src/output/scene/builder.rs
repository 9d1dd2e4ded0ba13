//! Builds the scene of a run.

use super::{Scene, closest, end_s, events, focus, ghosts, labels, map, obstacles, paths, wind};
use crate::families;
use crate::output::run::JudgedRun;

/// The scene of a run: what all families share, and what the family of its vehicles adds.
pub fn build<'a>(run: &JudgedRun<'a>) -> Scene<'a> {
    let family = &families::of(run.scenario.family()).scene;
    let mut scene = Scene { end_s: run.flight.map_or(0.0, end_s), ..Scene::default() };
    map::add(&mut scene, run.scenario);
    obstacles::add(&mut scene, run);
    paths::add_planned(&mut scene, run);
    scene.legend = (family.legend)(run);
    if let Some(flight) = run.flight {
        paths::add_flown(&mut scene, flight);
        closest::add(&mut scene, run, flight);
        (family.add)(&mut scene, run, flight);
    }
    scene.action = focus::action(&scene);
    labels::separate(&mut scene);
    let decisive = focus::decisive(run);
    scene.focus_s = focus::instant_s(decisive, scene.end_s);
    scene.decisive_check = decisive.map(|check| check.name.clone());
    if let Some(flight) = run.flight {
        wind::add(&mut scene, flight);
    }
    if let Some(ghost) = run.ghost {
        ghosts::add(&mut scene, ghost);
    }
    scene.events = events::all(run, family.end_of_plan);
    scene
}
