//! The plan as a continuous motion: its thrusts integrated with the judge's equations, restarted at every node.

use rayon::prelude::*;
use scenarios::slung_load::{Cable, Trajectory};
use scenarios::{Interpolation, Plan, Scenario};
use sim::slung_load::{Knot, Plant, SlungLoadState, impact, propagate};

use super::motion::{MotionSample, SlungLoadMotion};
use crate::verdict::compare::{exceeds, is_larger};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{self, Motion};

/// Largest integration step, and largest time between two samples, s.
const MAX_STEP_S: f64 = 0.005;
/// A defect is accumulated over at least this time, s, or until the next switch of the cable, so that dense sampling does not
/// make it small.
const WINDOW_S: f64 = 0.1;
/// Smallest time between the beginnings of two windows, s.
const MIN_WINDOW_SHIFT_S: f64 = 0.001;

/// The motion that results from a plan's thrusts.
#[derive(Clone, Debug)]
pub struct PlannedMotion {
    /// Quadrotor and load. At every node they jump from where the interval before it ends to the node itself.
    pub motion: SlungLoadMotion,
    /// The quadrotor's centre, and the load's.
    pub motions: [Motion; 2],
    /// Its samples with thrust and tension.
    pub knots: Vec<Knot>,
    /// Differences between the nodes and the motion that leads to them.
    pub defects: Vec<Defect>,
    /// Times, s, and impulses, N s, of the impacts.
    pub impacts: Vec<(f64, f64)>,
}

/// The difference between a node and the motion that the thrusts cause from an earlier node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defect {
    /// Time of the node, s.
    pub t_s: f64,
    /// The largest of the differences in position, in velocity times the time between the nodes (at least the window), and in
    /// attitude and body rate at the end of a rotor's arm, m.
    pub defect_m: f64,
}

impl PlannedMotion {
    /// Integrates the flyable plan of the scenario's one vehicle.
    ///
    /// # Errors
    ///
    /// The plan takes longer than is simulated, or its thrusts lead to values that cannot be judged.
    pub fn new(scenario: &Scenario, plan: &Plan) -> Result<Self, MissingEvidence> {
        let max_s = scenario.simulation.max_duration_s;
        if let Some(duration_s) = plan.flight_time_s().filter(|&duration_s| exceeds(duration_s, max_s)) {
            return Err(MissingEvidence::PlanTooLong { duration_s, max_s });
        }
        let model = scenario.slung_load_model(&scenario.vehicles[0]);
        let plant = Plant::nominal(model, scenario.world.ground_m);
        let trajectory = plan.trajectories[0].slung_load();
        let intervals = trajectory.times_s.len() - 1;
        let knots: Vec<Knot> = (0..intervals).flat_map(|interval| integrated(trajectory, &plant, interval)).collect();
        let samples = knots.iter().map(|knot| MotionSample { t_s: knot.t_s, body: knot.state }).collect();
        let motion = SlungLoadMotion::new(samples).sampled();
        let motions = motions(&trajectory.vehicle, motion.samples())?;
        let defects = defects(trajectory, &plant);
        let impacts = impacts(trajectory, &plant);
        Ok(Self { motion, motions, knots, defects, impacts })
    }
}

/// The motions of quadrotor and load through these samples.
///
/// # Errors
///
/// See [`Motion::new`].
pub fn motions(vehicle: &str, samples: &[MotionSample]) -> Result<[Motion; 2], MissingEvidence> {
    let knot = |t_s: f64, position: nalgebra::Vector3<f64>, velocity: nalgebra::Vector3<f64>| motion::Knot {
        t_s,
        position_m: position.into(),
        velocity_mps: velocity.into(),
    };
    let quadrotor = |at: &MotionSample| knot(at.t_s, at.body.position_m, at.body.velocity_mps);
    let load = |at: &MotionSample| knot(at.t_s, at.body.load_position_m, at.body.load_velocity_mps);
    Ok([
        Motion::new(vehicle, samples.iter().map(quadrotor).collect())?,
        Motion::new(&format!("the load of {vehicle}"), samples.iter().map(load).collect())?,
    ])
}

/// The motion of one interval; only its first node if the interval has no duration.
fn integrated(trajectory: &Trajectory, plant: &Plant, interval: usize) -> Vec<Knot> {
    let mut knots = integrated_from(&SlungLoadState::from(&trajectory.states[interval]), trajectory, plant, interval);
    if trajectory.times_s[interval + 1] <= trajectory.times_s[interval] {
        // Thrusts that jump when the cable becomes slack never act while it is taut.
        knots.truncate(1);
    }
    knots
}

