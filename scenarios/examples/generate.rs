//! Writes the scenario files of the large fleets: `cargo run --release -p scenarios --example generate -- scenarios/fixed-wing`
//!
//! Random numbers come from streams with fixed seeds, so that the files are reproducible.

#[path = "generate/circle.rs"]
mod circle;
#[path = "generate/field.rs"]
mod field;
#[path = "generate/formation.rs"]
mod formation;
#[path = "generate/mission.rs"]
mod mission;
#[path = "generate/traffic.rs"]
mod traffic;

use std::path::PathBuf;

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).map_or_else(|| PathBuf::from("scenarios/fixed-wing"), PathBuf::from);
    let mut missions = vec![formation::rendezvous(), circle::crossing(30), field::field(20), traffic::traffic(1000)];
    missions.extend([10, 25, 50, 100].map(circle::exchange));
    for mission in missions {
        std::fs::write(folder.join(format!("{}.toml", mission.name)), mission.to_toml())?;
    }
    Ok(())
}
