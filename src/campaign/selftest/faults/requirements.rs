//! Faults of requirements: each operator of their language in red, and formulas that nothing decides.

use scenarios::requirement::{AppliesTo, Requirement};

use super::super::{Fault, NearMiss, ReferenceCase};

/// Distance from what is reached, m.
const BEYOND_M: f64 = 1.0;

/// Checks of the only requirement.
const CHECKS: [&str; 2] = ["plan.requirement.r", "flight.requirement.r"];

/// What is known of the first vehicle: the heights of the samples or nodes of its motion, and the times of its ends.
struct Reached {
    low_m: f64,
    high_m: f64,
    end_s: f64,
}

/// A formula about what the vehicle `v` reaches.
type Text = fn(&Reached) -> String;

/// Formulas that do not hold, by the operator that decides.
const RED: &[(&str, Text)] = &[
    ("`always` is broken by its lowest point", |it| format!("always altitude(v) > {:.3} m", it.low_m + 1e-2)),
    ("`eventually` asks for a height that is not reached", |it| format!("eventually altitude(v) > {} m", over(it))),
    ("`not` of what always holds", |it| format!("not always altitude(v) > {} m", under(it))),
    ("`and` of what holds and of what does not", |it| {
        format!("always (altitude(v) > {} m and altitude(v) > {} m)", under(it), over(it))
    }),
    ("`or` of two that do not hold", |it| {
        format!("always (altitude(v) < {} m or altitude(v) > {} m)", under(it), over(it))
    }),
    ("`implies` whose condition holds from half-time on", |it| {
        format!("always (time > {} s implies altitude(v) > {} m)", 0.5 * it.end_s, over(it))
    }),
    ("`until` something that does not happen", |it| {
        format!("altitude(v) > {} m until altitude(v) > {} m", under(it), over(it))
    }),
    ("`until` something, and not kept until then", |it| {
        format!("altitude(v) > {} m until time > {} s", over(it), 0.5 * it.end_s)
    }),
    ("`until` within too short an interval", |it| {
        format!("altitude(v) > {} m until [0 s, {} s] time > {} s", under(it), 0.25 * it.end_s, 0.5 * it.end_s)
    }),
    ("`always` within an interval", |it| {
        format!("always [{} s, {} s] time > {} s", 0.25 * it.end_s, 0.75 * it.end_s, 0.5 * it.end_s)
    }),
    ("`eventually` within an interval", |it| {
        format!("eventually [0 s, {} s] time > {} s", 0.25 * it.end_s, 0.5 * it.end_s)
    }),
    ("`eventually` inside `always`", |it| {
        format!("always eventually [0 s, {} s] time < {} s", 0.1 * it.end_s, 0.8 * it.end_s)
    }),
    ("`always` inside `eventually`", |it| {
        format!("eventually always [0 s, {} s] altitude(v) > {} m", 0.1 * it.end_s, over(it))
    }),
    ("`for all` of which one does not", |it| format!("for all a: always altitude(a) > {} m", over(it))),
    ("`for some` of which none does", |_| "for some a: always altitude(a) > 1000 km".to_owned()),
    ("`<`", |it| format!("always altitude(v) < {} m", under(it))),
    ("`<=`", |it| format!("always altitude(v) <= {} m", under(it))),
    ("`>=`", |it| format!("always altitude(v) >= {} m", over(it))),
    ("a sum", |it| format!("always altitude(v) + {BEYOND_M} m < {:.3} m", it.high_m + BEYOND_M - 1e-2)),
    ("a difference", |it| format!("always altitude(v) - {} m < 0 m", under(it))),
    ("a product", |it| format!("always 2 * altitude(v) < {} m", 2.0 * under(it))),
    ("a quotient", |it| format!("always altitude(v) / 2 > {} m", 0.5 * over(it))),
    ("`abs`", |it| format!("always abs(altitude(v) - {} m) < {} m", under(it), 0.5 * BEYOND_M)),
    ("`min`", |it| format!("always min(altitude(v), {} m) > {:.3} m", over(it), it.low_m + 1e-2)),
    ("`max`", |it| format!("always max(altitude(v), {} m) < {:.3} m", under(it), it.high_m - 1e-2)),
    ("a speed", |_| "always speed(v) < -1 m/s".to_owned()),
    ("an acceleration", |_| "always acceleration(v) < -1 m/s^2".to_owned()),
    ("a distance", |_| "eventually distance(v, point(1000 km, 0 m, 0 m)) < 1 m".to_owned()),
    ("the time that is left", |it| format!("time_left > {} s", it.end_s + 100.0)),
    ("an interval after the end, with `always`", |_| "always [100 min, 101 min] altitude(v) > -1 km".to_owned()),
    ("an interval after the end, with `eventually`", |_| {
        "eventually [100 min, 101 min] altitude(v) > -1 km".to_owned()
    }),
    ("an interval after the end, with `until`", |_| {
        "altitude(v) > -1 km until [100 min, 101 min] altitude(v) > -1 km".to_owned()
    }),
    ("a quotient by nothing", |_| "always altitude(v) / (time - time) * 1 s > 0 m".to_owned()),
    ("an empty formula", |_| String::new()),
    ("an open bracket", |_| "always (altitude(v) > -1 km".to_owned()),
    ("an unknown vehicle", |_| "always altitude(uav-99) > -1 km".to_owned()),
    ("a signal that does not exist", |_| "always attitude(v) > -1 km".to_owned()),
    ("metres compared with seconds", |_| "always altitude(v) > -1 s".to_owned()),
];