fn integrated_from(start: &SlungLoadState, trajectory: &Trajectory, plant: &Plant, interval: usize) -> Vec<Knot> {
    let Interpolation::FirstOrderHold = trajectory.interpolation;
    let controls = [&trajectory.controls[interval], &trajectory.controls[interval + 1]];
    let times_s = [trajectory.times_s[interval], trajectory.times_s[interval + 1]];
    propagate(plant, start, controls, trajectory.cable[interval], times_s, MAX_STEP_S)
}

/// The largest defect of every window.
fn defects(trajectory: &Trajectory, plant: &Plant) -> Vec<Defect> {
    let starts = window_starts(trajectory);
    let intervals: Vec<usize> = (0..starts.len()).filter(|interval| starts[*interval]).collect();
    intervals.into_par_iter().map(|interval| largest_defect(trajectory, plant, interval, &starts)).collect()
}

/// Whether a window begins with an interval: after a switch of the cable, and if the window before it began early enough. To
/// begin one with every node of a dense plan would take time with the square of its density.
fn window_starts(trajectory: &Trajectory) -> Vec<bool> {
    let Trajectory { times_s, cable, .. } = trajectory;
    let mut last_s = f64::NEG_INFINITY;
    let starts = |interval: usize| {
        let switches = interval > 0 && cable[interval] != cable[interval - 1];
        let starts = switches || times_s[interval] - last_s >= MIN_WINDOW_SHIFT_S;
        if starts {
            last_s = times_s[interval];
        }
        starts
    };
    (0..times_s.len() - 1).map(starts).collect()
}

/// The largest defect in the window that begins with an interval: at its end, and at the nodes in it with which no window
/// begins. If the cable becomes taut, the impact is part of the motion.
fn largest_defect(trajectory: &Trajectory, plant: &Plant, first: usize, starts: &[bool]) -> Defect {
    let (times_s, last) = (&trajectory.times_s, trajectory.times_s.len() - 1);
    let mut body = SlungLoadState::from(&trajectory.states[first]);
    let (mut end, mut largest) = (first, None::<Defect>);
    loop {
        let knots = integrated_from(&body, trajectory, plant, end);
        body = knots[knots.len() - 1].state;
        end += 1;
        let switches = trajectory.cable[end] != trajectory.cable[end - 1];
        if becomes_taut(trajectory, end) {
            body = impact(plant, &body).0;
        }
        let is_end = end == last || switches || times_s[end] - times_s[first] >= WINDOW_S;
        if is_end || !starts[end] {
            let window_s = (times_s[end] - times_s[first]).max(WINDOW_S);
            let node = SlungLoadState::from(&trajectory.states[end]);
            let found = Defect { t_s: times_s[end], defect_m: difference_m(plant, &body, &node, window_s) };
            largest = largest.filter(|largest| !is_larger(found.defect_m, largest.defect_m)).or(Some(found));
        }
        if let (true, Some(largest)) = (is_end, largest) {
            return largest;
        }
    }
}

fn becomes_taut(trajectory: &Trajectory, node: usize) -> bool {
    (trajectory.cable[node - 1], trajectory.cable[node]) == (Cable::Slack, Cable::Taut)
}

fn difference_m(plant: &Plant, a: &SlungLoadState, b: &SlungLoadState, window_s: f64) -> f64 {
    let differences = [
        (a.position_m - b.position_m).norm(),
        (a.load_position_m - b.load_position_m).norm(),
        (a.velocity_mps - b.velocity_mps).norm() * window_s,
        (a.load_velocity_mps - b.load_velocity_mps).norm() * window_s,
        a.attitude.angle_to(&b.attitude) * plant.arm_m,
        (a.body_rate_radps - b.body_rate_radps).norm() * plant.arm_m * window_s,
    ];
    differences.into_iter().reduce(|worst, value| if exceeds(value, worst) { value } else { worst }).unwrap_or(f64::NAN)
}

/// Times at which the planned cable becomes taut, s, and the impulses by the judge's equations, N s.
fn impacts(trajectory: &Trajectory, plant: &Plant) -> Vec<(f64, f64)> {
    let nodes = (1..trajectory.times_s.len()).filter(|node| becomes_taut(trajectory, *node));
    let impulse = |node: usize| {
        let knots = integrated(trajectory, plant, node - 1);
        (trajectory.times_s[node], impact(plant, &knots[knots.len() - 1].state).1)
    };
    nodes.map(impulse).collect()
}
