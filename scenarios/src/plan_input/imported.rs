use super::ColumnTable;
use crate::slung_load::{Cable, Trajectory};
use crate::{Family, Interpolation, fixed_wing, multirotor, slung_load};

/// The planned motion of one vehicle as far as it was given.
#[derive(Clone, Debug, PartialEq)]
pub enum ImportedTrajectory {
    /// Of a fixed wing: what is missing can be reconstructed.
    FixedWing(PartialTrajectory),
    /// Of a quadrotor with a load: whole.
    SlungLoad(Trajectory),
    /// Of a multirotor: whole.
    Multirotor(multirotor::Trajectory),
}

/// The planned motion of one fixed-wing aircraft: velocities and controls complete at every node, or not at all.
#[derive(Clone, Debug, PartialEq)]
pub struct PartialTrajectory {
    /// Name of the vehicle.
    pub vehicle: String,
    /// Times of the nodes, s, from 0, increasing.
    pub times_s: Vec<f64>,
    /// Positions at the nodes, m.
    pub positions_m: Vec<[f64; 3]>,
    /// States at the nodes, if velocities were given.
    pub states: Option<Vec<fixed_wing::State>>,
    /// Controls at the nodes, if they were given.
    pub controls: Option<Vec<fixed_wing::Control>>,
}

impl ImportedTrajectory {
    /// From a track whose columns have been checked: each complete group of columns becomes what it stands for.
    pub(super) fn of(track: &ColumnTable, family: Family) -> Self {
        match family {
            Family::FixedWing => Self::FixedWing(PartialTrajectory::of(track)),
            Family::SlungLoad => Self::SlungLoad(slung_load_trajectory(track)),
            Family::Multirotor => Self::Multirotor(multirotor_trajectory(track)),
        }
    }

    /// Position at the first node, m.
    pub fn first_position_m(&self) -> [f64; 3] {
        match self {
            Self::FixedWing(track) => track.positions_m[0],
            Self::SlungLoad(trajectory) => trajectory.states[0].position_m,
            Self::Multirotor(trajectory) => trajectory.states[0].position_m,
        }
    }
}

impl PartialTrajectory {
    fn of(track: &ColumnTable) -> Self {
        let positions_m: Vec<[f64; 3]> = rows(track, ["x_m", "y_m", "z_m"]).unwrap_or_default();
        let polar = rows(track, ["speed_mps", "heading_rad", "flight_path_rad"]);
        let cartesian = || rows(track, ["vx_mps", "vy_mps", "vz_mps"]);
        let states = match polar {
            Some(polar) => Some(polar_states(&positions_m, &polar)),
            None => cartesian().map(|velocities_mps| states_from_velocities(&positions_m, &velocities_mps)),
        };
        let controls = rows(track, ["n_x", "n_y", "n_z"]);
        let controls = controls.map(|rows| rows.into_iter().map(fixed_wing::Control::from_array).collect());
        Self { vehicle: track.vehicle.clone(), times_s: track.times_s.clone(), positions_m, states, controls }
    }
}

fn slung_load_trajectory(track: &ColumnTable) -> Trajectory {
    let columns = slung_load::CSV_COLUMNS;
    let nodes = 0..track.times_s.len();
    let value = |column: usize, node: usize| track.columns.get(columns[column]).map_or(f64::NAN, |values| values[node]);
    let state = |node: usize| slung_load::State::from_array(std::array::from_fn(|i| value(2 + i, node)));
    let control = |node: usize| slung_load::Control { thrust_n: std::array::from_fn(|i| value(20 + i, node)) };
    let cable = |node: usize| if value(24, node) == 0.0 { Cable::Slack } else { Cable::Taut };
    Trajectory {
        vehicle: track.vehicle.clone(),
        interpolation: Interpolation::FirstOrderHold,
        times_s: track.times_s.clone(),
        states: nodes.clone().map(state).collect(),
        controls: nodes.clone().map(control).collect(),
        cable: nodes.map(cable).collect(),
        planner_nodes: track.planner_nodes.clone(),
    }
}

fn multirotor_trajectory(track: &ColumnTable) -> multirotor::Trajectory {
    let positions_m = rows(track, ["x_m", "y_m", "z_m"]).unwrap_or_default();
    let velocities_mps = rows(track, ["vx_mps", "vy_mps", "vz_mps"]).unwrap_or_default();
    let states = positions_m.into_iter().zip(velocities_mps);
    multirotor::Trajectory {
        vehicle: track.vehicle.clone(),
        times_s: track.times_s.clone(),
        states: states.map(|(position_m, velocity_mps)| multirotor::State { position_m, velocity_mps }).collect(),
    }
}

/// States from positions and world-frame velocities at the same nodes, m and m/s; headings without jumps of 2π.
pub fn states_from_velocities(positions_m: &[[f64; 3]], velocities_mps: &[[f64; 3]]) -> Vec<fixed_wing::State> {
    let polar: Vec<[f64; 3]> = velocities_mps
        .iter()
        .map(|[x, y, z]| {
            let horizontal = x.hypot(*y);
            [horizontal.hypot(*z), y.atan2(*x), z.atan2(horizontal)]
        })
        .collect();
    polar_states(positions_m, &polar)
}

fn polar_states(positions_m: &[[f64; 3]], polar: &[[f64; 3]]) -> Vec<fixed_wing::State> {
    let mut states: Vec<fixed_wing::State> = Vec::with_capacity(polar.len());
    for ([x_m, y_m, z_m], [speed_mps, heading_rad, flight_path_rad]) in positions_m.iter().zip(polar) {
        let heading_rad = states.last().map_or(*heading_rad, |last| near(*heading_rad, last.heading_rad));
        let state = [*x_m, *y_m, *z_m, *speed_mps, heading_rad, *flight_path_rad];
        states.push(fixed_wing::State::from_array(state));
    }
    states
}

/// `angle_rad` plus the whole number of turns that brings it within half a turn of `last_rad`.
fn near(angle_rad: f64, last_rad: f64) -> f64 {
    let turns = ((last_rad - angle_rad) / std::f64::consts::TAU).round();
    if turns == 0.0 { angle_rad } else { angle_rad + turns * std::f64::consts::TAU }
}

/// Three columns as one triple per row; `None` if one of them is missing.
fn rows(track: &ColumnTable, names: [&str; 3]) -> Option<Vec<[f64; 3]>> {
    let [a, b, c] = names.map(|name| track.columns.get(name));
    let (a, b, c) = (a?, b?, c?);
    Some((0..track.times_s.len()).map(|row| [a[row], b[row], c[row]]).collect())
}
