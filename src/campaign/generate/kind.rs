//! The kinds of problems.

use scenarios::{Family, closest_name};

use super::file::Draft;
use super::{GenerateError, Request, fixed_wing, multirotor, slung_load};

/// A kind of problem.
#[derive(Debug)]
pub struct Kind {
    /// Its name, unique over all families.
    pub name: &'static str,
    /// The family of its vehicles.
    pub family: Family,
    /// What makes it difficult.
    pub summary: &'static str,
    /// Its sizes.
    pub size: Size,
    /// Its densities.
    pub density: Density,
    /// An option that makes another problem of it.
    pub variant: Option<Variant>,
    /// RandomStream a scenario of a request whose size and density are in range; `None` if none was found.
    pub(super) draw: fn(&Request) -> Option<Draft>,
}

/// The sizes of a kind.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    /// What it counts or measures.
    pub meaning: &'static str,
    /// The smallest.
    pub min: usize,
    /// The largest.
    pub max: usize,
    /// That of a request that does not say.
    pub default: usize,
    /// Small, medium and large, for `harness bench suite`.
    pub suite: [usize; 3],
}

/// The densities of a kind: fractions.
#[derive(Clone, Copy, Debug)]
pub struct Density {
    /// A fraction of what.
    pub meaning: &'static str,
    /// The largest.
    pub max: f64,
    /// That of a request that does not say.
    pub default: f64,
}

/// An option that makes another problem of a kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variant {
    /// Aircraft need not arrive at the same time.
    FreeArrival,
    /// Obstacles are unknown until they are sensed.
    Hidden,
}

impl Variant {
    /// Its option on the command line, without the dashes.
    pub fn name(self) -> &'static str {
        match self {
            Self::FreeArrival => "free-arrival",
            Self::Hidden => "hidden",
        }
    }
}

/// The kinds, by family.
const KINDS: [&[Kind]; 3] = [fixed_wing::KINDS, slung_load::KINDS, multirotor::KINDS];

/// All kinds.
pub fn kinds() -> impl Iterator<Item = &'static Kind> {
    KINDS.into_iter().flatten()
}

/// The kinds of a family.
pub fn of_family(family: Family) -> impl Iterator<Item = &'static Kind> {
    kinds().filter(move |kind| kind.family == family)
}

/// The kind of this name.
///
/// # Errors
///
/// [`GenerateError::UnknownKind`] with the names of all kinds.
pub fn find(name: &str) -> Result<&'static Kind, GenerateError> {
    find_among(name, "a kind", kinds())
}

/// The kind of this name among some that are `what`.
///
/// # Errors
///
/// [`GenerateError::UnknownKind`] with their names.
pub fn find_among(
    name: &str,
    what: &str,
    kinds: impl Iterator<Item = &'static Kind>,
) -> Result<&'static Kind, GenerateError> {
    let kinds: Vec<&'static Kind> = kinds.collect();
    let known = || kinds.iter().map(|kind| kind.name);
    kinds.iter().copied().find(|kind| kind.name == name).ok_or_else(|| GenerateError::UnknownKind {
        name: name.to_owned(),
        expected: format!("{what}: {}", known().collect::<Vec<_>>().join(", ")),
        remedy: match closest_name(name, known()) {
            Some(known) => format!("did you mean `{known}`?"),
            None => "`harness generate --help` describes the kinds".to_owned(),
        },
    })
}
