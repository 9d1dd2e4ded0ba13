//! The semantics again, at samples, written independently of the bounds.

use scenarios::Scenario;

use crate::verdict::motion::Motion;
use crate::verdict::random::Uniform;

/// Predicates about `uav-1` and `uav-2`, each with its value in [`value`].
pub const PREDICATES: [&str; 19] = [
    "altitude(uav-1) > 5 m",
    "east(uav-1) + 2 * north(uav-1) < 3 m",
    "speed(uav-1) < 20 m/s",
    "ground_speed(uav-1) > climb_rate(uav-1)",
    "distance(uav-1, uav-2) > 12 m",
    "horizontal_distance(uav-1, uav-2) < 25 m",
    "distance(uav-1, point(3 m, -4 m, 5 m)) > 10 m",
    "inside(uav-1, field) > 1 m",
    "abs(climb_rate(uav-1)) < 4 m/s",
    "flight_path(uav-1) < 30 deg",
    "heading_from(uav-1, 30 deg) < 100 deg",
    "acceleration(uav-1) < 30 m/s^2",
    "max(altitude(uav-1), altitude(uav-2), 0 m) < 20 m",
    "altitude(uav-1) * east(uav-2) / 10 m > 1 m - time * 1 m / 1 s",
    "distance(uav-1, mover) > 3 m",
    "horizontal_distance(uav-1, mover) < 9 m",
    "distance(uav-1, vehicles) > 12 m",
    "horizontal_distance(uav-1, obstacles) > 2 m",
    "1 m / (abs(altitude(uav-1)) + 2 m) < 0.3",
];

/// The value of a predicate at an instant.
pub fn value(predicate: &str, scenario: &Scenario, motions: &[Motion], t_s: f64) -> f64 {
    let state = |vehicle: usize| motions[vehicle].state(t_s).expect("an instant of the motion");
    let (a, b) = (state(0), state(1));
    let (p, q, v) = (a.position_m, b.position_m, a.velocity_mps);
    let away = |from: [f64; 3]| (0..3).map(|axis| (p[axis] - from[axis]).powi(2)).sum::<f64>().sqrt();
    let (speed, ground_speed) = (v.iter().map(|v| v * v).sum::<f64>().sqrt(), v[0].hypot(v[1]));
    match PREDICATES.iter().position(|it| *it == predicate).expect("a known predicate") {
        0 => p[2] - 5.0,
        1 => 3.0 - (p[0] + 2.0 * p[1]),
        2 => 20.0 - speed,
        3 => ground_speed - v[2],
        4 => away(q) - 12.0,
        5 => 25.0 - (p[0] - q[0]).hypot(p[1] - q[1]),
        6 => away([3.0, -4.0, 5.0]) - 10.0,
        7 => scenario.world.geofences[0].margin_m(p) - 1.0,
        8 => 4.0 - v[2].abs(),
        9 => 30.0 - v[2].atan2(ground_speed).to_degrees(),
        10 => 100.0 - ((v[1].atan2(v[0]).to_degrees() - 30.0 + 540.0).rem_euclid(360.0) - 180.0).abs(),
        11 => 30.0 - acceleration_mps2(&motions[0], t_s),
        12 => 20.0 - p[2].max(q[2]).max(0.0),
        13 => p[2] * q[0] / 10.0 - (1.0 - t_s),
        14 => scenario.world.moving[0].signed_distance_m(t_s, p) - 3.0,
        15 => 9.0 - from_mover_m(scenario, p, t_s),
        16 => away(q) - 12.0,
        17 => {
            let poles = scenario.world.cylinders.iter();
            let from_pole_m = poles.map(|it| (p[0] - it.center_m[0]).hypot(p[1] - it.center_m[1]) - it.radius_m);
            from_pole_m.fold(from_mover_m(scenario, p, t_s), f64::min) - 2.0
        }
        _ => 0.3 - 1.0 / (p[2].abs() + 2.0),
    }
}

/// Horizontal distance from the surface of the moving cylinder, m: from its axis, less its radius.
fn from_mover_m(scenario: &Scenario, [x_m, y_m, _]: [f64; 3], t_s: f64) -> f64 {
    let mover = &scenario.world.moving[0];
    let [axis_x_m, axis_y_m] = mover.position_m(t_s);
    (x_m - axis_x_m).hypot(y_m - axis_y_m) - mover.radius_m
}

/// The second derivative of the Hermite cubic around `t_s`.
fn acceleration_mps2(motion: &Motion, t_s: f64) -> f64 {
    let after = motion.knots().partition_point(|knot| knot.t_s < t_s).max(1);
    let [a, b] = [motion.knots()[after - 1], motion.knots()[after]];
    let (h, u) = (b.t_s - a.t_s, (t_s - a.t_s) / (b.t_s - a.t_s));
    let axis = |axis: usize| {
        let [p0, p1] = [a.position_m[axis], b.position_m[axis]];
        let [m0, m1] = [a.velocity_mps[axis] * h, b.velocity_mps[axis] * h];
        ((12.0 * u - 6.0) * (p0 - p1) + (6.0 * u - 4.0) * m0 + (6.0 * u - 2.0) * m1) / (h * h)
    };
    (0..3).map(axis).map(|a| a * a).sum::<f64>().sqrt()
}

