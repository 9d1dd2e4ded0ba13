//! Figures of single flights, drawn from the scene that the recordings show.

use std::f64::consts::TAU;

use planners::Planner;
use scenarios::slung_load::State;
use scenarios::{CostMap, Horizon, Iteration, PathTiming, Plan, Scenario, Search};
use sim::Flight;

use super::chart::{Chart, Curve};
use super::{Figure, Options};
use crate::error::Error;
use crate::output::run::JudgedRun;
use crate::output::scene::{Curve as Series, Scene, SeriesKind, Shape, builder, colours};
use crate::plan_source::PlanSource;
use crate::verdict::Verdict;

/// Largest number of points of a path, and of a curve.
const MAX_POINTS: usize = 400;
/// Largest number of points of all paths of a fleet.
const MAX_POINTS_OF_FLEET: usize = 6000;
/// Number of envelope circles along a path.
const ENVELOPES: usize = 9;
/// Corners of the polygon that stands for a circle.
const CORNERS: usize = 48;
/// Brightness of the vehicles' colours on white.
const INK: f64 = 0.78;
/// A figure of this size is that of a large fleet: smaller in a quick run.
const QUICK_FLEET: usize = 10;

/// A flight and its figures.
pub struct FlightFigures {
    /// Number of the paper.
    pub paper: u8,
    /// Beginning of the figures' names.
    pub name: &'static str,
    /// Scenario file below the folder of scenarios.
    pub scenario: &'static str,
    /// Planner.
    pub planner: &'static str,
    /// An option of the planner, in place of the scenario's.
    pub change: Change,
    /// What to draw.
    pub views: &'static [View],
}

/// An option of a planner, in place of the scenario's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// None.
    Nothing,
    /// The cost map.
    CostMap(CostMap),
    /// How a path becomes a motion.
    Timing(PathTiming),
}

impl Change {
    fn apply(self, scenario: &mut Scenario) {
        match self {
            Self::Nothing => {}
            Self::CostMap(cost_map) => {
                let own = scenario.planner.horizon.take().unwrap_or_default();
                scenario.planner.horizon = Some(Horizon { cost_map: Some(cost_map), ..own });
            }
            Self::Timing(timing) => scenario.planner.search = Some(Search { timing: Some(timing) }),
        }
    }
}

/// What is drawn of a flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// Obstacles, planned and flown paths.
    FromAbove,
    /// The same with the last cost map.
    WithCostMap,
    /// The same with envelope circles.
    WithEnvelopes,
    /// A group of series over time: ending of the name, group, caption.
    Series(&'static str, &'static str, &'static str),
    /// The planner's residuals over its iterations.
    Convergence,
    /// The smallest separation at the nodes over the planner's iterations.
    Spacing,
    /// Radius of the envelope circle over time, and what it is switched between.
    EnvelopeRadius,
}

impl FlightFigures {
    /// Names of the figures.
    pub fn names(&self) -> impl Iterator<Item = String> {
        self.views.iter().map(|view| format!("{}-{}", self.name, view.name()))
    }

    /// Plans, flies, judges and draws.
    ///
    /// # Errors
    ///
    /// A scenario that cannot be loaded, a planner that is not registered.
    pub fn draw(&self, options: &Options) -> Result<Vec<Figure>, Error> {
        let flown = fly(self, options)?;
        let run = flown.run();
        let scene = builder::build(&run);
        let figure = |view: &View| Figure {
            paper: self.paper,
            name: format!("{}-{}", self.name, view.name()),
            caption: format!("{}: `{}` on {}; {}", view.caption(), self.planner, flown.scenario.name, flown.outcome()),
            svg: view.chart(&flown.scenario, &scene, &flown.plan).svg().unwrap_or_default(),
        };
        Ok(self.views.iter().map(figure).collect())
    }
}

/// Everything that a scene needs.
struct FlownPlan {
    scenario: Scenario,
    plan: Plan,
    flight: Option<Flight>,
    verdict: Verdict,
}

impl FlownPlan {
    fn run(&self) -> JudgedRun<'_> {
        let Self { scenario, plan, flight, verdict } = self;
        JudgedRun { scenario, plan, flight: flight.as_ref(), verdict, ghost: None }
    }

    /// `PASS, flight time 260.3 s`.
    fn outcome(&self) -> String {
        let time = self.plan.flight_time_s().map(|time_s| format!(", flight time {time_s:.2} s"));
        format!("{}{}", self.verdict.outcome, time.unwrap_or_default())
    }
}

fn fly(figures: &FlightFigures, options: &Options) -> Result<FlownPlan, Error> {
    let mut scenario = options.load(figures.scenario)?;
    if options.is_quick {
        scenario.vehicles.truncate(QUICK_FLEET);
    }
    figures.change.apply(&mut scenario);
    let source = PlanSource::Registered(registered(figures.planner));
    let flown = source.fly(&scenario, scenario.simulation.seed);
    let verdict = flown.judge(&scenario);
    Ok(FlownPlan { plan: flown.answer.plan, flight: flown.flight, verdict, scenario })
}

