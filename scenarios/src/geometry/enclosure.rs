//! Boxes that together contain a solid, for planners that know upright shapes only.

use std::collections::BTreeSet;

use super::{Shape, Solid};
use crate::{Prism, Range};

/// The edge of a cell, as a fraction of the longest side of the solid, to begin with.
const CELLS: f64 = 128.0;
/// Cells are doubled until there are no more boxes than this: planners connect their corners.
const MAX_BOXES: usize = 120;
/// Blocks of a terrain along its longer side.
const TERRAIN_BLOCKS: usize = 12;

/// An axis-aligned box by its corners, m.
type Corners = [[f64; 3]; 2];

impl Solid {
    /// Upright prisms that contain the solid: axis-aligned boxes that reach beyond it by no more than one and a half cells. A
    /// cell is 1/128 of its longest side, or larger where that would take more than 120 boxes. A mesh that is not closed is
    /// contained as a surface.
    pub fn enclosing_prisms(&self) -> Vec<Prism> {
        let boxes = match &self.shape {
            Shape::Mesh(surface) => surface.enclosure(|| self.boxes()).to_vec(),
            Shape::Terrain(grid) => grid.block_boxes(TERRAIN_BLOCKS),
            _ => self.boxes(),
        };
        let prism = |(index, [low_m, high_m]): (usize, Corners)| {
            let corners_m =
                [[low_m[0], low_m[1]], [high_m[0], low_m[1]], [high_m[0], high_m[1]], [low_m[0], high_m[1]]];
            let name = format!("{}-part-{}", self.name(), index + 1);
            Prism { name, corners_m: corners_m.to_vec(), z_m: Some(Range::new(low_m[2], high_m[2])) }
        };
        boxes.into_iter().enumerate().map(prism).collect()
    }

    fn boxes(&self) -> Vec<Corners> {
        let [low_m, high_m] = self.bounds_m();
        let longest_m = (0..3).map(|axis| high_m[axis] - low_m[axis]).fold(0.0, f64::max);
        let mut cell_m = longest_m / CELLS;
        loop {
            let lattice = Lattice::around([low_m, high_m], cell_m);
            let boxes = lattice.boxes(self);
            if boxes.len() <= MAX_BOXES || cell_m >= longest_m {
                return boxes;
            }
            cell_m *= 2.0;
        }
    }

    /// Smallest and largest coordinates, m.
    pub fn bounds_m(&self) -> Corners {
        match &self.shape {
            Shape::Ball { center_m, radius_m } => around(&[*center_m], *radius_m),
            Shape::Capsule { ends_m, radius_m } => around(ends_m, *radius_m),
            Shape::Cuboid { .. } | Shape::Terrain(_) => around(&self.triangles(usize::MAX).concat(), 0.0),
            Shape::Mesh(surface) => surface.bounds_m(),
        }
    }
}

fn around(points_m: &[[f64; 3]], radius_m: f64) -> Corners {
    let extreme =
        |axis: usize, from: f64, pick: fn(f64, f64) -> f64| points_m.iter().map(|point| point[axis]).fold(from, pick);
    [
        std::array::from_fn(|axis| extreme(axis, f64::INFINITY, f64::min) - radius_m),
        std::array::from_fn(|axis| extreme(axis, f64::NEG_INFINITY, f64::max) + radius_m),
    ]
}

/// Cubic cells around a solid.
struct Lattice {
    origin_m: [f64; 3],
    cell_m: f64,
    /// Cells along each axis of a cube of 2^levels that holds all of them.
    levels: u32,
}

impl Lattice {
    fn around([low_m, high_m]: Corners, cell_m: f64) -> Self {
        let cells = (0..3).map(|axis| (high_m[axis] - low_m[axis]) / cell_m).fold(1.0, f64::max);
        let levels = (cells.ceil() + 1.0).log2().ceil() as u32;
        // Half a cell of room, so that a face of the solid that is level with a cell belongs to one layer.
        Self { origin_m: low_m.map(|it| it - cell_m / 2.0), cell_m, levels }
    }

    /// The cells that the solid may reach into, merged to boxes.
    fn boxes(&self, solid: &Solid) -> Vec<Corners> {
        let mut occupied = BTreeSet::new();
        self.collect(solid, [0; 3], self.levels, &mut occupied);
        let mut boxes = Vec::new();
        while let Some(first) = occupied.first().copied() {
            let last = grown(&occupied, first);
            each_cell(first, last, &mut |cell| {
                occupied.remove(&cell);
            });
            let corner_m = |cell: [u32; 3], beyond: u32| -> [f64; 3] {
                std::array::from_fn(|axis| self.origin_m[axis] + self.cell_m * f64::from(cell[axis] + beyond))
            };
            boxes.push([corner_m(first, 0), corner_m(last, 1)]);
        }
        boxes
    }

    /// The cells of a block, of 2^level along each axis, that are not certainly outside of the solid.
    fn collect(&self, solid: &Solid, first: [u32; 3], level: u32, occupied: &mut BTreeSet<[u32; 3]>) {
        let half_m = self.cell_m * f64::from(1_u32 << level) / 2.0;
        let centre_m = std::array::from_fn(|axis| self.origin_m[axis] + self.cell_m * f64::from(first[axis]) + half_m);
        let (distance_m, reach_m) = (solid.signed_distance_m(centre_m), half_m * 3.0_f64.sqrt());
        if distance_m > reach_m {
            return;
        }
        if level == 0 {
            occupied.insert(first);
            return;
        }
        let half = 1_u32 << (level - 1);
        for octant in 0..8_u32 {
            let child = std::array::from_fn(|axis| first[axis] + half * (octant >> axis & 1));
            self.collect(solid, child, level - 1, occupied);
        }
    }
}

/// The last cell of the box that grows from a cell, first along z, then y, then x, as long as all of it is occupied.
fn grown(occupied: &BTreeSet<[u32; 3]>, first: [u32; 3]) -> [u32; 3] {
    let mut last = first;
    for axis in [2, 1, 0] {
        loop {
            let (mut from, mut to) = (first, last);
            (from[axis], to[axis]) = (last[axis] + 1, last[axis] + 1);
            let mut is_whole = true;
            each_cell(from, to, &mut |cell| is_whole &= occupied.contains(&cell));
            if !is_whole {
                break;
            }
            last = to;
        }
    }
    last
}

fn each_cell(first: [u32; 3], last: [u32; 3], visit: &mut impl FnMut([u32; 3])) {
    for x in first[0]..=last[0] {
        for y in first[1]..=last[1] {
            for z in first[2]..=last[2] {
                visit([x, y, z]);
            }
        }
    }
}
