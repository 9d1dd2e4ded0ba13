//! Recordings are complete, small, keep extremes, and are written for failed runs too.

mod synthetic;

use std::collections::BTreeSet;
use std::fs;
use std::process::Command;

use rerun::external::re_chunk_store::external::re_chunk::Chunk;
use rerun::{ChunkStore, ChunkStoreConfig, StoreKind};
use scenarios::PlanStatus;

use super::*;
use crate::output::recording::record;
use crate::verdict::{Outcome, Verdict};
use synthetic::{Synthetic, factors};

/// Records into a fresh folder, in which nothing else may be left; the folder, and the size of the file in bytes.
fn recorded(run: &Run<'_>) -> (tempfile::TempDir, u64) {
    let folder = tempfile::tempdir().unwrap();
    let path = record(&Rrd, run, folder.path()).unwrap();
    assert_eq!(path, folder.path().join("flight.rrd"));
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "other files were left");
    let size = fs::metadata(path).unwrap().len();
    (folder, size)
}

/// Reads the recording in `folder` back.
fn read(folder: &Path) -> ChunkStore {
    let mut file = std::io::BufReader::new(fs::File::open(folder.join("flight.rrd")).unwrap());
    let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::default(), &mut file).unwrap();
    let mut recordings = stores.into_iter().filter(|(id, _)| id.kind() == StoreKind::Recording);
    let (_, store) = recordings.next().expect("a recording");
    assert!(recordings.next().is_none(), "one recording only");
    store
}

fn entities(store: &ChunkStore) -> BTreeSet<String> {
    store.all_entities().iter().map(ToString::to_string).collect()
}

/// Times in s and first scalar of every row of an entity.
fn scalars(store: &ChunkStore, entity: &str) -> Vec<(f64, f64)> {
    let chunks = store.iter_physical_chunks().filter(|chunk| *chunk.entity_path() == EntityPath::from(entity));
    let rows = |chunk: &Chunk| -> Vec<(f64, f64)> {
        let component = rerun::Scalars::descriptor_scalars().component;
        let times = chunk.iter_indices(&SIM_TIME.into()).map(|(time, _)| time.as_i64() as f64 * 1e-9);
        let values = chunk.iter_slices::<f64>(component).map(|row| row[0]);
        times.zip(values).collect()
    };
    chunks.filter(|chunk| !chunk.is_static()).flat_map(|chunk| rows(chunk)).collect()
}

#[test]
fn the_recording_holds_every_part_of_the_scene() {
    let made_up = Synthetic::new(3, 60.0);
    let (folder, _) = recorded(&made_up.run());
    let entities = entities(&read(folder.path()));
    for vehicle in ["uav-1", "uav-2", "uav-3"] {
        for group in ["world/planned", "world/flown", "world/trail", "world/vehicles"] {
            assert!(entities.iter().any(|path| path.starts_with(&format!("/{group}/{vehicle}"))), "{group}/{vehicle}");
        }
        for group in ["tracking_m", "n_x", "n_y", "n_z", "airspeed_mps", "altitude_m"] {
            assert!(entities.contains(&format!("/plots/{group}/{vehicle}")), "{group} of {vehicle}");
            assert!(entities.iter().any(|path| path.starts_with(&format!("/limits/{group}"))));
        }
    }
    for entity in
        ["/world/map/grid", "/world/obstacles", "/plots/separation_m/fleet", "/events", "/verdict", "/convergence"]
    {
        assert!(entities.contains(entity), "{entity} is missing in {entities:#?}");
    }
}

/// The plot's lowest point is the verdict's value, although it lies between two steps and the series is decimated.
#[test]
fn the_worst_instant_survives_decimation() {
    let mut made_up = Synthetic::new(3, 60.0);
    let check = made_up.verdict.checks.iter_mut().find(|check| check.name == "flight.separation").unwrap();
    (check.at_s, check.value) = (Some(31.4159), Some(2.5));
    let spiked = &mut made_up.flight.vehicles[1].samples[1234];
    factors(spiked).control.n_z = 7.5;
    let (folder, _) = recorded(&made_up.run());
    let store = read(folder.path());
    let lowest = scalars(&store, "/plots/separation_m/fleet").into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    assert!((lowest.0 - 31.4159).abs() < 1e-9 && lowest.1 == 2.5, "{lowest:?}");
    let highest = scalars(&store, "/plots/n_z/uav-2").into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap();
    assert!((highest.0 - 12.34).abs() < 1e-9 && highest.1 == 7.5, "{highest:?}");
}

