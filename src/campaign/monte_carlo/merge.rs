//! Merges the partitions of a sweep.

use std::path::{Path, PathBuf};

use super::{Sample, Sweep, table};
use crate::error::Error;

/// Merges the tables in `paths`, which must hold every sample of one sweep exactly once. Returns the samples in the order of
/// their numbers.
///
/// # Errors
///
/// [`Error::Samples`] if a file is not a table of samples, belongs to another sweep, or samples are missing or duplicate.
pub fn merge(paths: &[PathBuf]) -> Result<(Sweep, Vec<Sample>), Error> {
    let mut merged: Option<(Sweep, Vec<(Sample, &Path)>)> = None;
    for path in paths {
        let (sweep, samples) = table::read(path)?;
        let error = |reason: String| Error::Samples { path: path.clone(), reason };
        let (first, all) = merged.get_or_insert_with(|| (sweep.clone(), Vec::new()));
        if let Some(property) = difference(first, &sweep) {
            return Err(error(format!("{property} differs from {}", paths[0].display())));
        }
        if let Some(sample) = samples.iter().find(|sample| sample.margins.len() != sweep.checks.len()) {
            return Err(error(format!("sample {} has more or fewer margins than there are checks", sample.number)));
        }
        all.extend(samples.into_iter().map(|sample| (sample, path.as_path())));
    }
    let (sweep, mut all) =
        merged.ok_or_else(|| Error::Samples { path: PathBuf::new(), reason: "no table to merge".to_owned() })?;
    all.sort_by_key(|(sample, _)| sample.number);
    if let Some(twice) = all.windows(2).find(|pair| pair[0].0.number == pair[1].0.number) {
        let reason = format!("sample {} is also in {}", twice[0].0.number, twice[0].1.display());
        return Err(Error::Samples { path: twice[1].1.to_path_buf(), reason });
    }
    let samples: Vec<Sample> = all.into_iter().map(|(sample, _)| sample).collect();
    complete(&sweep, &samples).map_err(|reason| Error::Samples { path: paths[0].clone(), reason })?;
    Ok((sweep, samples))
}

/// The first property in which two sweeps differ.
pub(super) fn difference(one: &Sweep, other: &Sweep) -> Option<&'static str> {
    [
        ("format version", one.schema != other.schema),
        ("harness version", one.version != other.version),
        ("scenario", one.scenario != other.scenario),
        ("planner", one.planner != other.planner),
        ("seed", one.seed != other.seed),
        ("scenario or plan", one.fingerprint != other.fingerprint),
        ("number of samples", one.samples != other.samples),
        ("dispersions", one.dispersions != other.dispersions),
        ("list of checks", one.checks != other.checks),
    ]
    .into_iter()
    .find_map(|(property, differs)| differs.then_some(property))
}

fn complete(sweep: &Sweep, samples: &[Sample]) -> Result<(), String> {
    if let Some(invalid) = samples.iter().find(|sample| sample.number >= sweep.samples) {
        return Err(format!("sample {} is out of range: the sweep has {} samples", invalid.number, sweep.samples));
    }
    let missing = sweep.samples - samples.len();
    let first = (0..).zip(samples).find(|(number, sample)| *number != sample.number);
    let number = first.map_or(samples.len(), |(number, _)| number);
    if missing == 0 {
        Ok(())
    } else {
        Err(format!("{missing} of {} samples are missing; the first is sample {number}", sweep.samples))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::campaign::monte_carlo::{Dispersions, Perturbation};
    use crate::verdict::Outcome;

    fn sweep() -> Sweep {
        Sweep {
            schema: 1,
            version: "0".to_owned(),
            scenario: "pair".to_owned(),
            planner: "by-hand".to_owned(),
            seed: 3,
            samples: 5,
            fingerprint: "ab".to_owned(),
            dispersions: Dispersions { wind_mps: 1.0, mass: 0.0, noise_m: 0.0, start_m: 0.0 },
            checks: vec![
                ("flight.separation".to_owned(), "m".to_owned()),
                ("flight.rest".to_owned(), "m/s".to_owned()),
                ("flight.state_limits".to_owned(), "-".to_owned()),
            ],
        }
    }

    fn sample(number: usize) -> Sample {
        Sample {
            number,
            perturbation: Perturbation {
                seed: u64::MAX - number as u64,
                wind_mps: [0.1, -0.2],
                mass_ratios: [1.0, 1.0],
                noise_m: 0.0,
                start_m: 0.0,
            },
            verdict: if number == 2 { Outcome::Fail } else { Outcome::Pass },
            failed_checks: if number == 2 {
                vec!["flight.rest".into(), "flight.separation".into()]
            } else {
                Vec::new()
            },
            // Sample 4 has no margin of one check.
            margins: vec![number as f64, if number == 4 { f64::NAN } else { -0.5 }, 0.25],
            units: ["m", "m/s", if number == 2 { "deg" } else { "m/s" }].map(str::to_owned).to_vec(),
        }
    }

    /// Writes one table per list of numbers, and merges them.
    fn merged(tables: &[(&Sweep, &[usize])]) -> Result<(Sweep, Vec<Sample>), String> {
        let folder = tempfile::tempdir().unwrap();
        let paths: Vec<PathBuf> =
            (0..tables.len()).map(|index| folder.path().join(format!("{index}.parquet"))).collect();
        for ((sweep, numbers), path) in tables.iter().zip(&paths) {
            let samples: Vec<Sample> = numbers.iter().map(|number| sample(*number)).collect();
            table::write(sweep, &samples, path).unwrap();
        }
        merge(&paths).map_err(|error| error.to_string())
    }

    #[test]
    fn merged_partitions_are_the_whole_sweep() {
        let whole = merged(&[(&sweep(), &[1, 3]), (&sweep(), &[0, 2, 4])]).unwrap();
        // NaN, the margin that sample 4 does not have, equals nothing.
        assert_eq!(format!("{whole:?}"), format!("{:?}", (sweep(), (0..5).map(sample).collect::<Vec<_>>())));
    }

    #[test]
    fn missing_duplicate_and_foreign_samples_are_errors() {
        let assert_error = |tables: &[(&Sweep, &[usize])], text: &str| {
            let error = merged(tables).unwrap_err();
            assert!(error.contains(text), "{error}");
        };
        assert_error(&[(&sweep(), &[0, 1, 3, 4])], "1 of 5 samples are missing; the first is sample 2");
        assert_error(&[(&sweep(), &[])], "5 of 5 samples are missing; the first is sample 0");
        assert_error(&[(&sweep(), &[0, 1, 2]), (&sweep(), &[2, 3, 4])], "sample 2 is also in");
        assert_error(&[(&sweep(), &[0, 1, 2, 3, 4, 5])], "sample 5 is out of range: the sweep has 5 samples");
        let other = Sweep { seed: 4, ..sweep() };
        assert_error(&[(&sweep(), &[0, 1, 2]), (&other, &[3, 4])], "seed differs from");
        let edited = Sweep { fingerprint: "cd".to_owned(), ..sweep() };
        assert_error(&[(&sweep(), &[0, 1, 2]), (&edited, &[3, 4])], "scenario or plan differs from");
    }

    #[test]
    fn other_files_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("no.parquet");
        std::fs::write(&path, "no table").unwrap();
        assert!(merge(&[path]).is_err());
    }
}
