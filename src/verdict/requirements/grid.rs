//! Robustness over continuous time, bounded on a grid of cells that is refined where it matters.
//!
//! On every cell a predicate has bounds for all instants of the cell. Conjunction and disjunction take the smaller and the
//! larger bounds; a window of time takes them over the cells that it may meet (for the bound on one side) and over those
//! that it meets from every instant of the cell (for the other). The robustness of the formula is the value of one predicate
//! at one instant, so that values outside the bounds known of it do not matter: a cell is halved only if its bounds
//! still overlap them, and if no operator above makes it irrelevant.
//!
//! Fainekos, Pappas (2009), Robustness of temporal logic specifications for continuous-time signals, Theor. Comput. Sci. 410.

mod windows;

use std::ops::Range;

use scenarios::requirement::Clause;

use crate::verdict::requirements::instance::Instance;
use crate::verdict::requirements::interval::Interval;
use windows::Windows;

/// The bounds are refined until they are this close, in the unit of the predicate; relative for values above 1.
pub const TOLERANCE: f64 = 1e-6;
/// The first cells, the largest number of cells, and the shortest one, s. Beyond them the bounds stay apart.
const FIRST_CELLS: usize = 32;
const MAX_CELLS: usize = 1 << 15;
const MIN_CELL_S: f64 = 1e-10;
/// The largest number of cells looked at, over all rounds of refinement. Nested windows can ask for many rounds.
const MAX_EVALUATIONS: usize = 1 << 23;

/// Bounds of the robustness of a formula from the beginning of the motion, and what decides it.
#[derive(Clone, Debug)]
pub struct Robustness {
    /// Bounds, in the unit of the predicate.
    pub bounds: Interval,
    /// The predicate that the lower bound comes from.
    pub predicate: usize,
    /// The cell that it comes from, s.
    pub cell: [f64; 2],
    /// Whether the bounds could be closer: the search took too long.
    pub is_cut_short: bool,
}

/// Bounds of the robustness of an instance.
///
/// - `beat`: the smallest robustness known so far: bounds above it need not be refined
pub fn robustness(instance: &Instance<'_>, beat: f64) -> Robustness {
    let mut grid = Grid::new(instance, FIRST_CELLS);
    let mut evaluations = 0;
    loop {
        let clause = &instance.formula.body;
        let evaluated = grid.evaluate(clause);
        let bounds = evaluated.values[0];
        let beaten = bounds.min >= beat;
        let close = !is_wide(bounds, TOLERANCE);
        evaluations += grid.cells();
        let is_cut_short = grid.cells() >= MAX_CELLS || evaluations >= MAX_EVALUATIONS;
        if !(close || beaten || is_cut_short) {
            let mut split = vec![false; grid.cells()];
            let mut first = vec![false; grid.cells()];
            first[0] = true;
            let upper = bounds.max.min(beat);
            grid.mark(clause, &evaluated, &first, Interval::new(bounds.min, upper), &mut split);
            if grid.split(&split) {
                continue;
            }
        }
        let (predicate, cell) = grid.decisive(clause, &evaluated, 0, true);
        return Robustness { bounds, predicate, cell: grid.cell(cell), is_cut_short };
    }
}

/// Whether bounds are farther apart than `tolerance`, relative for values above 1.
fn is_wide(bounds: Interval, tolerance: f64) -> bool {
    let size = if bounds.min.is_finite() { bounds.min.abs().max(1.0) } else { 1.0 };
    bounds.min < bounds.max && bounds.width() > tolerance * size
}

/// Cells that cover the motion; the first one is its first instant.
pub struct Grid<'a> {
    instance: &'a Instance<'a>,
    /// Beginnings of the cells, and the end of the last one, s.
    times_s: Vec<f64>,
    /// Bounds of every predicate in every cell.
    predicates: Vec<Vec<Interval>>,
    /// The part of their widths that no refinement takes away.
    irreducible: Vec<Vec<f64>>,
}

/// Bounds of a clause in every cell, and those of its parts.
struct Evaluated {
    values: Vec<Interval>,
    parts: Vec<Evaluated>,
}

