//! Maps, and an ideal vehicle on them: a double integrator that does exactly what it is told.

use planners::free_space::vector::{Point, distance};
use planners::free_space::{FreeSpace, Obstacle};
use planners::horizon::cost_map::Ways;
use planners::horizon::motion::{Motion, State};
use planners::horizon::optimise::Budget;
use planners::horizon::pilot::{Charge, Decision, Options, Pilot, Replan};
use planners::horizon::question::{Grid, Limits};
use planners::horizon::sampler::{Method, Swarm};
use rand::RngExt;

/// A map with a way through it.
pub struct Arena {
    pub space: FreeSpace,
    pub start: Point,
    pub goal: Point,
    /// Altitudes for nodes of the cost maps.
    pub levels_m: Vec<f64>,
}

const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

fn block([x, y]: [f64; 2], [width, height]: [f64; 2], altitude_m: [f64; 2]) -> Obstacle {
    let corners = [[x, y], [x + width, y], [x + width, y + height], [x, y + height]];
    Obstacle::prism(&corners, altitude_m)
}

/// Ten boxes and a trap that opens towards the start, in a frame of 54 m by 27 m.
pub fn trap() -> Arena {
    let mut space = FreeSpace::empty([[-27.0, 27.0], [-15.0, 12.0], UNBOUNDED]);
    let corners = [
        [16.0, 4.0],
        [15.0, -9.0],
        [8.0, 7.0],
        [9.0, -13.0],
        [1.0, -11.0],
        [-1.0, 8.0],
        [-8.0, -12.0],
        [-9.0, 5.0],
        [-17.0, -9.0],
        [-18.0, 3.0],
    ];
    space.standing.extend(corners.map(|corner| block(corner, [3.0, 3.0], UNBOUNDED)));
    for (corner, size) in [([-3.0, -5.0], [1.0, 9.0]), ([-2.0, -5.0], [8.0, 1.0]), ([-2.0, 3.0], [8.0, 1.0])] {
        space.standing.push(block(corner, size, UNBOUNDED));
    }
    Arena { space, start: [25.0, 0.0, 1.0], goal: [-25.0, -3.0, 1.0], levels_m: vec![1.0] }
}

/// Boxes and cylinders anywhere, in the plane or, with tops and bottoms, in space.
pub fn random(seed: u64, in_space: bool) -> Arena {
    let mut stream = scenarios::stream(seed, "arena");
    let altitudes = if in_space { [0.0, 10.0] } else { UNBOUNDED };
    let mut space = FreeSpace::empty([[-20.0, 20.0], [-12.0, 12.0], altitudes]);
    let (start, goal) = ([17.0, 0.0, 2.0], [-17.0, -3.0, 3.0]);
    let goal = if in_space { goal } else { [goal[0], goal[1], start[2]] };
    while space.standing.len() < 14 {
        let mut draw = |from: f64, to: f64| stream.random_range(from..to);
        let at = [draw(-14.0, 13.0), draw(-12.0, 11.0)];
        let size = [draw(0.5, 4.0), draw(0.5, 4.0)];
        let altitude_m = if in_space { [draw(-4.0, 2.0), draw(3.0, 12.0)] } else { UNBOUNDED };
        let obstacle = if draw(0.0, 1.0) < 0.7 {
            block(at, size, altitude_m)
        } else {
            Obstacle::cylinder(at, 0.5 * size[0], altitude_m)
        };
        if obstacle.distance_m(start).min(obstacle.distance_m(goal)) > 2.0 {
            space.standing.push(obstacle);
        }
    }
    Arena { space, start, goal, levels_m: if in_space { vec![2.0, 3.0, 5.0, 8.0] } else { vec![2.0] } }
}

pub const LIMITS: Limits = Limits { speed_mps: 3.0, acceleration_mps2: 3.0 };

/// The swarm of eq. 13 and 14, with eq. 15 if asked for.
pub fn swarm(by_violation: bool) -> Method {
    Method::Swarm(if by_violation { Swarm::FEASIBILITY } else { Swarm::USUAL })
}

/// Our rules.
pub fn ours(method: Method, ways: Ways, axes: usize) -> Options {
    Options {
        method,
        budget: Budget { particles: 40, iterations: 60, stall: None },
        charge: Charge::Map(ways, None),
        grid: Grid { steps: 12, axes },
        step_s: 0.25,
        limits: LIMITS,
        clearance_m: 0.4,
        smoothness: 1e-2,
        stage_weight: 1.0,
        starts_warm: true,
        is_projected: true,
        stops: true,
        costs_infeasible: false,
        known_within_m: f64::INFINITY,
    }
}

/// The paper's rules.
pub fn paper(by_violation: bool, charge: Charge) -> Options {
    let ours = ours(swarm(by_violation), Ways::Visibility, 2);
    Options {
        charge,
        starts_warm: false,
        is_projected: false,
        stops: false,
        smoothness: 0.0,
        stage_weight: 1.0,
        ..ours
    }
}

/// What a flight was like.
#[derive(Debug)]
pub struct Flight {
    pub arrived_s: Option<f64>,
    pub length_m: f64,
    pub replans: Vec<Replan>,
    /// Smallest distance to anything on the way.
    pub clearance_m: f64,
    pub wall_s: f64,
}

/// Flies from rest; what is farther from the vehicle than `range_m` is not known until it has been seen.
pub fn fly(arena: &Arena, options: &Options, seed: u64, range_m: f64, limit_s: f64) -> Flight {
    let stream = scenarios::stream(seed, "horizon");
    let mut pilot = Pilot::new(options.clone(), arena.goal, arena.levels_m.clone(), stream);
    let mut known = FreeSpace { standing: Vec::new(), ..arena.space.clone() };
    let mut unknown = arena.space.standing.clone();
    let mut motion = Motion::from(State::at_rest(arena.start));
    let mut flight =
        Flight { arrived_s: None, length_m: 0.0, replans: Vec::new(), clearance_m: f64::INFINITY, wall_s: 0.0 };
    let mut applied = [0.0; 3];
    while flight.replans.len() as f64 * options.step_s < limit_s {
        let state = motion.state_at(0.0);
        let (seen, rest) = unknown.into_iter().partition(|obstacle| obstacle.distance_m(state.position) <= range_m);
        unknown = rest;
        known.standing.extend::<Vec<_>>(seen);
        let begin = std::time::Instant::now();
        let replan = pilot.replan(state, &motion, applied, &known);
        flight.wall_s += begin.elapsed().as_secs_f64();
        if let Decision::Fly(new) = &replan.decision {
            motion = new.clone();
        }
        flight.replans.push(replan);
        for tick in 0..20 {
            let [here, next] =
                [tick, tick + 1].map(|tick| motion.state_at(options.step_s * f64::from(tick) / 20.0).position);
            flight.length_m += distance(here, next);
            flight.clearance_m = flight.clearance_m.min(arena.space.distance_m(here));
        }
        applied = motion.mean_accelerations(0.0, options.step_s, 1)[0];
        motion = motion.rest_from(options.step_s);
        let now = motion.state_at(0.0);
        if distance(now.position, arena.goal) < 0.3 && distance(now.velocity, [0.0; 3]) < 0.3 {
            flight.arrived_s = Some(flight.replans.len() as f64 * options.step_s);
            break;
        }
    }
    flight
}
