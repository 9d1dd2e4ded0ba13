//! Changes the judge's source in many small ways, one at a time, and runs the tests: a change that no test notices is a
//! verdict that nothing holds in place. docs/mutation.md says how to read the result.

mod mutate;
mod tests_of;
mod tree;

use std::path::PathBuf;
use std::time::Duration;
use std::{fs, io};

use clap::Parser;
use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use serde::Serialize;

use mutate::Mutant;
use tests_of::{Outcome, Test};
use tree::Tree;

/// Mutation test of the judge.
#[derive(Parser)]
struct Arguments {
    /// Files and folders to mutate, from the root of the repository
    #[arg(default_values_t = ["src/verdict".to_owned(), "src/plan_source/plan_import".to_owned()])]
    places: Vec<String>,
    /// Number of mutants, drawn at random; all if it is left out
    #[arg(long)]
    sample: Option<usize>,
    /// Seed of the draw
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Integration tests to run, beside the tests of the library and `harness selftest`
    #[arg(long, value_delimiter = ',', default_value = "judge,multirotor,slung,guard")]
    tests: Vec<String>,
    /// Tests of the library to run: those whose names begin like this
    #[arg(long, value_delimiter = ',', default_value = "verdict::,plan_source::,metrics::")]
    library: Vec<String>,
    /// Tests that take longer than this, s, are left out
    #[arg(long, default_value_t = 60)]
    longest: u64,
    /// Folder for the copy of the repository and the results
    #[arg(long, default_value = "target/mutation")]
    out: PathBuf,
    /// Further arguments for cargo
    #[arg(last = true)]
    cargo: Vec<String>,
}

/// What became of a mutant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Fate {
    /// A test failed.
    Caught,
    /// A test did not end.
    TimedOut,
    /// Every test that comes past it passed.
    Survived,
    /// No test comes past it.
    NotReached,
}

#[derive(Serialize)]
struct Row<'a> {
    id: usize,
    file: &'a str,
    line: usize,
    mutant: &'a str,
    is_boundary: bool,
    fate: Fate,
    by: Option<&'a str>,
}

fn main() -> io::Result<()> {
    let arguments = Arguments::parse();
    let repository = std::env::current_dir()?;
    let out = repository.join(&arguments.out);
    let mut tree = Tree::new(&repository, &out.join("tree"), &arguments.places)?;
    tree.settle(&arguments.cargo)?;
    println!("{} mutants, {} more do not compile", tree.mutants().count(), tree.refused());
    let executables = tree.build(&arguments.tests, &arguments.cargo)?;
    let tests = measured(&arguments, &tree, Test::all(&executables, &tree.root, &arguments.library)?, &out)?;
    let rows = judge(&arguments, &tree, &tests)?;
    fs::write(out.join("mutants.json"), serde_json::to_string_pretty(&rows)?)?;
    summarise(&rows);
    Ok(())
}

/// The tests that pass without a mutant in time, the fastest first.
fn measured(arguments: &Arguments, tree: &Tree, tests: Vec<Test>, out: &std::path::Path) -> io::Result<Vec<Test>> {
    let longest = Duration::from_secs(arguments.longest);
    let mut kept = Vec::new();
    for mut test in tests {
        if test.measure(out, longest)? {
            kept.push(test);
        } else {
            println!("left out: {} fails or takes longer than {} s", test.name, arguments.longest);
        }
    }
    kept.sort_by_key(|test| test.duration);
    let total: Duration = kept.iter().map(|test| test.duration).sum();
    let reached = tree.mutants().filter(|(id, ..)| kept.iter().any(|test| test.reaches(*id))).count();
    println!("{} tests of {:.0} s in all reach {reached} mutants", kept.len(), total.as_secs_f64());
    Ok(kept)
}

fn judge<'a>(arguments: &Arguments, tree: &'a Tree, tests: &'a [Test]) -> io::Result<Vec<Row<'a>>> {
    let mut mutants: Vec<(usize, &str, &Mutant)> = tree.mutants().collect();
    if let Some(sample) = arguments.sample {
        mutants.shuffle(&mut ChaCha8Rng::seed_from_u64(arguments.seed));
        mutants.truncate(sample);
        mutants.sort_by_key(|(id, ..)| *id);
    }
    let count = mutants.len();
    let row = |(index, (id, file, mutant)): (usize, (usize, &'a str, &'a Mutant))| {
        let (fate, by) = fate(id, tests)?;
        if matches!(fate, Fate::Survived | Fate::NotReached) {
            println!("{}/{count} {fate:?} {file}:{}: {}", index + 1, mutant.line, mutant.description);
        }
        let is_boundary = mutant.is_boundary();
        Ok(Row { id, file, line: mutant.line, mutant: &mutant.description, is_boundary, fate, by })
    };
    mutants.into_iter().enumerate().map(row).collect()
}

fn fate(mutant: usize, tests: &[Test]) -> io::Result<(Fate, Option<&str>)> {
    let mut is_reached = false;
    for test in tests.iter().filter(|test| test.reaches(mutant)) {
        is_reached = true;
        match test.with(mutant)? {
            Outcome::Passed => {}
            Outcome::Failed => return Ok((Fate::Caught, Some(&test.name))),
            Outcome::TimedOut => return Ok((Fate::TimedOut, Some(&test.name))),
        }
    }
    Ok((if is_reached { Fate::Survived } else { Fate::NotReached }, None))
}

fn summarise(rows: &[Row]) {
    for (name, is_boundary) in
        [("mutants", false), ("boundary mutants (they differ where two numbers are equal)", true)]
    {
        let count = |fates: &[Fate]| {
            rows.iter().filter(|row| row.is_boundary == is_boundary && fates.contains(&row.fate)).count()
        };
        let caught = count(&[Fate::Caught, Fate::TimedOut]);
        let all = caught + count(&[Fate::Survived, Fate::NotReached]);
        let percent = 100.0 * caught as f64 / all.max(1) as f64;
        let (survived, not_reached) = (count(&[Fate::Survived]), count(&[Fate::NotReached]));
        println!("{name}: {caught} of {all} caught ({percent:.1} %), {survived} survived, {not_reached} not reached");
    }
}