/// A planner of the registry.
pub fn registered(name: &str) -> &'static Planner {
    planners::find(name).expect("a planner of the registry")
}

impl View {
    fn name(self) -> &'static str {
        match self {
            Self::FromAbove | Self::WithCostMap | Self::WithEnvelopes => "from-above",
            Self::Series(name, _, _) => name,
            Self::Convergence => "convergence",
            Self::Spacing => "spacing",
            Self::EnvelopeRadius => "envelope",
        }
    }

    fn caption(self) -> &'static str {
        match self {
            Self::FromAbove => "Planned (pale) and flown paths from above",
            Self::WithCostMap => "Track from above, with the graph of the last cost map",
            Self::WithEnvelopes => "Paths of quadrotor and load (amber) from above, with the envelope circle",
            Self::Series(_, _, caption) => caption,
            Self::Convergence => "Change, defect and trust region over the planner's iterations, log10 of m",
            Self::Spacing => "Smallest separation at the nodes over the planner's iterations",
            Self::EnvelopeRadius => {
                "Planned reach of the load by eq. 14 and bounded by eq. 19; the larger of it and the body's radius is the \
                 envelope's"
            }
        }
    }

    fn chart(self, scenario: &Scenario, scene: &Scene<'_>, plan: &Plan) -> Chart {
        match self {
            Self::FromAbove => map(scene, &[]),
            Self::WithCostMap => map(scene, &["cost_map"]),
            Self::WithEnvelopes => map(scene, &["envelopes"]),
            Self::Series(_, group, _) => over_time(scene, group),
            Self::Convergence => convergence(plan),
            Self::Spacing => {
                let spacing = history(plan, |it| it.separation_m.unwrap_or(f64::NAN));
                iterations("smallest separation at the nodes [m]", vec![Curve::line("", ink(colours::FLEET), spacing)])
            }
            Self::EnvelopeRadius => envelope_radius(scenario, plan),
        }
    }
}

/// Obstacles and paths from above. `extras`: kinds of items that change over time.
fn map(scene: &Scene<'_>, extras: &[&str]) -> Chart {
    let mut chart =
        Chart { is_map: true, labels: ["east x [m]", "north y [m]"].map(str::to_owned), ..Chart::default() };
    let paths = scene.items.iter().filter(|item| item.path[0] == "flown").count();
    let max_points = (MAX_POINTS_OF_FLEET / paths.max(1)).clamp(40, MAX_POINTS);
    let of = |kind: &'static str| scene.items.iter().filter(move |item| item.path[0] == kind);
    for item in of("obstacles") {
        chart.areas.extend(areas(&item.shape));
    }
    for changes in scene.changes.iter().filter(|changes| changes.path[0] == "hidden") {
        chart.areas.extend(changes.shapes.iter().flat_map(|(_, shape)| areas(shape)));
    }
    for changes in scene.changes.iter().filter(|changes| extras.contains(&changes.path[0].as_str())) {
        let last = changes.shapes.last().into_iter();
        chart.curves.extend(last.flat_map(|(_, shape)| lines(shape, 1, MAX_POINTS, |_| [190, 200, 212])));
    }
    for animation in scene.animations.iter().filter(|it| extras.contains(&it.path[0].as_str())) {
        let stride = (animation.strips.len() / ENVELOPES).max(1);
        let strips = animation.strips.iter().step_by(stride).map(|strip| flat(strip, MAX_POINTS));
        chart.curves.extend(strips.map(|points| Curve { width: 1, ..Curve::line("", [150, 180, 225], points) }));
    }
    for (kind, width) in [("planned", 1), ("planned_load", 1), ("flown", 2), ("flown_load", 2)] {
        let colour = |rgb| if width == 1 { pale(rgb) } else { ink(rgb) };
        chart.curves.extend(of(kind).flat_map(|item| lines(&item.shape, width, max_points, colour)));
    }
    chart
}

/// Outlines of obstacles: circles, and the lower rings of prisms.
fn areas(shape: &Shape) -> Vec<Vec<(f64, f64)>> {
    match shape {
        Shape::Cylinders(cylinders) => {
            let circle = |centre: [f64; 3], radius_m: f64| {
                let corner = |i: usize| {
                    let (sin, cos) = (TAU * i as f64 / CORNERS as f64).sin_cos();
                    (centre[0] + radius_m * cos, centre[1] + radius_m * sin)
                };
                (0..CORNERS).map(corner).collect()
            };
            cylinders.cylinders.iter().map(|it| circle(it.centre_m, it.radius_m)).collect()
        }
        Shape::Lines(lines) => {
            let rings = lines.strips.iter().filter(|strip| strip.len() > 3 && strip.first() == strip.last());
            rings.take(1).map(|strip| flat(strip, MAX_POINTS)).collect()
        }
        _ => Vec::new(),
    }
}

