use std::path::{Path, PathBuf};

use clap::{Args, builder::StyledStr};
use scenarios::Family;

use crate::campaign::generate::{self, GenerateError, Generated, Kind, Request, Variant};
use crate::console;
use crate::error::{Error, Exit};
use crate::output;

/// Write random scenarios that are known to be feasible
///
/// The same kind, size, density and seed give the same file. Each file is a complete scenario with comments, to be read and
/// edited; its head says how it was made and why it can be solved.
#[derive(Args, Debug)]
#[command(after_help = help())]
pub struct Generate {
    /// A family of vehicles (fixed-wing, slung-load, multirotor) or a kind of problem
    #[arg(value_name = "FAMILY|KIND")]
    what: String,
    /// Kind of problem; repeatable [default: every kind of the family]
    #[arg(long, value_name = "KIND")]
    kind: Vec<String>,
    /// Size: aircraft, metres, walls ..., by kind (below)
    #[arg(long, value_name = "N")]
    size: Option<usize>,
    /// Density of obstacles: a fraction (below)
    #[arg(long, value_name = "D")]
    density: Option<f64>,
    /// Seed of all random numbers
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Number of scenarios of each kind, with successive seeds
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u64).range(1..))]
    count: u64,
    /// Fixed wings: arrivals need not be simultaneous
    #[arg(long, conflicts_with = "hidden")]
    free_arrival: bool,
    /// Multirotors: obstacles are unknown until they are sensed
    #[arg(long)]
    hidden: bool,
    /// A folder, or for one scenario a file that ends in .toml (its scenario is then named after it); `-`: standard output
    #[arg(short, long, value_name = "PATH", default_value = "generated")]
    output: PathBuf,
    /// Do not list the files
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness generate fixed-wing --kind ring --size 8 --seed 3
  harness generate ring --size 8 --seed 3           the same: the names of kinds are unique
  harness generate forest --size 40 --density 0.2 --hidden --count 20 -o forests
  harness generate headings --size 4 --free-arrival -o mine.toml && harness run mine.toml
  harness generate multirotor --count 5             five scenarios of every kind of the family";

fn help() -> StyledStr {
    let mut text = String::from("Kinds:\n");
    for family in Family::ALL {
        let kinds: Vec<&Kind> = generate::of_family(family).collect();
        if kinds.is_empty() {
            continue;
        }
        text.push_str(&format!("  {}\n", family.key()));
        kinds.iter().for_each(|kind| text.push_str(&description(kind)));
    }
    (text + "\n" + EXAMPLES).into()
}

fn description(kind: &Kind) -> String {
    let Kind { name, summary, size, density, .. } = kind;
    let size = format!("size: {}, {} to {} [{}]", size.meaning, size.min, size.max, size.default);
    let density = match density.max > 0.0 {
        true => format!("density: {}, up to {} [{}]", density.meaning, density.max, density.default),
        false => format!("density: {}", density.meaning),
    };
    let variant = kind.variant.map_or_else(String::new, |variant| format!("\n               --{}", variant.name()));
    format!("    {name:<10} {summary}\n               {size}\n               {density}{variant}\n")
}

impl Generate {
    /// Writes the files and lists them.
    pub fn execute(&self) -> Result<Exit, Error> {
        let requests = self.requests()?;
        if let [request] = requests.as_slice()
            && self.is_file()
        {
            return self.write_one(request);
        }
        if self.is_file() {
            return Err(Error::OneScenario { path: self.output.clone(), count: requests.len() });
        }
        output::create_folder(&self.output)?;
        for request in requests {
            let Generated { name, text } = request.generate()?;
            self.write(&self.output.join(format!("{name}.toml")), &text)?;
        }
        Ok(Exit::Passed)
    }

    fn is_file(&self) -> bool {
        self.output == Path::new("-") || self.output.extension().is_some_and(|extension| extension == "toml")
    }

    fn write_one(&self, request: &Request) -> Result<Exit, Error> {
        let generated = request.generate()?;
        if self.output == Path::new("-") {
            return console::print(generated.text.trim_end()).map(|()| Exit::Passed);
        }
        let stem = self.output.file_stem().unwrap_or_default().to_string_lossy();
        let renamed = generated.renamed(&stem);
        scenarios::parse(&self.output.display().to_string(), &renamed.text)?;
        self.write(&self.output, &renamed.text)?;
        Ok(Exit::Passed)
    }

    fn write(&self, path: &Path, text: &str) -> Result<(), Error> {
        output::write_file(path, |writer| writer.write_all(text.as_bytes()))?;
        if self.quiet { Ok(()) } else { console::print(&path.display().to_string()) }
    }

    fn requests(&self) -> Result<Vec<Request>, Error> {
        let kinds = self.kinds()?;
        let seeds = || (0..self.count).map(|index| self.seed.wrapping_add(index));
        let requests = kinds.into_iter().flat_map(|kind| seeds().map(move |seed| self.request(kind, seed)));
        requests.map(|request| request.map_err(Error::from)).collect()
    }

    fn request(&self, kind: &'static Kind, seed: u64) -> Result<Request, GenerateError> {
        let request = Request::new(kind, seed);
        let asked = match (self.free_arrival, self.hidden) {
            (true, _) => Some(Variant::FreeArrival),
            (_, true) => Some(Variant::Hidden),
            _ => None,
        };
        if asked.is_some() && asked != kind.variant {
            return Err(GenerateError::NoVariant { kind });
        }
        let request = Request {
            size: self.size.unwrap_or(request.size),
            density: self.density.unwrap_or(request.density),
            is_variant: asked.is_some(),
            ..request
        };
        request.check().map(|()| request)
    }

    /// The kinds that the command line names: of a family, or one by its name.
    fn kinds(&self) -> Result<Vec<&'static Kind>, Error> {
        let Some(family) = Family::ALL.into_iter().find(|family| family.key() == self.what) else {
            return self.kind_by_name().map(|kind| vec![kind]);
        };
        if self.kind.is_empty() {
            return Ok(generate::of_family(family).collect());
        }
        let what = format!("a kind of the family {}", family.key());
        let find = |name: &String| generate::find_among(name, &what, generate::of_family(family)).map_err(Error::from);
        self.kind.iter().map(find).collect()
    }

    fn kind_by_name(&self) -> Result<&'static Kind, Error> {
        let families: Vec<&str> = Family::ALL.map(Family::key).to_vec();
        let what = format!("a family ({}) or a kind", families.join(", "));
        let kind = generate::find_among(&self.what, &what, generate::kinds())?;
        match self.kind.first() {
            Some(other) => Err(Error::KindTwice { first: kind.name, second: other.clone() }),
            None => Ok(kind),
        }
    }
}