impl<'a> Grid<'a> {
    /// - `cells`: how many at first, of equal length
    pub fn new(instance: &'a Instance<'a>, cells: usize) -> Self {
        let [begin_s, end_s] = instance.lifetime_s;
        let time = |index: usize| {
            let fraction = index as f64 / cells as f64;
            if index == cells { end_s } else { begin_s + fraction * (end_s - begin_s) }
        };
        let times_s: Vec<f64> = std::iter::once(begin_s).chain((0..=cells).map(time)).collect();
        let mut grid = Self { instance, times_s, predicates: Vec::new(), irreducible: Vec::new() };
        for predicate in 0..instance.formula.predicates.len() {
            let bounds = (0..grid.cells()).map(|cell| grid.bound(predicate, cell));
            let (values, widths) = bounds.unzip();
            grid.predicates.push(values);
            grid.irreducible.push(widths);
        }
        grid
    }

    /// Bounds of a clause in every cell, by the beginning of the cell, s.
    pub fn bounds_over_time(&self, clause: &Clause) -> Vec<(f64, Interval)> {
        self.times_s.iter().copied().zip(self.evaluate(clause).values).skip(1).collect()
    }

    fn cells(&self) -> usize {
        self.times_s.len() - 1
    }

    fn cell(&self, index: usize) -> [f64; 2] {
        [self.times_s[index], self.times_s[index + 1]]
    }

    fn bound(&self, predicate: usize, cell: usize) -> (Interval, f64) {
        self.instance.robustness(predicate, self.cell(cell))
    }

    fn evaluate(&self, clause: &Clause) -> Evaluated {
        let part = |clause: &Clause| self.evaluate(clause);
        let pointwise = |a: Evaluated, b: Evaluated, of: fn(Interval, Interval) -> Interval| {
            let values = a.values.iter().zip(&b.values).map(|(&a, &b)| of(a, b)).collect();
            Evaluated { values, parts: vec![a, b] }
        };
        match clause {
            Clause::Predicate(index) => Evaluated { values: self.predicates[*index].clone(), parts: Vec::new() },
            Clause::Not(a) => {
                let a = part(a);
                Evaluated { values: a.values.iter().map(|&value| -value).collect(), parts: vec![a] }
            }
            Clause::And(a, b) => pointwise(part(a), part(b), Interval::minimum),
            Clause::Or(a, b) => pointwise(part(a), part(b), Interval::maximum),
            Clause::Always(window, a) => {
                let a = part(a);
                let values = Windows::new(&self.times_s, *window).smallest(&a.values);
                Evaluated { values, parts: vec![a] }
            }
            Clause::Eventually(window, a) => {
                let a = part(a);
                let negated: Vec<Interval> = a.values.iter().map(|&value| -value).collect();
                let values = Windows::new(&self.times_s, *window).smallest(&negated);
                Evaluated { values: values.into_iter().map(|value| -value).collect(), parts: vec![a] }
            }
            Clause::Until(window, a, b) => {
                let (a, b) = (part(a), part(b));
                let values = Windows::new(&self.times_s, *window).until(&a.values, &b.values);
                Evaluated { values, parts: vec![a, b] }
            }
        }
    }

    /// Marks the cells to be halved.
    ///
    /// - `relevant`: the cells in which the value of the clause matters
    /// - `range`: the bounds within which it matters
    fn mark(&self, clause: &Clause, evaluated: &Evaluated, relevant: &[bool], range: Interval, split: &mut [bool]) {
        let is_open = |value: Interval| {
            let (min, max) = (value.min.max(range.min), value.max.min(range.max));
            min < max && is_wide(Interval::new(min, max), 0.25 * TOLERANCE)
        };
        let open: Vec<bool> =
            relevant.iter().zip(&evaluated.values).map(|(&it, &value)| it && is_open(value)).collect();
        if !open.contains(&true) {
            return;
        }
        let mut halve = |cells: &[bool]| cells.iter().zip(split.iter_mut()).for_each(|(&it, split)| *split |= it);
        match clause {
            Clause::Predicate(index) => {
                let (values, widths) = (&evaluated.values, &self.irreducible[*index]);
                let can_shrink = |cell: usize| values[cell].width() > 1.01 * widths[cell] + 0.25 * TOLERANCE;
                halve(&(0..open.len()).map(|cell| open[cell] && can_shrink(cell)).collect::<Vec<bool>>());
            }
            Clause::Not(a) => self.mark(a, &evaluated.parts[0], &open, -range, split),
            Clause::And(a, b) | Clause::Or(a, b) => {
                self.mark(a, &evaluated.parts[0], &open, range, split);
                self.mark(b, &evaluated.parts[1], &open, range, split);
            }
            Clause::Always(window, a) | Clause::Eventually(window, a) => {
                halve(&open);
                let reached = Windows::new(&self.times_s, *window).reached(&open, false);
                self.mark(a, &evaluated.parts[0], &reached, range, split);
            }
            Clause::Until(window, a, b) => {
                halve(&open);
                let windows = Windows::new(&self.times_s, *window);
                self.mark(a, &evaluated.parts[0], &windows.reached(&open, true), range, split);
                self.mark(b, &evaluated.parts[1], &windows.reached(&open, false), range, split);
            }
        }
    }

