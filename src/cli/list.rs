use clap::Args;
use comfy_table::Table;
use scenarios::Scenario;
use serde_json::{Value, json};

use super::selection::Selection;
use crate::console;
use crate::error::{Error, Exit};
use crate::output::report::table;

/// List the scenarios, the planners, and what each planner handles
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  harness list\n  harness list --tag wind\n  harness list --json | jq '.scenarios[].name'"
)]
pub struct List {
    #[command(flatten)]
    selection: Selection,
    /// Print one JSON object instead of tables
    #[arg(long)]
    json: bool,
}

impl List {
    /// Prints both tables, and the errors of invalid files.
    pub fn execute(&self) -> Result<Exit, Error> {
        let (mut good, mut bad) = (Vec::new(), Vec::new());
        for file in self.selection.files()? {
            match scenarios::load(&file) {
                Ok(scenario) if self.selection.is_wanted(&scenario) => {
                    good.push((file.display().to_string(), scenario));
                }
                Ok(_) => {}
                Err(error) => bad.push(error),
            }
        }
        if good.is_empty() && bad.is_empty() {
            return Err(self.selection.nothing());
        }
        if self.json {
            console::print(&format!("{:#}", as_json(&good)))?;
        } else {
            let (scenarios, planners) = (scenario_table(&good), planner_table());
            console::print(&format!("Scenarios\n{}\n\nPlanners\n{}", scenarios.trim_fmt(), planners.trim_fmt()))?;
        }
        let exit = if bad.is_empty() { Exit::Passed } else { Exit::BadInput };
        bad.into_iter().for_each(|error| console::print_error(error.into()));
        Ok(exit)
    }
}

fn scenario_table(scenarios: &[(String, Scenario)]) -> Table {
    let mut table = table::with_header(&["name", "vehicles", "planner", "tags", "description"], &[1]);
    for (_, scenario) in scenarios {
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

/// The content of both tables, the files, and the planners that handle each scenario.
fn as_json(scenarios: &[(String, Scenario)]) -> Value {
    let handled_by = |scenario: &Scenario| -> Vec<&str> {
        let fitting = planners::registry().iter().filter(|planner| (planner.unsupported_reason)(scenario).is_none());
        fitting.map(|planner| planner.name).collect()
    };
    let scenario = |(file, scenario): &(String, Scenario)| {
        json!({
            "name": scenario.name,
            "file": file,
            "description": scenario.description,
            "tags": scenario.tags,
            "vehicles": scenario.vehicles.len(),
            "planner": scenario.planner.name,
            "command": scenario.planner.command,
            "handled_by": handled_by(scenario),
        })
    };
    let planner = |planner: &planners::Planner| json!({ "name": planner.name, "handles": planner.handles, "summary": planner.summary });
    json!({
        "scenarios": scenarios.iter().map(scenario).collect::<Vec<_>>(),
        "planners": planners::registry().iter().map(planner).collect::<Vec<_>>(),
    })
}
