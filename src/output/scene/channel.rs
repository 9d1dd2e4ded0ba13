//! Quantities of a vehicle at every step of its log.

use sim::Sample;

use super::curve::Curve;

/// All channels of a vehicle.
pub struct Channels<'a> {
    /// Name of the vehicle.
    pub vehicle: &'a str,
    /// What a set of values is called: `Aircraft`.
    pub message: &'static str,
    /// The log; step `i` of every channel is at the time of sample `i`.
    pub samples: &'a [Sample],
    /// The channels.
    pub channels: Vec<Channel<'a>>,
}

/// A quantity at every step of a log.
pub struct Channel<'a> {
    /// Its name with its unit: `airspeed_mps`.
    pub field: &'static str,
    /// Its value at a step.
    pub value: Value<'a>,
    /// Where it is plotted, if it is.
    pub plot: Option<Plot>,
}

/// The value of a channel at a step of the log.
pub enum Value<'a> {
    /// A number, possibly NaN.
    Number(Box<dyn Fn(usize) -> f64 + Send + Sync + 'a>),
    /// Yes or no.
    Flag(Box<dyn Fn(usize) -> bool + Send + Sync + 'a>),
}

/// The plot of a channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// The plot, which it shares with others: `airspeed`.
    pub group: &'static str,
    /// Its name in the plot.
    pub name: String,
    /// Its colour.
    pub colour: [u8; 3],
    /// Width of its line, points on the screen.
    pub width: f32,
    /// Largest number of points.
    pub max_points: usize,
    /// Time up to which it is shown, s.
    pub until_s: f64,
}

impl<'a> Channel<'a> {
    /// A number that is not plotted.
    pub fn number(field: &'static str, value: impl Fn(usize) -> f64 + Send + Sync + 'a) -> Self {
        Self { field, value: Value::Number(Box::new(value)), plot: None }
    }

    /// Yes or no.
    pub fn flag(field: &'static str, value: impl Fn(usize) -> bool + Send + Sync + 'a) -> Self {
        Self { field, value: Value::Flag(Box::new(value)), plot: None }
    }

    /// The same, plotted.
    pub fn plotted(self, plot: Plot) -> Self {
        Self { plot: Some(plot), ..self }
    }

    /// Its curve for a plot, with as many points as the plot takes.
    pub fn curve(&self, samples: &[Sample], plot: &Plot) -> Curve {
        let shown =
            samples.iter().enumerate().filter(|(_, sample)| sample.t_s <= plot.until_s || plot.until_s.is_infinite());
        let points = shown.map(|(step, sample)| (sample.t_s, self.value.at(step)));
        points.collect::<Curve>().decimated(plot.max_points)
    }
}

impl Value<'_> {
    /// At a step, as a number: 1 for yes, 0 for no.
    pub fn at(&self, step: usize) -> f64 {
        match self {
            Self::Number(value) => value(step),
            Self::Flag(value) => f64::from(u8::from(value(step))),
        }
    }
}