    /// Halves cells; whether there was one that could be.
    fn split(&mut self, split: &[bool]) -> bool {
        let is_long = |index: usize| self.times_s[index + 1] - self.times_s[index] > MIN_CELL_S;
        let halved: Vec<bool> = (0..self.cells()).map(|index| split[index] && is_long(index)).collect();
        if !halved.contains(&true) {
            return false;
        }
        let mut times_s = Vec::with_capacity(2 * self.times_s.len());
        let mut origins: Vec<Option<usize>> = Vec::with_capacity(2 * self.times_s.len());
        for (index, &is_halved) in halved.iter().enumerate() {
            let [begin_s, end_s] = self.cell(index);
            times_s.push(begin_s);
            origins.push((!is_halved).then_some(index));
            if is_halved {
                times_s.push(0.5 * (begin_s + end_s));
                origins.push(None);
            }
        }
        times_s.push(self.times_s[self.times_s.len() - 1]);
        self.times_s = times_s;
        for predicate in 0..self.predicates.len() {
            let (old, widths) = (&self.predicates[predicate], &self.irreducible[predicate]);
            let value = |(cell, origin): (usize, &Option<usize>)| {
                origin.map_or_else(|| self.bound(predicate, cell), |origin| (old[origin], widths[origin]))
            };
            let (values, widths) = origins.iter().enumerate().map(value).unzip();
            self.predicates[predicate] = values;
            self.irreducible[predicate] = widths;
        }
        true
    }

    /// The predicate and the cell from which a bound of the clause in `cell` comes.
    ///
    /// - `is_lower`: which of the two bounds
    fn decisive(&self, clause: &Clause, evaluated: &Evaluated, cell: usize, is_lower: bool) -> (usize, usize) {
        let end = |value: &Interval| if is_lower { value.min } else { value.max };
        let parts = &evaluated.parts;
        let follow = |part: usize, clause: &Clause, cell: usize| self.decisive(clause, &parts[part], cell, is_lower);
        match clause {
            Clause::Predicate(index) => (*index, cell),
            Clause::Not(a) => self.decisive(a, &parts[0], cell, !is_lower),
            Clause::And(a, b) | Clause::Or(a, b) => {
                let [first, second] = [0, 1].map(|part| end(&parts[part].values[cell]));
                let is_first = if matches!(clause, Clause::And(..)) { first <= second } else { first >= second };
                if is_first { follow(0, a, cell) } else { follow(1, b, cell) }
            }
            Clause::Always(window, a) | Clause::Eventually(window, a) => {
                let cells = Windows::new(&self.times_s, *window).possible(cell);
                let is_smallest = matches!(clause, Clause::Always(..));
                let found = extreme_cell(cells, &parts[0].values, is_lower, is_smallest);
                follow(0, a, found.unwrap_or(cell))
            }
            Clause::Until(window, a, b) => {
                let cells = Windows::new(&self.times_s, *window).possible(cell);
                let until = extreme_cell(cells, &parts[1].values, is_lower, false).unwrap_or(cell);
                let weakest = extreme_cell(cell..until + 1, &parts[0].values, is_lower, true).unwrap_or(cell);
                let is_first = end(&parts[0].values[weakest]) < end(&parts[1].values[until]);
                if is_first { follow(0, a, weakest) } else { follow(1, b, until) }
            }
        }
    }
}

/// The cell with the smallest or the largest bound. Of several that share it, the one that is known best: a sampled signal jumps
/// where two cells meet, and only one of them holds the sample.
///
/// - `is_lower`: which of the two bounds
fn extreme_cell(mut cells: Range<usize>, values: &[Interval], is_lower: bool, is_smallest: bool) -> Option<usize> {
    let key = |cell: usize| {
        let Interval { min, max } = values[cell];
        let [bound, other] = if is_lower { [min, max] } else { [max, min] };
        if is_smallest { [bound, other] } else { [-bound, -other] }
    };
    let first = cells.next()?;
    Some(cells.fold(first, |best, cell| {
        let ([a, other_a], [b, other_b]) = (key(cell), key(best));
        if a.total_cmp(&b).then(other_a.total_cmp(&other_b)).is_lt() { cell } else { best }
    }))
}
