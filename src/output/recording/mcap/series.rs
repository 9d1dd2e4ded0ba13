//! Quantities over time, and states.

use std::sync::Arc;

use foxglove::{Channel, Context, Encode, FoxgloveError, PartialMetadata};

use super::protobuf::{self, FieldType};
use super::{INTERVAL_S, channel, timestamp};
use crate::output::scene::{Channels, Curve, Scene, Series, SeriesKind, Value};

/// A value of a series.
#[derive(Encode)]
struct Point {
    value: f64,
}

/// A state from this time on.
#[derive(Encode)]
struct State {
    state: String,
}

/// The fleet at one time, as far as the scenario limits it.
#[derive(Encode)]
struct Distances {
    separation_m: Option<f64>,
    separation_limit_m: Option<f64>,
    clearance_m: Option<f64>,
}

/// Logs all of them.
pub fn log(context: &Arc<Context>, scene: &Scene<'_>) -> Result<(), FoxgloveError> {
    scene.channels.iter().try_for_each(|channels| log_vehicle(context, channels))?;
    for series in &scene.series {
        log_series(context, series);
    }
    for states in &scene.states {
        let topic: Channel<State> = channel(context, &format!("/state/{}/{}", states.group, states.name));
        for (t_s, state) in &states.changes {
            topic.log_with_time(&State { state: (*state).to_owned() }, timestamp(*t_s));
        }
    }
    log_distances(context, scene);
    Ok(())
}

/// One message with all channels of a vehicle every [`INTERVAL_S`].
fn log_vehicle(context: &Arc<Context>, channels: &Channels<'_>) -> Result<(), FoxgloveError> {
    let kind = |value: &Value<'_>| match value {
        Value::Number(_) => FieldType::Double,
        Value::Flag(_) => FieldType::Bool,
    };
    let fields: Vec<(&str, FieldType)> =
        channels.channels.iter().map(|channel| (channel.field, kind(&channel.value))).collect();
    let topic = context
        .channel_builder(format!("/vehicles/{}", channels.vehicle))
        .message_encoding("protobuf")
        .schema(protobuf::schema(channels.message, &fields))
        .build_raw()?;
    let mut last_s = f64::NEG_INFINITY;
    for (step, sample) in channels.samples.iter().enumerate().filter(|(_, sample)| sample.t_s.is_finite()) {
        if sample.t_s - last_s < 0.99 * INTERVAL_S {
            continue;
        }
        last_s = sample.t_s;
        let values = channels.channels.iter().map(|channel| (kind(&channel.value), channel.value.at(step)));
        let message = protobuf::message(values);
        topic.log_with_meta(&message, PartialMetadata::with_log_time(timestamp(sample.t_s).total_nanos()));
    }
    Ok(())
}

fn log_series(context: &Arc<Context>, series: &Series) {
    let root = match series.kind {
        SeriesKind::Quantity => "plots",
        SeriesKind::Limit => "limits",
    };
    let topic: Channel<Point> = channel(context, &format!("/{root}/{}/{}", series.group, series.name));
    for (t_s, value) in series.curve.times_s.iter().zip(&series.curve.values) {
        topic.log_with_time(&Point { value: *value }, timestamp(*t_s));
    }
}

/// Separation and clearance of the fleet together, at every time of either; between its own times a value is held.
fn log_distances(context: &Arc<Context>, scene: &Scene<'_>) {
    let fleet = |group: &str| scene.series.iter().find(|series| series.group == group && series.name == "fleet");
    let [separation, clearance] = ["separation_m", "clearance_m"].map(|group| fleet(group).map(|series| &series.curve));
    let is_limit = |series: &&Series| series.kind == SeriesKind::Limit && series.group == "separation_m";
    let separation_limit_m = scene.series.iter().find(is_limit).and_then(|series| series.curve.values.first().copied());
    let mut times_s: Vec<f64> =
        [separation, clearance].into_iter().flatten().flat_map(|curve| curve.times_s.iter().copied()).collect();
    if times_s.is_empty() {
        return;
    }
    times_s.sort_by(f64::total_cmp);
    times_s.dedup();
    let topic: Channel<Distances> = channel(context, "/distances");
    let at = |curve: Option<&Curve>, t_s: f64| curve.and_then(|curve| curve.held_at(t_s));
    for t_s in times_s {
        let message =
            Distances { separation_m: at(separation, t_s), separation_limit_m, clearance_m: at(clearance, t_s) };
        topic.log_with_time(&message, timestamp(t_s));
    }
}
