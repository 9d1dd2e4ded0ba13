//! Plans by differential flatness of the taut system: the load's path determines the cable, the quadrotor's path, the
//! thrust and the attitude (yaw 0):
//!
//! ```text
//! λ d = -m_L (p_L'' + g e_3),   p_Q = p_L - l_0 d,   F R e_3 = m_Q (p_Q'' + g e_3) - λ d
//! ```

use nalgebra::{Rotation3, UnitQuaternion, Vector3, Vector4};
use scenarios::Interpolation;
use scenarios::slung_load::{Cable, Control, GRAVITY_MPS2, Model, State, Trajectory};

/// Distance between nodes, s.
const NODE_S: f64 = 0.01;
/// Step of the finite differences of the attitude, s.
const DELTA_S: f64 = 1e-3;

/// The load moves from rest at `from_m` to rest at `to_m` in `duration_s`, with a deviation of `bow_m` at half time.
pub struct Swing {
    pub from_m: Vector3<f64>,
    pub to_m: Vector3<f64>,
    pub bow_m: Vector3<f64>,
    pub duration_s: f64,
}

/// A value and its first four time derivatives.
type Jet = [Vector3<f64>; 5];

impl Swing {
    /// The plan of the load's path.
    pub fn plan(&self, model: &Model) -> Trajectory {
        let nodes = (self.duration_s / NODE_S).round() as usize;
        let times_s: Vec<f64> = (0..=nodes).map(|k| self.duration_s * k as f64 / nodes as f64).collect();
        Trajectory {
            vehicle: "quad-1".into(),
            interpolation: Interpolation::FirstOrderHold,
            states: times_s.iter().map(|t_s| self.state(model, *t_s)).collect(),
            controls: times_s.iter().map(|t_s| Control { thrust_n: self.thrusts_n(model, *t_s).into() }).collect(),
            cable: vec![Cable::Taut; nodes + 1],
            times_s,
            planner_nodes: vec![],
        }
    }

    fn state(&self, model: &Model, t_s: f64) -> State {
        let load = self.load(t_s);
        let [d, d_rate, _] = cable(&load);
        let attitude = self.attitude(model, t_s);
        let (roll, pitch, yaw) = attitude.euler_angles();
        State {
            position_m: (load[0] - d * model.cable_length_m).into(),
            velocity_mps: (load[1] - d_rate * model.cable_length_m).into(),
            roll_pitch_yaw_rad: [roll, pitch, yaw],
            body_rate_radps: self.body_rate(model, t_s).into(),
            load_position_m: load[0].into(),
            load_velocity_mps: load[1].into(),
        }
    }

    fn thrusts_n(&self, model: &Model, t_s: f64) -> Vector4<f64> {
        let rate = self.body_rate(model, t_s);
        let acceleration =
            (self.body_rate(model, t_s + DELTA_S) - self.body_rate(model, t_s - DELTA_S)) / (2.0 * DELTA_S);
        let inertia = Vector3::from(model.inertia_kgm2);
        let torque = inertia.component_mul(&acceleration) + rate.cross(&inertia.component_mul(&rate));
        let total_n = self.force_n(model, t_s).norm();
        let [l, k] = [model.arm_m, model.torque_per_thrust_m];
        Vector4::repeat(total_n / 4.0)
            + Vector4::new(-1.0, 1.0, 1.0, -1.0) * (torque.x / (4.0 * l))
            + Vector4::new(-1.0, -1.0, 1.0, 1.0) * (torque.y / (4.0 * l))
            + Vector4::new(1.0, -1.0, 1.0, -1.0) * (torque.z / (4.0 * k))
    }

    fn body_rate(&self, model: &Model, t_s: f64) -> Vector3<f64> {
        let turned =
            |ahead_s: f64| (self.attitude(model, t_s).inverse() * self.attitude(model, t_s + ahead_s)).scaled_axis();
        (turned(DELTA_S) * 8.0 - turned(-DELTA_S) * 8.0 - turned(2.0 * DELTA_S) + turned(-2.0 * DELTA_S))
            / (12.0 * DELTA_S)
    }

    fn attitude(&self, model: &Model, t_s: f64) -> UnitQuaternion<f64> {
        let z = self.force_n(model, t_s).normalize();
        let y = z.cross(&Vector3::x()).normalize();
        let x = y.cross(&z);
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_basis_unchecked(&[x, y, z]))
    }

    fn force_n(&self, model: &Model, t_s: f64) -> Vector3<f64> {
        let load = self.load(t_s);
        let [_, _, d_second] = cable(&load);
        let up = Vector3::z() * GRAVITY_MPS2;
        let quadrotor = load[2] - d_second * model.cable_length_m;
        (quadrotor + up) * model.mass_kg + (load[2] + up) * model.load_mass_kg
    }

    /// Position of the load and its derivatives: s(fraction) of degree 13, six derivatives zero at both ends; the bow
    /// is 16 s²(1 - s)².
    fn load(&self, t_s: f64) -> Jet {
        let fraction = (t_s / self.duration_s).clamp(0.0, 1.0);
        let s = smooth_step(fraction).map(Vector3::repeat);
        let mut rest = s.map(|value| -value);
        rest[0].add_scalar_mut(1.0);
        let bow = product(&product(&s, &rest), &product(&s, &rest));
        std::array::from_fn(|order| {
            let path =
                s[order].component_mul(&(self.to_m - self.from_m)) + bow[order].component_mul(&self.bow_m) * 16.0;
            let from_m = if order == 0 { self.from_m } else { Vector3::zeros() };
            from_m + path / self.duration_s.powi(order as i32)
        })
    }
}

/// Direction of the cable and its first two derivatives: d = -(p_L'' + g e_3)/|p_L'' + g e_3|.
fn cable(load: &Jet) -> [Vector3<f64>; 3] {
    let w = load[2] + Vector3::z() * GRAVITY_MPS2;
    let (w1, w2) = (load[3], load[4]);
    let n = w.norm();
    let n1 = w.dot(&w1) / n;
    let n2 = (w1.norm_squared() + w.dot(&w2) - n1 * n1) / n;
    let d = -w / n;
    let d1 = (-w1 - d * n1) / n;
    let d2 = (-w2 - d1 * (2.0 * n1) - d * n2) / n;
    [d, d1, d2]
}

/// Leibniz's rule, component by component.
fn product(a: &Jet, b: &Jet) -> Jet {
    const BINOMIALS: [&[f64]; 5] =
        [&[1.0], &[1.0, 1.0], &[1.0, 2.0, 1.0], &[1.0, 3.0, 3.0, 1.0], &[1.0, 4.0, 6.0, 4.0, 1.0]];
    std::array::from_fn(|order| (0..=order).map(|k| a[k].component_mul(&b[order - k]) * BINOMIALS[order][k]).sum())
}

/// fraction⁷ Σ_k C(6+k, k) C(13, 6-k) (-fraction)^k and its first four derivatives by fraction.
fn smooth_step(fraction: f64) -> [f64; 5] {
    let choose = |n: u32, k: u32| (0..k).fold(1.0, |c, i| c * f64::from(n - i) / f64::from(i + 1));
    let mut jet = [0.0; 5];
    for k in 0..=6_u32 {
        let coefficient = choose(6 + k, k) * choose(13, 6 - k) * if k % 2 == 0 { 1.0 } else { -1.0 };
        for (order, value) in jet.iter_mut().enumerate() {
            let power = 7 + k as i32;
            let falling = (0..order as i32).fold(1.0, |product, i| product * f64::from(power - i));
            *value += coefficient * falling * fraction.powi(power - order as i32);
        }
    }
    jet
}
