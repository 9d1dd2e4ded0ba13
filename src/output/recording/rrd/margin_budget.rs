//! Where the margins went, as a picture: one bar per step, from what was left before it to what is left after it.
//!
//! Entities `/margins/QUESTION`. To the right is more margin; left of the line at 0 the limit is broken.

use rerun::{Boxes2D, EntityPath, LineStrips2D, Points2D, RecordingStream};

use super::shapes::color;
use super::{Logged, entity, to_f32};
use crate::campaign::margin_budget::MarginBudget;
use crate::number_format::{quantity, signed};
use crate::output::scene::{Paint, colours};

/// Height of a bar; rows are 1 apart.
const BAR: f64 = 0.7;
/// Width of the longest bar.
const WIDTH: f64 = 8.0;
/// A step that cost nothing is a line of this width.
const HAIRLINE: f64 = 0.03;
/// Room for the names at the left.
const NAMES: f64 = 2.2;

/// Draws one budget below the other.
pub fn log(stream: &RecordingStream, waterfalls: &[MarginBudget]) -> Logged {
    let mut top = 0.0;
    for waterfall in waterfalls {
        let picture = Picture::of(waterfall, top);
        top += picture.bars.len() as f64 + 2.0;
        picture.log(stream, &waterfall.question)?;
    }
    Ok(())
}

/// One bar: what it says, where it goes from and to in units of the picture, and its colour.
struct Bar {
    label: String,
    from: f64,
    to: f64,
    colour: [u8; 3],
}

struct Picture {
    title: String,
    top: f64,
    bars: Vec<Bar>,
}

impl Picture {
    fn of(waterfall: &MarginBudget, top: f64) -> Self {
        let MarginBudget { question, unit, steps } = waterfall;
        let largest = steps.iter().map(|step| step.margin.abs()).fold(0.0, f64::max);
        let scale = if largest > 0.0 && largest.is_finite() { WIDTH / largest } else { 0.0 };
        let mut before = 0.0;
        let mut bars: Vec<Bar> = steps
            .iter()
            .enumerate()
            .map(|(index, step)| {
                let (from, to) = (before * scale, step.margin * scale);
                before = step.margin;
                let (label, colour) = match index {
                    0 => (format!("{}: {}", step.name, quantity(step.margin, unit)), colours::FLEET),
                    _ if step.change < 0.0 => (format!("{} {}", step.name, signed(step.change, unit)), colours::LIMIT),
                    _ => (format!("{} {}", step.name, signed(step.change, unit)), colours::KEPT),
                };
                Bar { label, from, to, colour }
            })
            .collect();
        let left = format!("left: {}", quantity(before, unit));
        bars.push(Bar { label: left, from: 0.0, to: before * scale, colour: colours::FLEET });
        Self { title: format!("margin of {question} [{unit}]"), top, bars }
    }

    fn log(&self, stream: &RecordingStream, question: &str) -> Logged {
        let row = |index: usize| self.top + index as f64 + 1.0;
        let bars = self.bars.iter().enumerate();
        let centers = bars.clone().map(|(index, bar)| to_f32([f64::midpoint(bar.from, bar.to), row(index)]));
        let halves = bars.clone().map(|(_, bar)| to_f32([((bar.to - bar.from).abs() / 2.0).max(HAIRLINE), BAR / 2.0]));
        let colours = bars.clone().map(|(_, bar)| color(Paint::opaque(bar.colour)));
        let shapes = Boxes2D::from_centers_and_half_sizes(centers, halves).with_colors(colours).with_radii([0.04]);
        stream.log_static(part(question, "bars"), &shapes)?;
        let places =
            [to_f32([0.0, self.top])].into_iter().chain((0..self.bars.len()).map(|i| to_f32([-NAMES, row(i) - 0.25])));
        let words = [self.title.clone()].into_iter().chain(self.bars.iter().map(|bar| bar.label.clone()));
        let names = Points2D::new(places)
            .with_labels(words)
            .with_show_labels(true)
            .with_radii([0.01])
            .with_colors([color(Paint::opaque(colours::MAP))]);
        stream.log_static(part(question, "names"), &names)?;
        let limit = [to_f32([0.0, self.top + 0.4]), to_f32([0.0, row(self.bars.len()) - 0.4])];
        let line = LineStrips2D::new([limit]).with_colors([color(Paint::opaque(colours::MAP))]);
        stream.log_static(part(question, "limit"), &line)?;
        Ok(())
    }
}

fn part(question: &str, name: &str) -> EntityPath {
    entity(&format!("margins/{question}"), name)
}

#[cfg(test)]
mod tests {
    use super::{Picture, WIDTH};
    use crate::campaign::margin_budget::{MarginBudget, MarginStep};

    fn budget(margins: &[f64]) -> MarginBudget {
        let mut before = margins[0];
        let step = |margin: &f64| {
            let change = margin - before;
            before = *margin;
            MarginStep { name: "step".to_owned(), margin: *margin, change }
        };
        let steps = margins.iter().map(step).collect();
        MarginBudget { question: "clearance".to_owned(), unit: "m".to_owned(), steps }
    }

    #[test]
    fn every_bar_begins_where_the_last_one_ended_and_the_last_is_what_is_left() {
        let picture = Picture::of(&budget(&[4.0, 3.0, 3.5, -1.0]), 0.0);
        let ends: Vec<[f64; 2]> = picture.bars.iter().map(|bar| [bar.from, bar.to]).collect();
        assert_eq!(ends, [[0.0, WIDTH], [WIDTH, 6.0], [6.0, 7.0], [7.0, -2.0], [0.0, -2.0]]);
        assert!(picture.bars[4].label.contains("-1.000 m"), "{}", picture.bars[4].label);
    }

    #[test]
    fn margins_that_are_none_are_drawn_as_nothing() {
        for margins in [[0.0, 0.0], [f64::NAN, 1.0], [f64::INFINITY, 1.0]] {
            assert_eq!(Picture::of(&budget(&margins), 0.0).bars.len(), 3);
        }
    }
}
