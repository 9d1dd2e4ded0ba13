//! Figure 4 of Wang, Xu, Long (2020): operation counts of the three methods over n_X and n_A, beside measured times.

use planners::convex::Backend;

use super::cost::Sizes;
use super::{PAPER_LOOP, Results, Row};
use crate::campaign::bench::log_log_chart::{self, Curve, Panel};

/// Colours of the backends, in the order of [`Backend::ALL`], and that of Clarabel.
const COLOURS: [&str; Backend::ALL.len()] = ["#d55e00", "#0072b2", "#009e73", "#cc79a7"];
const CLARABEL: &str = "#666666";

/// Ratios n_A/n_X of the counts with their dash patterns. It is 2 in the form P4.
const RATIOS: [(f64, &str); 3] = [(1.0, "2 4"), (2.0, ""), (4.0, "8 4")];

/// Numbers n_X of the counts.
const N_X: [f64; 7] = [100.0, 200.0, 500.0, 1000.0, 2000.0, 5000.0, 10_000.0];

/// The figure as an SVG document.
pub fn svg(results: &Results) -> String {
    log_log_chart::svg(&[counts(), times(results)])
}

/// Table 1 over n_X, for several ratios of n_A to n_X.
fn counts() -> Panel {
    let methods = Backend::ALL.into_iter().zip(COLOURS);
    let curves = methods.flat_map(|(backend, colour)| RATIOS.map(|(ratio, dash)| (backend, colour, ratio, dash)));
    let curves = curves.filter_map(|(backend, colour, ratio, dash)| {
        let count =
            |n_x: f64| Some([n_x, Sizes { n_x: n_x as usize, n_a: (ratio * n_x) as usize }.paper_flops(backend)?]);
        let points = N_X.into_iter().map(count).collect::<Option<Vec<_>>>()?;
        let label = if ratio == 1.0 { format!("{}, n_A = n_X", backend.name()) } else { format!("n_A = {ratio} n_X") };
        Some(Curve { label, colour, dash, marked: false, points })
    });
    let title = "Table 1: operations of one iteration".to_owned();
    Panel { title, labels: ["n_X", "floating-point operations"], curves: curves.collect() }
}

/// Measured times of one iteration over n_X: the fastest of the subproblems of each size.
fn times(results: &Results) -> Panel {
    let backends = Backend::ALL.into_iter().zip(COLOURS).map(|(backend, colour)| (backend.name(), colour, ""));
    let solvers =
        backends.chain([(PAPER_LOOP, COLOURS[Backend::SparseLdl as usize], "4 3"), ("clarabel", CLARABEL, "")]);
    let curves = solvers.map(|(solver, colour, dash)| Curve {
        label: solver.to_owned(),
        colour,
        dash,
        marked: true,
        points: fastest(results.rows.iter().filter(|row| row.solver == solver)),
    });
    let title = "measured: time of one iteration".to_owned();
    Panel { title, labels: ["n_X", "µs"], curves: curves.filter(|curve| !curve.points.is_empty()).collect() }
}

/// n_X and time per iteration, µs; of the subproblems with one number of intervals the fastest.
fn fastest<'a>(rows: impl Iterator<Item = &'a Row>) -> Vec<[f64; 2]> {
    let mut points: Vec<(usize, [f64; 2])> = Vec::new();
    for row in rows {
        let Some(measured) = &row.measured else { continue };
        let point = [row.sizes.n_x as f64, measured.time_per_iteration_us];
        match points.last_mut() {
            Some((intervals, last)) if *intervals == row.intervals => {
                if point[1] < last[1] {
                    *last = point;
                }
            }
            _ => points.push((row.intervals, point)),
        }
    }
    points.into_iter().map(|(_, point)| point).collect()
}
