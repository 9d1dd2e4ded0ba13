//! Random scenarios: a kind of problem, a size, a density and a seed give a scenario file with a certificate that the
//! problem can be solved.
//!
//! The certificate is constructed, not found by a planner of the project: a fleet of fixed wings is built around flyable
//! paths, and a multirotor's map is accepted only if a search on a grid finds a path across it.

mod error;
mod file;
mod fixed_wing;
mod grid_search;
mod kind;
mod multirotor;
mod random_stream;
mod slung_load;

use scenarios::Scenario;

pub use error::GenerateError;
pub use kind::{Density, Kind, Size, Variant, find, find_among, kinds, of_family};

/// What to generate.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    /// The kind of problem.
    pub kind: &'static Kind,
    /// Its size; [`Kind::size`] says what it counts.
    pub size: usize,
    /// Its density; [`Kind::density`] says of what.
    pub density: f64,
    /// Whether it is the kind's variant ([`Kind::variant`]).
    pub is_variant: bool,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// A scenario file.
#[derive(Clone, Debug, PartialEq)]
pub struct Generated {
    /// Name of the scenario, and of its file without `.toml`.
    pub name: String,
    /// Content of the file.
    pub text: String,
}

impl Generated {
    /// The same scenario under another name.
    pub fn renamed(&self, name: &str) -> Self {
        let [own, other] = [self.name.as_str(), name].map(|name| format!("\nname = \"{name}\"\n"));
        Self { name: name.to_owned(), text: self.text.replacen(&own, &other, 1) }
    }

    /// The scenario in the file.
    ///
    /// # Panics
    ///
    /// Panics if the file is not a valid scenario, which is a bug of its kind.
    pub fn scenario(&self) -> Scenario {
        scenarios::parse(&format!("{}.toml", self.name), &self.text)
            .unwrap_or_else(|error| panic!("{} is not a valid scenario: {error:?}", self.name))
    }
}

impl Request {
    /// A request with the kind's default size and density, and not its variant.
    pub fn new(kind: &'static Kind, seed: u64) -> Self {
        Self { kind, size: kind.size.default, density: kind.density.default, is_variant: false, seed }
    }

    /// Generates the scenario. The same request gives the same file.
    ///
    /// # Errors
    ///
    /// [`GenerateError`] if size, density or variant are not possible for the kind, or if no scenario of that density was
    /// found.
    ///
    /// # Examples
    ///
    /// ```
    /// use harness::campaign::generate::{self, Request};
    ///
    /// let ring = generate::find("ring").unwrap();
    /// let generated = Request { size: 3, density: 0.0, ..Request::new(ring, 7) }.generate().unwrap();
    /// assert_eq!(generated.name, "ring-3-s7");
    /// assert_eq!(generated.scenario().vehicles.len(), 3);
    /// ```
    pub fn generate(&self) -> Result<Generated, GenerateError> {
        self.check()?;
        let draft = (self.kind.draw)(self).ok_or(GenerateError::NoRoom {
            kind: self.kind.name,
            size: self.size,
            density: self.density,
            seed: self.seed,
        })?;
        let generated = Generated { name: self.name(), text: file::text(self, &draft) };
        generated.scenario();
        Ok(generated)
    }

    /// Name of the scenario: `forest-40-d15-hidden-s3`.
    pub fn name(&self) -> String {
        let percent = format!("{}", (self.density * 1e6).round() / 1e4).replace('.', "-");
        let density = if self.density > 0.0 { format!("-d{percent}") } else { String::new() };
        let variant = self.variant().map_or_else(String::new, |variant| format!("-{}", variant.name()));
        format!("{}-{}{density}{variant}-s{}", self.kind.name, self.size, self.seed)
    }

    /// The command that generates it.
    pub fn command(&self) -> String {
        let variant = self.variant().map_or_else(String::new, |variant| format!(" --{}", variant.name()));
        let Self { kind, size, density, seed, .. } = self;
        format!("harness generate {} --size {size} --density {density}{variant} --seed {seed}", kind.name)
    }

    /// The kind's variant, if it is asked for.
    pub fn variant(&self) -> Option<Variant> {
        self.kind.variant.filter(|_| self.is_variant)
    }

    /// A stream of random numbers for one use. Kinds differ in all their streams.
    fn rng(&self, purpose: &str) -> random_stream::RandomStream {
        random_stream::RandomStream::new(self.seed, &format!("generate/{}/{purpose}", self.kind.name))
    }

    /// Whether size, density and variant are possible for the kind.
    ///
    /// # Errors
    ///
    /// [`GenerateError`] that names the range.
    pub fn check(&self) -> Result<(), GenerateError> {
        let Self { kind, size, density, .. } = *self;
        if !(kind.size.min..=kind.size.max).contains(&size) {
            return Err(GenerateError::Size { kind, found: size });
        }
        if !(0.0..=kind.density.max).contains(&density) {
            return Err(GenerateError::Density { kind, found: density });
        }
        if self.is_variant && kind.variant.is_none() {
            return Err(GenerateError::NoVariant { kind });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
