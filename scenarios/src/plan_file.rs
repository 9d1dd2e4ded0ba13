//! Writing plans: JSON holds everything, CSV the trajectories.

use std::io::{self, Write};

use crate::{Plan, TrajectoryNodes};

impl Plan {
    /// Writes the plan as indented JSON. Numbers are read back exactly; NaN and infinity, which JSON lacks, are written as
    /// `null`.
    ///
    /// # Errors
    ///
    /// The writer fails.
    pub fn write_json(&self, mut writer: impl Write) -> io::Result<()> {
        serde_json::to_writer_pretty(&mut writer, self)?;
        writer.write_all(b"\n")
    }

    /// Writes the trajectories as CSV with a header, in the columns of their family. Numbers are read back exactly. Between
    /// the rows controls are linear in time (first-order hold).
    ///
    /// # Errors
    ///
    /// The writer fails.
    pub fn write_csv(&self, mut writer: impl Write) -> io::Result<()> {
        let first = self.trajectories.first();
        let columns = first.map_or(&["vehicle", "t_s"][..], |first| first.family().spec().columns.written);
        writeln!(writer, "{}", columns.join(","))?;
        self.trajectories.iter().try_for_each(|trajectory| write_rows(trajectory.nodes(), &mut writer))
    }
}

fn write_rows(nodes: &dyn TrajectoryNodes, writer: &mut impl Write) -> io::Result<()> {
    for (node, t_s) in nodes.times_s().iter().enumerate() {
        writeln!(writer, "{},{t_s:?},{}", nodes.vehicle(), nodes.csv_cells(node).join(","))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::fixed_wing::{CSV_COLUMNS, Control, State, Trajectory};
    use crate::{Interpolation, Plan, PlanStatus};

    /// Numbers that a format with a fixed number of digits would change.
    const NODE: [f64; 10] = [0.1 + 0.2, -1.0 / 3.0, 1e-300, 4e22, 35.0, -0.0, f64::EPSILON, 1e-7, 123456789.123, 1.0];

    fn plan() -> Plan {
        let trajectory = Trajectory {
            vehicle: "uav-1".into(),
            interpolation: Interpolation::FirstOrderHold,
            times_s: vec![0.0, NODE[0]],
            states: vec![State::from_array([0.0; 6]), State::from_array(std::array::from_fn(|i| NODE[i + 1]))],
            controls: vec![Control::CRUISE, Control::from_array(std::array::from_fn(|i| NODE[i + 7]))],
        };
        Plan {
            status: PlanStatus::NotConverged,
            reason: Some("made by hand".into()),
            ..Plan::new("pair", "by-hand", 7, vec![trajectory.into()])
        }
    }

    #[test]
    fn csv_numbers_are_read_back_exactly() {
        let mut csv = Vec::new();
        plan().write_csv(&mut csv).unwrap();
        let csv = String::from_utf8(csv).unwrap();
        let lines: Vec<&str> = csv.lines().collect();
        assert_eq!(lines[0], "vehicle,t_s,x_m,y_m,z_m,speed_mps,heading_rad,flight_path_rad,n_x,n_y,n_z");
        assert_eq!(lines.len(), 3);
        let cells: Vec<&str> = lines[2].split(',').collect();
        assert_eq!((cells.len(), cells[0]), (CSV_COLUMNS.len(), "uav-1"));
        let bits: Vec<u64> = cells[1..].iter().map(|cell| cell.parse::<f64>().unwrap().to_bits()).collect();
        assert_eq!(bits, NODE.map(f64::to_bits));
    }

    #[test]
    fn json_is_read_back_as_the_same_plan() {
        let mut json = Vec::new();
        plan().write_json(&mut json).unwrap();
        assert_eq!(serde_json::from_slice::<Plan>(&json).unwrap(), plan());
    }
}
