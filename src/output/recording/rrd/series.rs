//! Quantities over time with their limits, and states.

use rayon::prelude::*;
use rerun::components::InterpolationMode;
use rerun::{Color, EntityPath, RecordingStream, Scalars, SeriesLines, StateChange};

use super::shapes::color;
use super::{Logged, SIM_TIME, entity, sim_times};
use crate::output::scene::{Curve, Paint, Scene, Series, SeriesKind, StateSeries};

/// Logs all of them.
pub fn log(stream: &RecordingStream, scene: &Scene<'_>) -> Logged {
    let plotted = scene.channels.iter().flat_map(|channels| {
        let of_channel = |channel| (channels.samples, channel);
        channels.channels.iter().map(of_channel)
    });
    let plotted: Vec<_> =
        plotted.filter_map(|(samples, channel)| Some((samples, channel, channel.plot.as_ref()?))).collect();
    let curves: Vec<Curve> = plotted.par_iter().map(|(samples, channel, plot)| channel.curve(samples, plot)).collect();
    for ((_, _, plot), curve) in plotted.into_iter().zip(curves) {
        let path = entity(&format!("plots/{}", plot.group), &plot.name);
        let style = style(&plot.name, color(Paint::opaque(plot.colour)), plot.width);
        log_curve(stream, path, &style, curve)?;
    }
    scene.series.iter().try_for_each(|series| log_series(stream, series))?;
    scene.states.iter().try_for_each(|states| log_states(stream, states))
}

fn log_series(stream: &RecordingStream, series: &Series) -> Logged {
    let root = match series.kind {
        SeriesKind::Quantity => "plots",
        SeriesKind::Limit => "limits",
    };
    // A legend of limits without their values: the axis shows them.
    let title = if series.kind == SeriesKind::Limit { &series.name } else { &series.title };
    let style = style(title, color(Paint::opaque(series.colour)), series.width);
    let style = if series.is_stepped { style.with_interpolation_mode(InterpolationMode::StepAfter) } else { style };
    log_curve(stream, entity(&format!("{root}/{}", series.group), &series.name), &style, series.curve.clone())
}

fn log_states(stream: &RecordingStream, states: &StateSeries) -> Logged {
    for (t_s, state) in &states.changes {
        stream.set_duration_secs(SIM_TIME, *t_s);
        stream.log(entity(&format!("state/{}", states.group), states.name), &StateChange::single(*state))?;
    }
    stream.reset_time();
    Ok(())
}

fn style(name: &str, color: Color, width: f32) -> SeriesLines {
    SeriesLines::new().with_names([name]).with_colors([color]).with_widths([width])
}

fn log_curve(stream: &RecordingStream, path: EntityPath, style: &SeriesLines, curve: Curve) -> Logged {
    stream.log_static(path.clone(), style)?;
    let values = Scalars::new(curve.values).columns_of_unit_batches()?;
    Ok(stream.send_columns(path, [sim_times(curve.times_s)], values)?)
}
