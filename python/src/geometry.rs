//! What every planner needs: distances to the world, cubics through knots, closest approach.

use harness::verdict::{self, Knot, Motion};
use pyo3::buffer::PyBuffer;
use pyo3::prelude::*;
use pyo3::types::PyByteArray;
use scenarios::SeparationMeasure;
use sim::Obstacles;

use crate::arrays::{bytes, numbers, triples};
use crate::error::invalid;
use crate::scenario::Scenario;

/// Half the length over which a distance is differentiated, m: its error is of the order of 1e-9.
const DIFFERENCE_M: f64 = 1e-5;

/// Distances, gradients and obstacles, the first two as bytes.
type Distances<'py> = (Bound<'py, PyByteArray>, Bound<'py, PyByteArray>, Vec<String>);

/// Signed distance of points to the nearest obstacle, its gradient, and the obstacle's name; empty without obstacles.
#[pyfunction]
pub fn distances<'py>(
    py: Python<'py>,
    scenario: &Scenario,
    points_m: &Bound<'py, PyAny>,
    t_s: f64,
) -> PyResult<Distances<'py>> {
    let points_m = triples(py, "points", &PyBuffer::get(points_m)?)?;
    let obstacles = Obstacles::new(&scenario.scenario.world);
    let found: Vec<(f64, [f64; 3], String)> =
        py.detach(|| points_m.iter().map(|point_m| nearest(&obstacles, t_s, *point_m)).collect());
    let (mut distances_m, mut gradients, mut names) = (Vec::new(), Vec::new(), Vec::new());
    for (distance_m, gradient, name) in found {
        distances_m.push(distance_m);
        gradients.extend(gradient);
        names.push(name);
    }
    Ok((bytes(py, distances_m), bytes(py, gradients), names))
}

fn nearest(obstacles: &Obstacles, t_s: f64, point_m: [f64; 3]) -> (f64, [f64; 3], String) {
    let distance_m = |obstacle: usize| obstacles.distance_m(obstacle, t_s, point_m);
    let all = (0..obstacles.count()).map(|obstacle| (distance_m(obstacle), obstacle));
    let Some((nearest_m, obstacle)) = all.min_by(|a, b| a.0.total_cmp(&b.0)) else {
        return (f64::INFINITY, [0.0; 3], String::new());
    };
    let gradient = std::array::from_fn(|axis| {
        let [above, below] = [DIFFERENCE_M, -DIFFERENCE_M].map(|step_m| {
            let mut moved_m = point_m;
            moved_m[axis] += step_m;
            obstacles.distance_m(obstacle, t_s, moved_m)
        });
        (above - below) / (2.0 * DIFFERENCE_M)
    });
    (nearest_m, gradient, obstacles.name(obstacle).to_owned())
}

/// Positions and velocities of the cubics through knots at times, as bytes; NaN outside of the knots.
#[pyfunction]
pub fn hermite<'py>(
    py: Python<'py>,
    knots: [Bound<'py, PyAny>; 3],
    times_s: &Bound<'py, PyAny>,
) -> PyResult<[Bound<'py, PyByteArray>; 2]> {
    let motion = motion(py, "knots", &knots)?;
    let times_s = numbers(py, &PyBuffer::get(times_s)?)?;
    let nowhere = Knot { t_s: f64::NAN, position_m: [f64::NAN; 3], velocity_mps: [f64::NAN; 3] };
    let states: Vec<Knot> = times_s.iter().map(|t_s| motion.state(*t_s).unwrap_or(nowhere)).collect();
    Ok([
        bytes(py, states.iter().flat_map(|state| state.position_m)),
        bytes(py, states.iter().flat_map(|state| state.velocity_mps)),
    ])
}

/// Bounds of the smallest distance of two motions over continuous time, m, and its time, s; `None` if they never exist at
/// the same time.
#[pyfunction]
pub fn closest_approach<'py>(
    py: Python<'py>,
    first: [Bound<'py, PyAny>; 3],
    second: [Bound<'py, PyAny>; 3],
    horizontal: bool,
) -> PyResult<Option<(f64, f64, f64)>> {
    let motions = [motion(py, "first", &first)?, motion(py, "second", &second)?];
    let measure = if horizontal { SeparationMeasure::Horizontal } else { SeparationMeasure::Spatial };
    let found = py.detach(|| verdict::closest_vehicles(&motions, measure));
    Ok(found.map(|approach| (approach.lower_m, approach.upper_m, approach.at_s)))
}

/// A motion from times, positions and velocities.
fn motion(py: Python<'_>, name: &str, [times, positions, velocities]: &[Bound<'_, PyAny>; 3]) -> PyResult<Motion> {
    let mut knots = Vec::new();
    fill(py, name, [times, positions, velocities], &mut knots)?;
    Motion::new(name, knots).map_err(|missing| invalid(missing.to_string()))
}

/// Replaces `knots` by those of three arrays.
pub fn fill(py: Python<'_>, name: &str, arrays: [&Bound<'_, PyAny>; 3], knots: &mut Vec<Knot>) -> PyResult<()> {
    let [times, positions, velocities] = arrays;
    let times_s = numbers(py, &PyBuffer::get(times)?)?;
    let positions_m = triples(py, name, &PyBuffer::get(positions)?)?;
    let velocities_mps = triples(py, name, &PyBuffer::get(velocities)?)?;
    if times_s.len() != positions_m.len() || times_s.len() != velocities_mps.len() {
        return Err(invalid(format!(
            "{name}: found {} times, {} positions and {} velocities, expected as many of each",
            times_s.len(),
            positions_m.len(),
            velocities_mps.len()
        )));
    }
    knots.clear();
    let rows = times_s.into_iter().zip(positions_m).zip(velocities_mps);
    knots.extend(rows.map(|((t_s, position_m), velocity_mps)| Knot { t_s, position_m, velocity_mps }));
    Ok(())
}
