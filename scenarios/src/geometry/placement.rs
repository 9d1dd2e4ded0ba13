/// A similarity transform from the axes of a file or a body to the world: scale, then rotation, then offset.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    scale: f64,
    /// Rows of the rotation matrix, world from local.
    rotation: [[f64; 3]; 3],
    offset_m: [f64; 3],
}

impl Placement {
    /// - `rotation_rad`: roll, pitch and yaw about the fixed axes x, y, z in this order: R = R_z R_y R_x
    pub fn new(scale: f64, [roll, pitch, yaw]: [f64; 3], offset_m: [f64; 3]) -> Self {
        let ((sr, cr), (sp, cp), (sy, cy)) = (roll.sin_cos(), pitch.sin_cos(), yaw.sin_cos());
        let rotation = [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ];
        Self { scale, rotation, offset_m }
    }

    /// A point in the world, m.
    pub fn to_world(self, local: [f64; 3]) -> [f64; 3] {
        let rotated = |row: [f64; 3]| (0..3).map(|axis| row[axis] * local[axis]).sum::<f64>();
        std::array::from_fn(|axis| self.offset_m[axis] + self.scale * rotated(self.rotation[axis]))
    }

    /// A point in its own axes.
    pub fn to_local(self, world_m: [f64; 3]) -> [f64; 3] {
        let from_origin_m: [f64; 3] = std::array::from_fn(|axis| world_m[axis] - self.offset_m[axis]);
        let column = |axis: usize| (0..3).map(|row| self.rotation[row][axis] * from_origin_m[row]).sum::<f64>();
        std::array::from_fn(|axis| column(axis) / self.scale)
    }
}

#[cfg(test)]
mod tests {
    use super::Placement;

    #[test]
    fn yaw_turns_east_to_north_and_back() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|axis| (a[axis] - b[axis]).abs() < 1e-12);
        let yawed = Placement::new(2.0, [0.0, 0.0, quarter], [10.0, 0.0, 1.0]);
        assert!(near(yawed.to_world([1.0, 0.0, 0.5]), [10.0, 2.0, 2.0]));
        // Roll first: y goes up, and yaw leaves it there.
        assert!(near(
            Placement::new(1.0, [quarter, 0.0, quarter], [0.0; 3]).to_world([0.0, 1.0, 0.0]),
            [0.0, 0.0, 1.0]
        ));
        let turned = Placement::new(0.3, [0.4, -1.1, 2.5], [-3.0, 7.0, 0.2]);
        assert!(near(turned.to_local(turned.to_world([1.0, -2.0, 3.0])), [1.0, -2.0, 3.0]));
    }
}
