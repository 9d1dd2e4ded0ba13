//! An independent integrator: classical Runge-Kutta of order 4 in cable angles, with small steps and events at the
//! switches.
//!
//! Two point masses; the force on the quadrotor is a function of time. It shares no formula with the simulator: taut
//! motion is integrated in (p, α, β) by the equations of Kang, Huang, Wen (2020), slack motion as free fall.

/// Position and velocity of quadrotor and load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    pub p: [f64; 3],
    pub v: [f64; 3],
    pub load_p: [f64; 3],
    pub load_v: [f64; 3],
}

/// A switch of the cable: its time, s, and its impulse, N s, if the cable became taut.
pub type Switch = (f64, Option<f64>);

pub const M_Q: f64 = 1.32;
pub const M_L: f64 = 0.2;
pub const L_0: f64 = 0.65;
pub const G: f64 = 9.81;

/// Integrates to `end_s` by steps of `h_s` under a force on the quadrotor, N. Returns the states every `every` steps
/// and the switches.
pub fn integrate(
    start: Pair,
    taut: bool,
    force_n: &dyn Fn(f64) -> [f64; 3],
    end_s: f64,
    h_s: f64,
    every: usize,
) -> (Vec<Pair>, Vec<Switch>) {
    let steps = (end_s / h_s).round() as usize;
    let (mut pair, mut is_taut) = (start, taut);
    let (mut states, mut switches) = (vec![start], vec![]);
    for step in 0..steps {
        let t_s = step as f64 * h_s;
        if is_taut {
            let next = taut_step(&pair, t_s, h_s, force_n);
            pair = next;
            if tension_n(&pair, &force_n(t_s + h_s)) < 0.0 {
                is_taut = false;
                switches.push((t_s + h_s, None));
            }
        } else {
            let next = slack_step(&pair, t_s, h_s, force_n);
            if length_m(&next) >= L_0 {
                let (mut low, mut high) = (0.0, 1.0);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    let long = length_m(&slack_step(&pair, t_s, h_s * middle, force_n)) >= L_0;
                    if long { high = middle } else { low = middle }
                }
                let touched = slack_step(&pair, t_s, h_s * high, force_n);
                let (after, impulse) = impact(&touched);
                switches.push((t_s + h_s * high, Some(impulse)));
                pair = taut_step(&after, t_s + h_s * high, h_s * (1.0 - high), force_n);
                is_taut = true;
            } else {
                pair = next;
            }
        }
        if (step + 1) % every == 0 {
            states.push(pair);
        }
    }
    (states, switches)
}

fn impact(pair: &Pair) -> (Pair, f64) {
    let d = direction(pair);
    let parting: f64 = (0..3).map(|i| d[i] * (pair.load_v[i] - pair.v[i])).sum();
    let impulse = parting * M_Q * M_L / (M_Q + M_L);
    let v = std::array::from_fn(|i| pair.v[i] + impulse * d[i] / M_Q);
    let load_v = std::array::from_fn(|i| pair.load_v[i] - impulse * d[i] / M_L);
    (Pair { v, load_v, ..*pair }, impulse)
}

fn direction(pair: &Pair) -> [f64; 3] {
    let length = length_m(pair);
    std::array::from_fn(|i| (pair.load_p[i] - pair.p[i]) / length)
}

pub fn length_m(pair: &Pair) -> f64 {
    (0..3).map(|i| (pair.load_p[i] - pair.p[i]).powi(2)).sum::<f64>().sqrt()
}

/// The force is averaged over a step by Simpson's rule, of order 4.
fn slack_step(pair: &Pair, t_s: f64, h_s: f64, force_n: &dyn Fn(f64) -> [f64; 3]) -> Pair {
    let rate = |t: f64, x: &[f64; 6]| -> [f64; 6] {
        let f = force_n(t);
        [x[3], x[4], x[5], f[0] / M_Q, f[1] / M_Q, f[2] / M_Q - G]
    };
    let x = rk4([pair.p[0], pair.p[1], pair.p[2], pair.v[0], pair.v[1], pair.v[2]], t_s, h_s, rate);
    let load_p =
        std::array::from_fn(|i| pair.load_p[i] + h_s * pair.load_v[i] - if i == 2 { 0.5 * G * h_s * h_s } else { 0.0 });
    let load_v = std::array::from_fn(|i| pair.load_v[i] - if i == 2 { G * h_s } else { 0.0 });
    Pair { p: [x[0], x[1], x[2]], v: [x[3], x[4], x[5]], load_p, load_v }
}

