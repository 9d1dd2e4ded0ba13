//! One run of adaptive multilevel splitting, the last-particle algorithm.
//!
//! n particles are drawn from the distribution of the inputs. The one with the largest score is removed, again and again, and
//! replaced by a copy of another one, which a few Metropolis steps move about below the score that was removed. A removal with
//! r particles left to choose from is a death of a population at risk of size r, so that the probability of what lies below
//! all removed scores is estimated as the survival function of such a population is:
//!
//! ```text
//! Λ = Σ 1/r    estimates -ln p without bias, with variance Σ 1/r²              (Nelson, Aalen)
//! ```
//!
//! With perfect moves and a continuous score, the number of removals is a Poisson variable with mean -n ln p.
//!
//! Au, Beck, "Estimation of small failure probabilities in high dimensions by subset simulation" (2001); Guyader, Hengartner,
//! Matzner-Løber, "Simulation and estimation of extreme quantiles and extreme probabilities" (2011); Cérou, Guyader,
//! "Fluctuation analysis of adaptive multilevel splitting" (2016).

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, StandardNormal};

/// Acceptance rate that the step length is adapted to.
const WANTED_ACCEPTANCE: f64 = 0.4;
/// Bounds of the step length, as a fraction of a fresh draw.
const STEP_RANGE: [f64; 2] = [0.02, 0.99];
/// Step length of the first move.
const FIRST_STEP: f64 = 0.8;
/// Draws without a flight per particle, at most, before a search gives up: the distribution hardly meets valid scenarios.
pub const REJECTED_PER_PARTICLE: usize = 50;
/// Largest seed of a flight: it fits into a scenario file as an integer.
const MAX_SEED: u64 = u32::MAX as u64;

/// A place in the space of the inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// One standard normal number per input.
    pub normals: Vec<f64>,
    /// Seed of the flight; `None` for that of the scenario.
    pub seed: Option<u64>,
}

/// The score of a place: what fails has a score <= 0, and the smaller the score the nearer the failure. `None` if there is no
/// valid scenario at that place.
pub type Score<'a> = dyn Fn(&Point) -> Option<f64> + Sync + 'a;

/// How a run is carried out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunSettings {
    /// Number of inputs.
    pub dimension: usize,
    /// Whether the seeds of the flights vary.
    pub varies_seed: bool,
    /// Number of particles n, at least 2.
    pub particles: usize,
    /// Metropolis steps of every copy.
    pub moves: usize,
    /// Largest number of flights.
    pub max_flights: usize,
    /// Λ at which a run ends: what is rarer does not matter.
    pub max_hazard: f64,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunEnd {
    /// All particles fail.
    Failed,
    /// The probability is below the one that matters.
    Rarer,
    /// The flights are used up.
    OutOfFlights,
    /// All particles have the same score, so that none is nearer to a failure than another.
    Stuck,
    /// Nearly every draw was an invalid scenario.
    Invalid,
}

/// The result of one run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Λ, an estimate of -ln p; of a run that ended before all particles failed, of what it had reached: p is smaller.
    pub hazard: f64,
    /// Number of removed particles.
    pub removed: usize,
    /// Number of flights.
    pub flights: usize,
    /// Its end.
    pub end: RunEnd,
    /// The failure that is likeliest: nearest to the median of every input.
    pub likeliest: Option<Point>,
}

impl Run {
    /// Whether it met failures, so that Λ estimates -ln p.
    pub fn is_complete(&self) -> bool {
        self.end == RunEnd::Failed
    }
}

/// Runs once.
///
/// - `flown`: is called after every flight with Λ
pub fn run(settings: &RunSettings, mut random: ChaCha8Rng, score: &Score<'_>, flown: &dyn Fn(f64)) -> Run {
    let mut population = Population { settings, score, flown, step: FIRST_STEP, run: empty(), particles: Vec::new() };
    if population.fill(&mut random) {
        while population.advance(&mut random) {}
    }
    population.run
}

/// One draw of the inputs.
///
/// - `dimension`: number of inputs
/// - `varies_seed`: whether a seed is drawn, too
pub fn draw(dimension: usize, varies_seed: bool, random: &mut ChaCha8Rng) -> Point {
    let normals = (0..dimension).map(|_| StandardNormal.sample(random)).collect();
    Point { normals, seed: varies_seed.then(|| random.random_range(0..=MAX_SEED)) }
}

fn empty() -> Run {
    Run { hazard: 0.0, removed: 0, flights: 0, end: RunEnd::Invalid, likeliest: None }
}

struct Population<'a> {
    settings: &'a RunSettings,
    score: &'a Score<'a>,
    flown: &'a dyn Fn(f64),
    /// Step length of the moves of the inputs: 1 is a fresh draw.
    step: f64,
    run: Run,
    particles: Vec<(f64, Point)>,
}

