use rayon::prelude::*;
use scenarios::fixed_wing::{Control, Limits, PartialTrajectory, State, states_from_velocities};
use scenarios::plan_input::{ImportedTrajectory, PlanHeader};
use scenarios::{Range, Scenario};
use sim::fixed_wing::propagate;

use super::*;
use crate::plan_source::plan_import::complete;
use crate::verdict::fixed_wing::PlannedMotions;
use crate::verdict::random::Uniform;

const PAIR: &str = include_str!("../../../../tests/scenarios/pair.toml");

fn scenario() -> Scenario {
    scenarios::parse("pair.toml", PAIR).expect("the smallest fleet")
}

/// A motion that keeps its limits, every 50 ms or more often, and the indices of the rows in it.
struct Admissible {
    knots: Vec<sim::fixed_wing::Knot>,
    rows: Vec<usize>,
}

impl Admissible {
    /// - `intervals`: number of intervals between rows, each up to `longest_s`
    fn random(uniform: &mut Uniform, start: State, limits: &Limits, intervals: usize, longest_s: f64) -> Self {
        let mut motion = Self { knots: Vec::new(), rows: vec![0] };
        let (mut state, mut t_s) = (start, 0.0);
        for _ in 0..intervals {
            let end_s = t_s + longest_s * uniform.between(0.02, 1.0);
            while t_s < end_s {
                let step_s = uniform.between(0.05, 1.0).min(end_s - t_s);
                let control = control(uniform, &state, limits);
                let flown = propagate(&state, [control, control], t_s, step_s, 0.05);
                let end = flown[flown.len() - 1];
                state = states_from_velocities(&[end.position_m.into()], &[end.velocity_mps.into()])[0];
                t_s = if step_s == end_s - t_s { end_s } else { t_s + step_s };
                motion.knots.extend(flown);
            }
            motion.rows.push(motion.knots.len() - 1);
        }
        motion
    }

    /// The rows as a plan.
    fn table(&self, with_velocities: bool) -> PartialTrajectory {
        let rows: Vec<_> = self.rows.iter().map(|row| self.knots[*row]).collect();
        let positions_m: Vec<[f64; 3]> = rows.iter().map(|row| row.position_m.into()).collect();
        let velocities_mps: Vec<[f64; 3]> = rows.iter().map(|row| row.velocity_mps.into()).collect();
        let states = with_velocities.then(|| states_from_velocities(&positions_m, &velocities_mps));
        let times_s = rows.iter().map(|row| row.t_s).collect();
        PartialTrajectory { vehicle: "uav-1".to_owned(), times_s, positions_m, states, controls: None }
    }
}

/// Load factors anywhere in their limits, mostly at the ends, that keep speed and flight-path angle inside theirs.
fn control(uniform: &mut Uniform, state: &State, limits: &Limits) -> Control {
    let mut pick = |Range { min, max }: Range| match uniform.between(0.0, 3.0) {
        low if low < 1.0 => min,
        high if high < 2.0 => max,
        _ => uniform.between(min, max),
    };
    let [mut n_x, n_y, mut n_z] = limits.controls().map(&mut pick);
    let flight_path_deg = state.flight_path_rad.to_degrees();
    // A second at the largest load factor turns the path by less than this at the slowest speed.
    let reserve_deg = (GRAVITY_MPS2 * 0.7 / limits.speed_mps.min).to_degrees();
    if flight_path_deg > limits.flight_path_deg.max - reserve_deg {
        n_z = limits.n_z.min;
    } else if flight_path_deg < limits.flight_path_deg.min + reserve_deg {
        n_z = limits.n_z.max;
    }
    if state.speed_mps > limits.speed_mps.max - 12.0 {
        n_x = limits.n_x.min;
    } else if state.speed_mps < limits.speed_mps.min + 12.0 {
        n_x = limits.n_x.max;
    }
    Control { n_x, n_y, n_z }
}