/// λ (1/m_Q + 1/m_L) = l (α'² + cos²α β'²) - F·d / m_Q.
fn lambda(x: &[f64; 10], f: &[f64; 3]) -> f64 {
    let [a, b, da, db] = [x[6], x[7], x[8], x[9]];
    let d = [-a.cos() * b.sin(), a.sin(), -a.cos() * b.cos()];
    let along: f64 = (0..3).map(|i| f[i] * d[i]).sum::<f64>() / M_Q;
    M_Q * M_L / (M_Q + M_L) * (L_0 * (da * da + (a.cos() * db).powi(2)) - along)
}

pub fn tension_n(pair: &Pair, f: &[f64; 3]) -> f64 {
    lambda(&to_angles(pair), f)
}

/// p, v, α, β, α', β'.
fn to_angles(pair: &Pair) -> [f64; 10] {
    let d = direction(pair);
    let w: [f64; 3] = std::array::from_fn(|i| (pair.load_v[i] - pair.v[i]) / L_0);
    let (a, b) = (d[1].asin(), (-d[0]).atan2(-d[2]));
    let d_a = [a.sin() * b.sin(), a.cos(), a.sin() * b.cos()];
    let d_b = [-a.cos() * b.cos(), 0.0, a.cos() * b.sin()];
    let da: f64 = (0..3).map(|i| w[i] * d_a[i]).sum();
    let db: f64 = (0..3).map(|i| w[i] * d_b[i]).sum::<f64>() / a.cos().powi(2);
    [pair.p[0], pair.p[1], pair.p[2], pair.v[0], pair.v[1], pair.v[2], a, b, da, db]
}

fn taut_step(pair: &Pair, t_s: f64, h_s: f64, force_n: &dyn Fn(f64) -> [f64; 3]) -> Pair {
    let rate = |t: f64, x: &[f64; 10]| -> [f64; 10] {
        let f = force_n(t);
        let [a, b, da, db] = [x[6], x[7], x[8], x[9]];
        let d = [-a.cos() * b.sin(), a.sin(), -a.cos() * b.cos()];
        let d_a = [a.sin() * b.sin(), a.cos(), a.sin() * b.cos()];
        let d_b = [-a.cos() * b.cos(), 0.0, a.cos() * b.sin()];
        let along = |e: [f64; 3]| (0..3).map(|i| f[i] * e[i]).sum::<f64>() / M_Q;
        let λ = lambda(x, &f);
        let acc: [f64; 3] = std::array::from_fn(|i| (f[i] + λ * d[i]) / M_Q - if i == 2 { G } else { 0.0 });
        let dda = -(along(d_a) / L_0 + a.sin() * a.cos() * db * db);
        let ddb = -(along(d_b) / (L_0 * a.cos().powi(2)) - 2.0 * a.tan() * da * db);
        [x[3], x[4], x[5], acc[0], acc[1], acc[2], da, db, dda, ddb]
    };
    let x = rk4(to_angles(pair), t_s, h_s, rate);
    let [a, b, da, db] = [x[6], x[7], x[8], x[9]];
    let d = [-a.cos() * b.sin(), a.sin(), -a.cos() * b.cos()];
    let d_a = [a.sin() * b.sin(), a.cos(), a.sin() * b.cos()];
    let d_b = [-a.cos() * b.cos(), 0.0, a.cos() * b.sin()];
    Pair {
        p: [x[0], x[1], x[2]],
        v: [x[3], x[4], x[5]],
        load_p: std::array::from_fn(|i| x[i] + L_0 * d[i]),
        load_v: std::array::from_fn(|i| x[3 + i] + L_0 * (d_a[i] * da + d_b[i] * db)),
    }
}

fn rk4<const N: usize>(x: [f64; N], t: f64, h: f64, rate: impl Fn(f64, &[f64; N]) -> [f64; N]) -> [f64; N] {
    let moved = |k: &[f64; N], s: f64| -> [f64; N] { std::array::from_fn(|i| x[i] + s * k[i]) };
    let k1 = rate(t, &x);
    let k2 = rate(t + h / 2.0, &moved(&k1, h / 2.0));
    let k3 = rate(t + h / 2.0, &moved(&k2, h / 2.0));
    let k4 = rate(t + h, &moved(&k3, h));
    std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}