impl Population<'_> {
    /// Draws the particles. Returns whether all could be flown.
    fn fill(&mut self, random: &mut ChaCha8Rng) -> bool {
        let mut attempts = REJECTED_PER_PARTICLE * self.settings.particles;
        while self.particles.len() < self.settings.particles {
            if attempts == 0 || self.is_out_of_flights() {
                self.run.end = if attempts == 0 { RunEnd::Invalid } else { RunEnd::OutOfFlights };
                return false;
            }
            attempts -= 1;
            let point = draw(self.settings.dimension, self.settings.varies_seed, random);
            if let Some(score) = self.fly(&point) {
                self.particles.push((score, point));
            }
        }
        true
    }

    /// Removes the particles with the largest score, and replaces them. Returns whether the run goes on.
    fn advance(&mut self, random: &mut ChaCha8Rng) -> bool {
        let level = self.particles.iter().map(|(score, _)| *score).fold(f64::NEG_INFINITY, f64::max);
        let end = if level <= 0.0 {
            Some(RunEnd::Failed)
        } else if self.run.hazard >= self.settings.max_hazard {
            Some(RunEnd::Rarer)
        } else if self.is_out_of_flights() {
            Some(RunEnd::OutOfFlights)
        } else if self.particles.iter().all(|(score, _)| *score >= level) {
            Some(RunEnd::Stuck)
        } else {
            None
        };
        if let Some(end) = end {
            self.run.end = end;
            return false;
        }
        self.particles.retain(|(score, _)| *score < level);
        let survivors = self.particles.len();
        // Particles of equal score go at once, one after the other from a population that shrinks.
        for at_risk in survivors + 1..=self.settings.particles {
            self.run.hazard += 1.0 / at_risk as f64;
            self.run.removed += 1;
        }
        while self.particles.len() < self.settings.particles {
            let copy = self.particles[random.random_range(0..survivors)].clone();
            let moved = self.moved(copy, level, random);
            self.particles.push(moved);
        }
        true
    }

    /// A copy after its Metropolis steps, which keep the distribution of the inputs below `level`.
    fn moved(&mut self, mut particle: (f64, Point), level: f64, random: &mut ChaCha8Rng) -> (f64, Point) {
        let (mut accepted, mut tried) = (0.0, 0.0);
        for _ in 0..self.settings.moves {
            let (point, moves_inputs_only) = self.proposal(&particle.1, random);
            let score = self.fly(&point);
            let is_accepted = score.is_some_and(|score| score < level);
            if moves_inputs_only {
                tried += 1.0;
                accepted += f64::from(is_accepted);
            }
            if let Some(score) = score.filter(|_| is_accepted) {
                particle = (score, point);
            }
        }
        if tried > 0.0 {
            let gain = (3.0 / self.settings.particles as f64).min(1.0);
            let factor = (gain * (accepted / tried - WANTED_ACCEPTANCE)).exp();
            self.step = (self.step * factor).clamp(STEP_RANGE[0], STEP_RANGE[1]);
        }
        particle
    }

    /// A place near another one, reversible with respect to the distribution of the inputs: the inputs move, the seed is
    /// drawn anew, or both.
    ///
    /// Returns whether the inputs move alone.
    fn proposal(&self, from: &Point, random: &mut ChaCha8Rng) -> (Point, bool) {
        let kind = if self.settings.varies_seed { random.random_range(0..3) } else { 0 };
        let (draws_seed, moves_inputs) = (kind > 0, kind < 2);
        let fresh = draw(self.settings.dimension, self.settings.varies_seed, random);
        let keep = (1.0 - self.step * self.step).sqrt();
        let pairs = from.normals.iter().zip(&fresh.normals);
        let normals = pairs.map(|(old, new)| if moves_inputs { keep * old + self.step * new } else { *old }).collect();
        (Point { normals, seed: if draws_seed { fresh.seed } else { from.seed } }, !draws_seed)
    }

    fn is_out_of_flights(&self) -> bool {
        self.run.flights >= self.settings.max_flights
    }

    /// The score of a place, which costs a flight if there is one.
    fn fly(&mut self, point: &Point) -> Option<f64> {
        let score = (self.score)(point)?;
        self.run.flights += 1;
        (self.flown)(self.run.hazard);
        let length = |point: &Point| point.normals.iter().map(|normal| normal * normal).sum::<f64>();
        let is_likelier = |known: &Point| length(point) < length(known);
        if score <= 0.0 && self.run.likeliest.as_ref().is_none_or(is_likelier) {
            self.run.likeliest = Some(point.clone());
        }
        Some(score)
    }
}
