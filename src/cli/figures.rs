use std::path::PathBuf;

use clap::Args;

use crate::campaign::figures::{self, Options};
use crate::console;
use crate::error::{Error, Exit};
use crate::output;
use crate::output::page;

/// Draw the figures of the papers
///
/// Plans and flies the papers' cases and draws trajectories, series, convergence, costs over fleet sizes and operation
/// counts, with the papers' own numbers where they print them. Takes some minutes.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct FiguresCommand {
    /// Folder of the scenarios [default: those of the papers]
    #[arg(value_name = "SCENARIOS")]
    scenarios: Option<PathBuf>,
    /// Only the figures of one paper
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(1..=4))]
    paper: Option<u8>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Small fleets and few sizes: a smoke test
    #[arg(long)]
    quick: bool,
    /// Write the report page DIR/index.html with the figures; `harness report` does so afterwards
    #[arg(long)]
    html: bool,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness figures              out/figures/*.svg and out/papers.md
  harness figures --paper 4
  harness figures -o docs      those of the documentation";

impl FiguresCommand {
    /// Draws and writes.
    pub fn execute(&self) -> Result<Exit, Error> {
        let Self { scenarios, paper, out, quick, html, quiet } = self;
        let options = Options { scenarios: scenarios.clone(), paper: *paper, is_quick: *quick };
        let drawn = figures::run(&options, &mut |name| {
            if !quiet {
                console::eprint(name);
            }
        })?;
        let folder = out.join("figures");
        output::create_folder(&folder)?;
        for figure in &drawn {
            let path = folder.join(format!("{}.svg", figure.name));
            output::write_file(&path, |writer| write!(writer, "{}", figure.svg))?;
        }
        output::write_file(&out.join("papers.md"), |writer| write!(writer, "{}", figures::page(&drawn)))?;
        if *html {
            page::write(out)?;
        }
        if !quiet {
            console::print(&format!("{} figures in {}", drawn.len(), folder.display()))?;
        }
        Ok(Exit::Passed)
    }
}