/// Formulas that hold.
const GREEN: &[(&str, Text)] = &[
    ("`always` above its lowest point", |it| format!("always altitude(v) > {} m", under(it))),
    ("`eventually` at its highest point", |it| format!("eventually altitude(v) > {:.3} m", it.high_m - 1e-2)),
    ("`until` half-time", |it| format!("altitude(v) > {} m until time > {} s", under(it), 0.5 * it.end_s)),
    ("`until` within an interval that is long enough", |it| {
        format!("time < {} s until [0 s, {} s] time > {} s", 0.4 * it.end_s, 0.5 * it.end_s, 0.3 * it.end_s)
    }),
    ("`not` of what does not hold", |it| format!("not eventually altitude(v) < {} m", under(it))),
];

/// The faults of plans that were made before the flight, and of their flights.
pub fn faults() -> Vec<Fault> {
    let of_formulas = CHECKS.into_iter().flat_map(|check| RED.iter().map(move |red| formula(check, red)));
    of_formulas.chain(unjudged()).collect()
}

/// The faults of flights that were planned in the loop.
pub fn flown_faults() -> Vec<Fault> {
    RED.iter().map(|red| formula(CHECKS[1], red)).chain(unjudged()).collect()
}

/// Requirements that hold.
pub fn near_misses() -> Vec<NearMiss> {
    let of_formula = |&(name, text): &(&'static str, Text)| {
        NearMiss::new(name, move |it| {
            // A bound that the plan and the flight keep.
            let [plan, flight] = CHECKS.map(|check| reached(it, check));
            let both = Reached {
                low_m: plan.low_m.min(flight.low_m),
                high_m: plan.high_m.min(flight.high_m),
                end_s: plan.end_s.min(flight.end_s),
            };
            let text = text(&both);
            require(it, &text, AppliesTo::Both);
        })
    };
    GREEN.iter().map(of_formula).collect()
}

/// Requirements that cannot be judged: of a plan alone, or of a flight that does not exist.
fn unjudged() -> [Fault; 2] {
    [
        Fault::new(CHECKS[0], "a signal of the flight log is asked of the plan alone", |it| {
            require(it, "always tracking_error(v) < 1 km", AppliesTo::Plan);
        }),
        Fault::new(CHECKS[1], "there is no flight", |it| {
            require(it, "always altitude(v) > -1 km", AppliesTo::Flight);
            it.flight = None;
        }),
    ]
}

fn formula(check: &'static str, &(name, text): &(&'static str, Text)) -> Fault {
    Fault::new(check, name, move |it| {
        let text = text(&reached(it, check));
        let applies_to = if check == CHECKS[0] { AppliesTo::Plan } else { AppliesTo::Flight };
        require(it, &text, applies_to);
    })
}

fn require(it: &mut ReferenceCase, formula: &str, applies_to: AppliesTo) {
    let first = format!("({}", it.scenario.vehicles[0].name);
    let formula = formula.replace("(v", &first);
    let (name, description) = ("r".to_owned(), String::new());
    it.scenario.requirements.push(Requirement { name, formula, description, advisory: false, applies_to });
}

/// Below and above everything that is reached.
fn under(it: &Reached) -> f64 {
    (it.low_m - BEYOND_M).floor()
}

fn over(it: &Reached) -> f64 {
    (it.high_m + BEYOND_M).ceil()
}

fn reached(it: &mut ReferenceCase, check: &str) -> Reached {
    let samples: Vec<(f64, f64)> = if check == CHECKS[0] {
        let trajectory = &it.plan.trajectories[0];
        let height_m = |node| trajectory.nodes().position_m(node)[2];
        trajectory.times_s().iter().enumerate().map(|(node, &t_s)| (t_s, height_m(node))).collect()
    } else {
        let planned = it.planned_steps();
        it.samples(0)[..planned].iter().map(|sample| (sample.t_s, sample.position_m[2])).collect()
    };
    let heights_m = || samples.iter().map(|sample| sample.1);
    Reached {
        low_m: heights_m().fold(f64::INFINITY, f64::min),
        high_m: heights_m().fold(f64::NEG_INFINITY, f64::max),
        end_s: samples.last().map_or(0.0, |sample| sample.0),
    }
}