/// How much of its tube the motion uses at most, in position and velocity: 1 at its surface.
fn used(scenario: &Scenario, motion: &Admissible, with_velocities: bool) -> [f64; 2] {
    let table = motion.table(with_velocities);
    let completed = complete(scenario, PlanHeader::default(), vec![ImportedTrajectory::Partial(table)], "theirs", 0);
    let planned = PlannedMotions::new(scenario, &completed.plan).expect("a finite plan");
    let limits = &scenario.fixed_wing_model(&scenario.vehicles[0]).limits;
    let trajectory = completed.plan.trajectories[0].fixed_wing();
    let given = completed.provenance.given(0);
    let tube = RowTube::around(&planned.motions[0], trajectory, given, None, trajectory.states.len() - 1, limits).tube;
    assert!(tube.has_width(), "nothing was reconstructed");
    let mut largest = [0.0_f64; 2];
    for knot in &motion.knots {
        let found_m = planned.motions[0].position_m(knot.t_s).expect("a time of the plan");
        let apart_m = distance(found_m, knot.position_m.into());
        let radius_m = tube.distance_m([knot.t_s; 2]) + planned.motions[0].deviation_m() + 1e-6;
        largest[0] = larger(largest[0], apart_m / radius_m);
    }
    for row in planned.motions[0].knots() {
        let nearest = motion.knots.iter().filter(|knot| (knot.t_s - row.t_s).abs() < 1e-9);
        for knot in nearest {
            let apart_mps = distance(row.velocity_mps, knot.velocity_mps.into());
            largest[1] = larger(largest[1], apart_mps / (tube.velocity_mps(row.t_s) + 1e-6));
        }
    }
    largest
}

/// 10⁵ intervals of admissible motions: whatever the vehicle does between its rows, it stays in the tube around what is
/// reconstructed from them.
#[test]
fn admissible_motions_stay_in_the_tube() {
    let scenario = scenario();
    let limits = &scenario.fixed_wing_model(&scenario.vehicles[0]).limits;
    let start = scenario.vehicles[0].start.fixed_wing_state();
    let most = (0..12_500_u64)
        .into_par_iter()
        .map(|seed| {
            let mut uniform = Uniform::seeded(seed);
            let longest_s = [0.5, 2.0, 8.0][seed as usize % 3];
            let motion = Admissible::random(&mut uniform, start, limits, 8, longest_s);
            let used = used(&scenario, &motion, seed % 2 == 0);
            assert!(used.iter().all(|used| *used <= 1.0), "{used:?} with seed {seed}");
            used
        })
        .reduce(|| [0.0; 2], |a, b| [larger(a[0], b[0]), larger(a[1], b[1])]);
    assert!(most[0] > 0.3 && most[1] > 0.2, "the tube is needlessly wide: {most:?}");
}

/// Along the path gravity helps: down the steepest descent with full thrust, or up the steepest climb with full drag.
#[test]
fn the_largest_acceleration_is_that_of_the_worst_attitude() {
    let scenario = scenario();
    let limits = Limits {
        flight_path_deg: Range::new(-30.0, 10.0),
        n_x: Range::new(-0.1, 0.4),
        n_y: Range::new(-0.2, 0.5),
        n_z: Range::new(0.7, 1.6),
        ..scenario.fixed_wing_model(&scenario.vehicles[0]).limits.clone()
    };
    let (along, across, upwards) = (0.4 + 0.5, 0.5, 1.6 - 30.0_f64.to_radians().cos());
    let expected = 9.81 * f64::sqrt(along * along + across * across + upwards * upwards);
    assert!((max_acceleration_mps2(&limits) - expected).abs() < 1e-9);
    let mirrored = Limits {
        flight_path_deg: Range::new(-10.0, 50.0),
        n_x: Range::new(-0.6, 0.1),
        n_y: Range::new(-0.5, 0.2),
        n_z: Range::new(-0.5, 1.1),
        ..limits
    };
    let (along, upwards) = (50.0_f64.to_radians().sin() + 0.6, 1.5);
    let expected = 9.81 * f64::sqrt(along * along + across * across + upwards * upwards);
    assert!((max_acceleration_mps2(&mirrored) - expected).abs() < 1e-9);
}
