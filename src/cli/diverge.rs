use std::path::{Path, PathBuf};

use clap::Args;

use crate::campaign::first_difference::{Difference, FirstDifference, first_difference};
use crate::console;
use crate::error::{Error, Exit};
use crate::number_format;
use crate::output::recording::parquet;
use crate::report::{Report, StateHashes};

/// Find the first difference between two flights of one scenario
///
/// The same scenario, planner and seed give bit-identical flights. If two flights differ, this command names the first
/// time, vehicle and quantity that differ. It compares the logs that `harness run --record parquet` writes; without them,
/// the running hashes in report.json, which locate the difference to 10 s. The exit code is 1 if the flights differ.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Diverge {
    /// A flight.parquet, or a folder with the results of one scenario and planner
    #[arg(value_name = "A")]
    one: PathBuf,
    /// The flight to compare with it
    #[arg(value_name = "B")]
    other: PathBuf,
}

const EXAMPLES: &str = "\
Examples:
  harness run --name rendezvous-7 --record parquet -j 1 -o out/one
  harness run --name rendezvous-7 --record parquet -j 2 -o out/two
  harness diverge out/one/rendezvous-7/fleet-scp out/two/rendezvous-7/fleet-scp";

const LOG: &str = "flight.parquet";

impl Diverge {
    /// Compares and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        let paths = [&self.one, &self.other];
        if let Some(missing) = paths.iter().find(|path| !path.exists()) {
            return Err(Error::results(missing, "no such file or folder".to_owned()));
        }
        let logs = paths.map(|path| if path.is_dir() { path.join(LOG) } else { path.clone() });
        if logs.iter().any(|log| !log.exists()) && paths.iter().all(|path| path.is_dir()) {
            return self.by_hashes();
        }
        let [one, other] = [parquet::read(&logs[0])?, parquet::read(&logs[1])?];
        if one.scenario != other.scenario {
            let reason = format!("the flight of `{}`, where the other is of `{}`", other.scenario, one.scenario);
            return Err(Error::results(&logs[1], reason));
        }
        match first_difference(&one, &other) {
            None => same(),
            Some(first) => console::print(&in_words(&first)).map(|()| Exit::Failed),
        }
    }

    fn by_hashes(&self) -> Result<Exit, Error> {
        let [one, other] = [hashes(&self.one)?, hashes(&self.other)?];
        let differs = one.running.iter().zip(&other.running).position(|(a, b)| a != b);
        let parted =
            differs.or_else(|| (one.running != other.running).then(|| one.running.len().min(other.running.len())));
        let Some(index) = parted else { return same() };
        let from_s = index as f64 * one.every_s;
        let text = format!(
            "the flights part between {} and {}, by their running hashes; `--record parquet` tells when and where exactly",
            number_format::given_quantity(from_s, "s"),
            number_format::given_quantity(from_s + one.every_s, "s")
        );
        console::print(&text).map(|()| Exit::Failed)
    }
}

fn hashes(folder: &Path) -> Result<StateHashes, Error> {
    let path = folder.join("report.json");
    let text = std::fs::read_to_string(&path).map_err(|reason| Error::results(&path, reason.to_string()))?;
    let report: Report = serde_json::from_str(&text).map_err(|reason| Error::results(&path, reason.to_string()))?;
    report.state_hash.ok_or_else(|| Error::results(&path, "there was no flight, and so there are no hashes".to_owned()))
}

fn same() -> Result<Exit, Error> {
    console::print("the flights are the same to the last bit").map(|()| Exit::Passed)
}

fn in_words(FirstDifference { t_s, vehicle, difference, largest_m }: &FirstDifference) -> String {
    let apart = format!("later they are up to {} apart", number_format::quantity(*largest_m, "m"));
    match difference {
        Difference::Number { field, values: [one, other], ulps } => {
            let by = format!("{field} is {one:?} and {other:?}, {ulps} units in the last place apart");
            format!("the flights part at {t_s} s: {vehicle}, {by}; {apart}")
        }
        Difference::End => format!("the flights part at {t_s} s: one log of {vehicle} ends; {apart}"),
        Difference::Vehicles => "the flights are of different vehicles".to_owned(),
    }
}
