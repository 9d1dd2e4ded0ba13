//! Figures of a quadrotor with a slung load.

use scenarios::slung_load::Cable;
use scenarios::{Plan, Scenario};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::slung_load::{Parts, SlungLoadState};
use sim::{EventKind, Flight};

use super::{Metrics, finite};
use crate::verdict::slung_load::{FlownMotion, PlannedMotion};
use crate::verdict::{FlownMotions as Tracked, largest_tracking_error, root_mean_square_tracking_error, saturation};

/// Figures of a quadrotor with a slung load. A figure that is absent could not be measured.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SlungLoadMetrics {
    /// Duration of the plan, s.
    pub flight_time_s: Option<f64>,
    /// When the planned envelope circle changes between the body's radius and the load's horizontal distance, s (Kang, Huang,
    /// Wen 2020, eq. 14).
    pub envelope_switches_s: Vec<f64>,
    /// The same with the load's distance bounded by R-functions, s (eq. 19): what the planner `slung-lgr` keeps clear.
    #[serde(default)]
    pub r_function_switches_s: Vec<f64>,
    /// Lowest and highest planned thrust of a rotor, N.
    pub planned_thrust_n: Option<[f64; 2]>,
    /// Lowest and highest planned tension while the cable is taut, impacts aside, N.
    pub planned_tension_n: Option<[f64; 2]>,
    /// Largest angle of the planned cable from straight down, deg.
    pub planned_swing_deg: Option<f64>,
    /// Impulses of the plan's impacts.
    pub planned_impacts: Vec<CableSwitch>,
    /// Switches of the flown cable.
    pub flown_switches: Vec<CableSwitch>,
    /// Largest angle of the flown cable from straight down, deg.
    pub flown_swing_deg: Option<f64>,
    /// Largest distance of the quadrotor from the plan, m.
    pub tracking_max_m: Option<f64>,
    /// Root mean square over time of that distance, m.
    pub tracking_rms_m: Option<f64>,
    /// Largest distance of the load from the plan, m.
    pub load_tracking_max_m: Option<f64>,
    /// Share of the steps in which the command was cut off, -.
    pub saturation: Option<f64>,
}

/// A cable becomes taut or slack.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CableSwitch {
    /// When, s.
    pub t_s: f64,
    /// What it becomes: `taut` or `slack`.
    pub cable: String,
    /// Impulse with which it becomes taut, N s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub impulse_ns: Option<f64>,
}

/// Measures a flyable plan and, if there is one, its flight.
pub fn measure(scenario: &Scenario, plan: &Plan, flight: Option<&Flight>) -> Metrics {
    Metrics { slung_load: Some(slung_load(scenario, plan, flight)), ..Metrics::default() }
}

fn slung_load(scenario: &Scenario, plan: &Plan, flight: Option<&Flight>) -> SlungLoadMetrics {
    let mut metrics = SlungLoadMetrics { flight_time_s: plan.flight_time_s().and_then(finite), ..Default::default() };
    if let Ok(planned) = PlannedMotion::new(scenario, plan) {
        of_plan(scenario, &planned, &mut metrics);
    }
    if let Some(flight) = flight {
        of_flight(scenario, plan, flight, &mut metrics);
    }
    metrics
}

fn of_plan(scenario: &Scenario, planned: &PlannedMotion, metrics: &mut SlungLoadMetrics) {
    let parts = Parts::new(scenario.slung_load_model(&scenario.vehicles[0]));
    metrics.envelope_switches_s = crossings_s(planned, |body| body.cable_m().xy().norm() - parts.body_radius_m());
    metrics.r_function_switches_s =
        crossings_s(planned, |body| std::f64::consts::SQRT_2 * body.cable_m().xy().amax() - parts.body_radius_m());
    metrics.planned_thrust_n = extremes(planned.knots.iter().flat_map(|knot| knot.thrust_n.iter().copied()));
    metrics.planned_tension_n =
        extremes(planned.knots.iter().map(|knot| knot.tension_n).filter(|tension| *tension != 0.0));
    metrics.planned_swing_deg = largest(planned.knots.iter().map(|knot| swing_deg(&knot.state)));
    let impact = |(t_s, impulse_ns): &(f64, f64)| switch(*t_s, Cable::Taut, Some(*impulse_ns));
    metrics.planned_impacts = planned.impacts.iter().map(impact).collect();
}

/// When a function of the planned state changes its sign, s; linear between the rows.
fn crossings_s(planned: &PlannedMotion, value: impl Fn(&SlungLoadState) -> f64) -> Vec<f64> {
    let crossing_s = |[(from_s, before), (to_s, after)]: [(f64, f64); 2]| {
        let is_crossed = (before > 0.0) != (after > 0.0) && to_s > from_s;
        is_crossed.then(|| from_s + (to_s - from_s) * before / (before - after))
    };
    let ends = |at: usize| (planned.knots[at].t_s, value(&planned.knots[at].state));
    (1..planned.knots.len()).filter_map(|at| crossing_s([ends(at - 1), ends(at)])).collect()
}

fn of_flight(scenario: &Scenario, plan: &Plan, flight: &Flight, metrics: &mut SlungLoadMetrics) {
    let switches = flight.events.iter().filter_map(|event| match event.kind {
        EventKind::CableTaut { impulse_ns } => Some(switch(event.t_s, Cable::Taut, Some(impulse_ns))),
        EventKind::CableSlack => Some(switch(event.t_s, Cable::Slack, None)),
        _ => None,
    });
    metrics.flown_switches = switches.collect();
    if let Ok(flown) = FlownMotion::new(flight) {
        metrics.flown_swing_deg = largest(flown.motion.samples().iter().map(|sample| swing_deg(&sample.body)));
        let tracked =
            flown.log.loads.iter().zip(&flown.log.samples).filter(|(_, sample)| sample.t_s <= flight.plan_end_s);
        metrics.load_tracking_max_m = largest(tracked.map(|(load, _)| {
            (0..3).map(|i| (load.position_m[i] - load.reference_position_m[i]).powi(2)).sum::<f64>().sqrt()
        }));
    }
    if let Some(vehicle) =
        Tracked::new(scenario, plan, flight).ok().and_then(|tracked| tracked.vehicles.into_iter().next())
    {
        metrics.tracking_max_m = finite(largest_tracking_error(vehicle.tracked).0);
        metrics.tracking_rms_m = finite(root_mean_square_tracking_error(vehicle.tracked));
        metrics.saturation = finite(saturation(vehicle.tracked));
    }
}

fn switch(t_s: f64, cable: Cable, impulse_ns: Option<f64>) -> CableSwitch {
    let cable = match cable {
        Cable::Taut => "taut",
        Cable::Slack => "slack",
    };
    CableSwitch { t_s, cable: cable.to_owned(), impulse_ns }
}

/// Angle of the cable from straight down, deg.
fn swing_deg(body: &SlungLoadState) -> f64 {
    let cable_m = body.cable_m();
    cable_m.xy().norm().atan2(-cable_m.z).to_degrees()
}

fn largest(values: impl Iterator<Item = f64>) -> Option<f64> {
    extremes(values).map(|[_, highest]| highest)
}

/// Lowest and highest; `None` of none, or if one is not finite.
fn extremes(values: impl Iterator<Item = f64>) -> Option<[f64; 2]> {
    let values: Option<Vec<f64>> = values.map(finite).collect();
    values?.into_iter().map(|value| [value, value]).reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
}
