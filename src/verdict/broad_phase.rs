//! Boxes around stretches of a motion, so that two vehicles that are far apart need no closer look.

use std::ops::{Index, Range};

use crate::verdict::motion::Motion;

/// Segments per block, about, for the motion with the most of them.
const SEGMENTS_PER_BLOCK: usize = 32;

/// The common division of time into blocks.
pub struct Frame {
    block_s: f64,
    count: usize,
}

impl Frame {
    /// A division that suits all of `motions`.
    pub fn over(motions: &[Motion]) -> Self {
        let most = motions.iter().map(Motion::segment_count).max().unwrap_or(0);
        let end_s = motions.iter().map(Motion::end_s).fold(0.0, f64::max);
        let count = (most / SEGMENTS_PER_BLOCK).max(1);
        Self { block_s: end_s / count as f64, count }
    }

    /// Number of blocks.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The block that holds the time `t_s`.
    fn index(&self, t_s: f64) -> usize {
        // A division by zero gives NaN or infinity, which the cast turns into 0 or the last block.
        ((t_s / self.block_s) as usize).min(self.count - 1)
    }
}

/// One motion, block by block: every segment is in each block that it touches.
pub struct Blocks(Vec<Block>);

/// The segments of a motion during one block of time, and the horizontal box around their control points.
#[derive(Clone)]
pub struct Block {
    /// Indices of the segments; empty when the motion does not last so long.
    pub segments: Range<usize>,
    low_m: [f64; 2],
    high_m: [f64; 2],
}

impl Blocks {
    /// Divides `motion`.
    pub fn new(motion: &Motion, frame: &Frame) -> Self {
        let mut blocks = vec![Block::EMPTY; frame.count];
        for (index, segment) in motion.segments().enumerate() {
            for block in &mut blocks[frame.index(segment.t_s[0])..=frame.index(segment.t_s[1])] {
                block.add(index, &segment.points_m);
            }
        }
        Self(blocks)
    }

    /// The blocks in the order of time, as many for every motion of a frame.
    pub fn iter(&self) -> std::slice::Iter<'_, Block> {
        self.0.iter()
    }
}

impl Index<usize> for Blocks {
    type Output = Block;

    fn index(&self, block: usize) -> &Block {
        &self.0[block]
    }
}

impl Block {
    const EMPTY: Self = Self { segments: 0..0, low_m: [f64::INFINITY; 2], high_m: [f64::NEG_INFINITY; 2] };

    fn add(&mut self, index: usize, points_m: &[[f64; 3]; 4]) {
        if self.segments.is_empty() {
            self.segments.start = index;
        }
        self.segments.end = index + 1;
        for point in points_m {
            for (axis, value) in point[..2].iter().enumerate() {
                self.low_m[axis] = self.low_m[axis].min(*value);
                self.high_m[axis] = self.high_m[axis].max(*value);
            }
        }
    }

    /// Smallest x of the box, m.
    pub fn west_m(&self) -> f64 {
        self.low_m[0]
    }

    /// Largest x of the box, m.
    pub fn east_m(&self) -> f64 {
        self.high_m[0]
    }

    /// Smallest horizontal distance between anything in the two boxes, m; infinite if one is empty.
    pub fn gap_m(&self, other: &Self) -> f64 {
        let axis_gap =
            |axis: usize| (self.low_m[axis] - other.high_m[axis]).max(other.low_m[axis] - self.high_m[axis]).max(0.0);
        let (x, y) = (axis_gap(0), axis_gap(1));
        (x * x + y * y).sqrt()
    }

    /// Smallest horizontal distance from anything in the box to `point_m`, m.
    pub fn gap_to_point_m(&self, point_m: [f64; 2]) -> f64 {
        let axis_gap = |axis: usize| (self.low_m[axis] - point_m[axis]).max(point_m[axis] - self.high_m[axis]).max(0.0);
        let (x, y) = (axis_gap(0), axis_gap(1));
        (x * x + y * y).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::{Blocks, Frame};
    use crate::verdict::motion::{Knot, Motion};

    /// Along x at 10 m/s, for 64 s: with knots every `step_s`.
    fn line(y_m: f64, step_s: f64) -> Motion {
        let knot = |step: u32| {
            let t_s = f64::from(step) * step_s;
            Knot { t_s, position_m: [10.0 * t_s, y_m, 0.0], velocity_mps: [10.0, 0.0, 0.0] }
        };
        Motion::new("uav", (0..=(64.0 / step_s) as u32).map(knot).collect()).unwrap()
    }

    #[test]
    fn a_segment_is_in_every_block_that_it_touches() {
        // 64 segments make two blocks of 32 s; the coarse motion's second segment, 25.6 s to 51.2 s, touches both.
        let (fine, coarse) = (line(0.0, 1.0), line(0.0, 25.6));
        let frame = Frame::over(&[fine.clone(), coarse.clone()]);
        let ranges = |motion: &Motion| -> Vec<_> {
            Blocks::new(motion, &frame).iter().map(|block| block.segments.clone()).collect()
        };
        assert_eq!(ranges(&fine), [0..32, 31..64]);
        assert_eq!(ranges(&coarse), [0..2, 1..2]);
    }

    #[test]
    fn gaps_are_those_between_the_boxes() {
        let (low, high) = (line(0.0, 1.0), line(30.0, 1.0));
        let frame = Frame::over(&[low.clone(), high.clone()]);
        let (low, high) = (Blocks::new(&low, &frame), Blocks::new(&high, &frame));
        let (first, second) = (low.iter().next().unwrap(), high.iter().nth(1).unwrap());
        // x from 0 m to 320 m against 310 m to 640 m: they overlap.
        assert_eq!((first.gap_m(second), second.gap_m(first)), (30.0, 30.0));
        assert_eq!(first.gap_to_point_m([-3.0, -4.0]), 5.0);
        assert_eq!(second.gap_to_point_m([643.0, 34.0]), 5.0);
        assert_eq!(first.gap_to_point_m([100.0, 0.0]), 0.0);
    }
}