fn lines(shape: &Shape, width: u32, max_points: usize, colour: impl Fn([u8; 3]) -> [u8; 3]) -> Vec<Curve> {
    let Shape::Lines(lines) = shape else { return Vec::new() };
    let rgb = lines.paints.first().map_or([0; 3], |paint| paint.rgb);
    let strips = lines.strips.iter().map(|strip| flat(strip, max_points));
    strips.map(|points| Curve { width, ..Curve::line("", colour(rgb), points) }).collect()
}

/// A polyline from above with at most `max_points` points and its last one.
fn flat(strip: &[[f64; 3]], max_points: usize) -> Vec<(f64, f64)> {
    let stride = strip.len().div_ceil(max_points).max(1);
    strip.iter().step_by(stride).chain(strip.last()).map(|[x, y, _]| (*x, *y)).collect()
}

/// A group of the scene's series with its limits.
fn over_time(scene: &Scene<'_>, group: &str) -> Chart {
    let title = scene.verdict_plots.iter().chain(scene.tabs.iter().flat_map(|tab| &tab.plots));
    let title = title.filter(|view| view.group == group).map(|view| view.title.clone()).next();
    let channels = scene.channels.iter().flat_map(|vehicle| vehicle.channels.iter().map(|it| (vehicle.samples, it)));
    let channels = channels.filter_map(|(samples, it)| Some((samples, it, it.plot.as_ref()?)));
    let channels = channels.filter(|(_, _, plot)| plot.group == group);
    let mut curves: Vec<Curve> = channels
        .map(|(samples, it, plot)| Curve::line(&plot.name, ink(plot.colour), points(it.curve(samples, plot))))
        .collect();
    let of_group = || scene.series.iter().filter(|series| series.group == group);
    let quantities = of_group().filter(|series| series.kind == SeriesKind::Quantity);
    curves.extend(quantities.map(|it| Curve::line(&it.title, ink(it.colour), points(it.curve.clone()))));
    let limits = of_group().filter(|series| series.kind == SeriesKind::Limit);
    let limits = limits.filter_map(|it| Some((it.title.clone(), *it.curve.values.first()?))).collect();
    let labels = ["time t [s]".to_owned(), title.unwrap_or_else(|| group.to_owned())];
    Chart { labels, curves, limits, ..Chart::default() }
}

fn points(curve: Series) -> Vec<(f64, f64)> {
    let curve = curve.decimated(MAX_POINTS);
    curve.times_s.into_iter().zip(curve.values).collect()
}

fn convergence(plan: &Plan) -> Chart {
    let curve = |label: &str, index: usize, value: fn(&Iteration) -> f64| {
        Curve::line(label, ink(colours::vehicle(index, 3)), history(plan, |it| value(it).log10()))
    };
    let curves = vec![
        curve("change of position", 0, |it| it.change_m),
        curve("defect", 1, |it| it.defect_m),
        curve("trust region", 2, |it| it.trust_region_m),
    ];
    iterations("log10 of m", curves)
}

fn iterations(label: &str, curves: Vec<Curve>) -> Chart {
    Chart { labels: ["iteration".to_owned(), label.to_owned()], curves, ..Chart::default() }
}

/// The load's horizontal distance (Kang, Huang, Wen 2020, eq. 14), its bound by R-functions (eq. 19), and the body's radius.
fn envelope_radius(scenario: &Scenario, plan: &Plan) -> Chart {
    let Some(trajectory) = plan.trajectories.first() else { return Chart::default() };
    let trajectory = trajectory.slung_load();
    let curve = |label: &str, index: usize, radius_m: fn([f64; 2]) -> f64| {
        let at = |(time_s, state): (&f64, &State)| (*time_s, radius_m([state.cable_m()[0], state.cable_m()[1]]));
        Curve::line(
            label,
            ink(colours::vehicle(index, 3)),
            trajectory.times_s.iter().zip(&trajectory.states).map(at).collect(),
        )
    };
    let curves = vec![
        curve("reach by eq. 14", 0, |[x, y]| x.hypot(y)),
        curve("bound by eq. 19", 1, |[x, y]| std::f64::consts::SQRT_2 * x.abs().max(y.abs())),
    ];
    let body_radius_m = scenario.slung_load_model(&scenario.vehicles[0]).body_radius_m();
    let limits = vec![(format!("body {body_radius_m:.3} m"), body_radius_m)];
    Chart { labels: ["time t [s]", "radius [m]"].map(str::to_owned), curves, limits, ..Chart::default() }
}

fn history(plan: &Plan, value: impl Fn(&Iteration) -> f64) -> Vec<(f64, f64)> {
    let points = plan.history.iter().enumerate().map(|(index, it)| (index as f64 + 1.0, value(it)));
    points.filter(|(_, value)| value.is_finite()).collect()
}

/// A colour of a scene on white.
fn ink(rgb: [u8; 3]) -> [u8; 3] {
    rgb.map(|channel| (f64::from(channel) * INK) as u8)
}

/// The same, pale.
fn pale(rgb: [u8; 3]) -> [u8; 3] {
    rgb.map(|channel| 255 - (255 - channel) / 3)
}