/// A formula over smooth predicates, evaluated at samples.
pub enum Sampled {
    Predicate(usize),
    Not(Box<Sampled>),
    And(Box<Sampled>, Box<Sampled>),
    Or(Box<Sampled>, Box<Sampled>),
    Always(u32, u32, Box<Sampled>),
    Eventually(u32, u32, Box<Sampled>),
    Until(u32, u32, Box<Sampled>, Box<Sampled>),
}

/// Time between two samples, s. The ends of windows and of motions are samples.
const STEP_S: f64 = 1.0 / 256.0;
/// Predicates in metres, without jumps.
const SMOOTH: [usize; 5] = [0, 1, 4, 6, 7];

/// The values of all predicates at samples.
pub struct Samples {
    predicates: Vec<Vec<f64>>,
    /// How far a robustness at samples may be from the one of continuous time.
    pub error: f64,
}

impl Samples {
    pub fn of(scenario: &Scenario, motions: &[Motion], end_s: f64) -> Self {
        let count = (end_s / STEP_S).floor() as usize + 1;
        let of_predicate =
            |it: &&str| (0..count).map(|step| value(it, scenario, motions, step as f64 * STEP_S)).collect();
        let predicates: Vec<Vec<f64>> = PREDICATES.iter().map(of_predicate).collect();
        let changes = SMOOTH.iter().flat_map(|&it| predicates[it].windows(2).map(|pair| (pair[1] - pair[0]).abs()));
        let error = changes.fold(0.0, f64::max);
        Self { predicates, error }
    }
}

impl Sampled {
    pub fn random(uniform: &mut Uniform, depth: u32) -> Self {
        let mut choice = |n: f64| uniform.between(0.0, n) as u32;
        let (kind, from, length) =
            (if depth == 0 { 0 } else { choice(7.0) }, choice(0.5 / STEP_S), choice(1.5 / STEP_S));
        let predicate = SMOOTH[choice(4.999) as usize];
        let mut part = || Box::new(Self::random(uniform, depth.saturating_sub(1)));
        match kind {
            0 => Self::Predicate(predicate),
            1 => Self::Not(part()),
            2 => Self::And(part(), part()),
            3 => Self::Or(part(), part()),
            4 => Self::Always(from, from + length, part()),
            5 => Self::Eventually(from, from + length, part()),
            _ => Self::Until(from, from + length, part(), part()),
        }
    }

    /// As the user would write it.
    pub fn text(&self) -> String {
        let window = |a: &u32, b: &u32| format!("[{} s, {} s]", f64::from(*a) * STEP_S, f64::from(*b) * STEP_S);
        match self {
            Self::Predicate(index) => format!("({})", PREDICATES[*index]),
            Self::Not(a) => format!("(not {})", a.text()),
            Self::And(a, b) => format!("({} and {})", a.text(), b.text()),
            Self::Or(a, b) => format!("({} or {})", a.text(), b.text()),
            Self::Always(from, to, a) => format!("(always {} {})", window(from, to), a.text()),
            Self::Eventually(from, to, a) => format!("(eventually {} {})", window(from, to), a.text()),
            Self::Until(from, to, a, b) => format!("({} until {} {})", a.text(), window(from, to), b.text()),
        }
    }

    /// Its robustness at samples.
    pub fn robustness(&self, samples: &Samples) -> f64 {
        self.at_samples(&samples.predicates)[0]
    }

    fn at_samples(&self, predicates: &[Vec<f64>]) -> Vec<f64> {
        let n = predicates[0].len();
        let over = |from: u32, to: u32, step: usize| (step + from as usize).min(n)..(step + to as usize + 1).min(n);
        let pair = |a: &Self, b: &Self, of: fn(f64, f64) -> f64| {
            let (a, b) = (a.at_samples(predicates), b.at_samples(predicates));
            a.into_iter().zip(b).map(|(a, b)| of(a, b)).collect()
        };
        match self {
            Self::Predicate(index) => predicates[*index].clone(),
            Self::Not(a) => a.at_samples(predicates).into_iter().map(|value| -value).collect(),
            Self::And(a, b) => pair(a, b, f64::min),
            Self::Or(a, b) => pair(a, b, f64::max),
            Self::Always(from, to, a) => {
                let a = a.at_samples(predicates);
                (0..n).map(|step| a[over(*from, *to, step)].iter().copied().fold(f64::INFINITY, f64::min)).collect()
            }
            Self::Eventually(from, to, a) => {
                let a = a.at_samples(predicates);
                (0..n).map(|step| a[over(*from, *to, step)].iter().copied().fold(f64::NEG_INFINITY, f64::max)).collect()
            }
            Self::Until(from, to, a, b) => {
                let (a, b) = (a.at_samples(predicates), b.at_samples(predicates));
                let at = |step: usize| {
                    let window = over(*from, *to, step);
                    let (mut so_far, mut best) = (f64::INFINITY, f64::NEG_INFINITY);
                    for (later, (a, b)) in a.iter().zip(&b).enumerate().take(window.end).skip(step) {
                        so_far = so_far.min(*a);
                        best = if later >= window.start { best.max(so_far.min(*b)) } else { best };
                    }
                    best
                };
                (0..n).map(at).collect()
            }
        }
    }
}
