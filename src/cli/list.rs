use std::path::PathBuf;

use clap::Args;
use comfy_table::Table;
use scenarios::Scenario;

use crate::error::{Error, Exit};
use crate::output;
use crate::report::table;

/// Show the scenarios and the planners, and what each planner claims to handle.
#[derive(Args, Debug)]
#[command(after_help = "Examples:\n  harness list\n  harness list scenarios/fixed-wing")]
pub struct List {
    /// Scenario files, or folders that are searched for *.toml to the bottom
    #[arg(value_name = "PATH", default_value = "scenarios")]
    paths: Vec<PathBuf>,
}

impl List {
    /// Prints both tables; files that are no scenarios are named.
    pub fn execute(&self) -> Result<Exit, Error> {
        let (good, bad): (Vec<_>, Vec<_>) =
            scenarios::find(&self.paths)?.iter().map(|file| scenarios::load(file)).partition(Result::is_ok);
        let good: Vec<Scenario> = good.into_iter().flatten().collect();
        output::print(&format!(
            "Scenarios\n{}\n\nPlanners\n{}",
            scenario_table(&good).trim_fmt(),
            planner_table().trim_fmt()
        ))?;
        let exit = if bad.is_empty() { Exit::Passed } else { Exit::BadInput };
        bad.into_iter().filter_map(Result::err).for_each(|error| Error::from(error).print());
        Ok(exit)
    }
}

fn scenario_table(scenarios: &[Scenario]) -> Table {
    let mut table = table::with_header(&["name", "vehicles", "planner", "tags", "description"], &[1]);
    for scenario in scenarios {
        table.add_row([
            scenario.name.clone(),
            scenario.vehicles.len().to_string(),
            scenario.planner.name.clone(),
            scenario.tags.join(" "),
            scenario.description.clone(),
        ]);
    }
    table
}

fn planner_table() -> Table {
    let mut table = table::with_header(&["name", "handles", "summary"], &[]);
    for planner in planners::registry() {
        table.add_row([planner.name, planner.handles, planner.summary]);
    }
    table
}