/// The crashed aircraft's log ends early; the crash has its place in space and its line in the log.
#[test]
fn a_crash_is_marked_where_it_happened() {
    let mut made_up = Synthetic::new(3, 60.0);
    made_up.flight.vehicles[1].samples.truncate(2500);
    let kind = sim::EventKind::Crash { obstacle: Some("threat-2".to_owned()) };
    made_up.flight.events.push(sim::Event { t_s: 24.99, kind, vehicles: vec!["uav-2".to_owned()] });
    let (folder, _) = recorded(&made_up.run());
    let store = read(folder.path());
    let component = rerun::Points3D::descriptor_positions().component;
    let chunk =
        store.iter_physical_chunks().find(|chunk| *chunk.entity_path() == EntityPath::from("/world/crashed/uav-2"));
    let marked = chunk.expect("a mark").iter_slices::<[f32; 3]>(component).next().expect("a position")[0];
    assert_eq!(marked, to_f32(made_up.flight.vehicles[1].samples[2499].position_m));
    let flown = scalars(&store, "/plots/altitude_m/uav-2");
    assert!((flown.last().unwrap().0 - 24.99).abs() < 1e-9, "{:?}", flown.last());
}

#[test]
fn files_stay_small() {
    let (_seven, bytes) = recorded(&Synthetic::new(7, 230.0).run());
    assert!(bytes < 5_000_000, "7 aircraft for 230 s: {bytes} bytes");
    let (_hundred, bytes) = recorded(&Synthetic::new(100, 150.0).run());
    assert!(bytes < 20_000_000, "100 aircraft for 150 s: {bytes} bytes");
}

#[test]
fn a_run_without_a_plan_is_recorded_with_its_world_and_its_verdict() {
    let mut made_up = Synthetic::new(3, 20.0);
    made_up.plan.trajectories.clear();
    made_up.plan.history.clear();
    made_up.plan.status = PlanStatus::NoPlan;
    made_up.plan.objective = None;
    let verdict = Verdict { outcome: Outcome::NoPlan, checks: Vec::new(), overclaimed: false, integration: None };
    let run = Run { flight: None, verdict: &verdict, ..made_up.run() };
    let (folder, _) = recorded(&run);
    let entities = entities(&read(folder.path()));
    assert!(entities.contains("/world/obstacles") && entities.contains("/verdict"), "{entities:#?}");
    assert!(!entities.iter().any(|path| path.starts_with("/world/vehicles")), "{entities:#?}");
}

#[test]
fn logs_with_nan_and_infinity_are_recorded() {
    let mut made_up = Synthetic::new(4, 20.0);
    for (vehicle, bad) in [(0, f64::NAN), (1, f64::INFINITY)] {
        for sample in &mut made_up.flight.vehicles[vehicle].samples[500..] {
            (sample.position_m, sample.world_from_body, sample.wind_mps) = ([bad; 3], [bad; 4], [bad; 3]);
            (sample.t_s, factors(sample).control.n_y) = (bad, bad);
        }
        made_up.trajectory(vehicle).states[20].x_m = bad;
        made_up.plan.history[vehicle].defect_m = bad;
    }
    made_up.flight.vehicles[2].samples.clear();
    made_up.trajectory(3).states.clear();
    made_up.flight.events[0].t_s = f64::NAN;
    for check in &mut made_up.verdict.checks {
        (check.value, check.margin, check.at_s) = (Some(f64::NAN), Some(f64::NAN), Some(f64::NAN));
    }
    let (folder, _) = recorded(&made_up.run());
    let store = read(folder.path());
    let kept = scalars(&store, "/plots/n_y/uav-1");
    assert_eq!(kept.len(), 500, "the samples before the first bad one");
    assert!(kept.iter().all(|(t_s, value)| t_s.is_finite() && value.is_finite()));
}

#[test]
fn equal_runs_have_equal_ids_and_different_results_different_ones() {
    let (one, mut other) = (Synthetic::new(2, 20.0), Synthetic::new(2, 20.0));
    assert_eq!(recording_id(&one.run()), recording_id(&other.run()));
    other.flight.vehicles[1].samples[100].position_m[2] += 1e-9;
    assert_ne!(recording_id(&one.run()), recording_id(&other.run()));
}

#[test]
#[ignore = "needs the rerun viewer on the PATH: pip install rerun-sdk==0.36.3"]
fn the_viewer_verifies_the_recording() {
    let (folder, _) = recorded(&Synthetic::new(7, 60.0).run());
    let verified =
        Command::new("rerun").args(["rrd", "verify"]).arg(folder.path().join("flight.rrd")).output().unwrap();
    assert!(verified.status.success(), "{}", String::from_utf8_lossy(&verified.stderr));
}
