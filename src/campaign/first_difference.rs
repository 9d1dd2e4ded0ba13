//! The first difference between two flights of one scenario, which should be bit-identical.
//!
//! The first row that differs between the two logs gives the time, the vehicle and the quantity.

use crate::output::recording::parquet::Table;

/// The first difference between two logs.
#[derive(Clone, Debug, PartialEq)]
pub struct FirstDifference {
    /// Time, s.
    pub t_s: f64,
    /// Vehicle.
    pub vehicle: String,
    /// Kind of difference.
    pub difference: Difference,
    /// Largest distance between the positions of a vehicle in the two flights, over all vehicles and times, m.
    pub largest_m: f64,
}

/// Kind of difference.
#[derive(Clone, Debug, PartialEq)]
pub enum Difference {
    /// A number differs.
    Number {
        /// Its column.
        field: String,
        /// Its values in the two logs.
        values: [f64; 2],
        /// Difference in units in the last place.
        ulps: u64,
    },
    /// One of the logs ends.
    End,
    /// The logs are of different vehicles.
    Vehicles,
}

/// The first difference in the order of times, then of vehicles, then of columns; `None` if the logs are equal. NaN equals
/// NaN.
pub fn first_difference(one: &Table, other: &Table) -> Option<FirstDifference> {
    let names = |table: &Table| table.vehicles.iter().map(|it| it.vehicle.clone()).collect::<Vec<_>>();
    if names(one) != names(other) || one.columns != other.columns {
        let vehicle = names(one).into_iter().next().unwrap_or_default();
        return Some(FirstDifference { t_s: 0.0, vehicle, difference: Difference::Vehicles, largest_m: f64::NAN });
    }
    let differences = one.vehicles.iter().zip(&other.vehicles).filter_map(|(a, b)| {
        let (step, difference) = first_of_vehicle(&one.columns, &a.rows, &b.rows)?;
        let row = a.rows.get(step).or_else(|| b.rows.get(step))?;
        Some((row[0], a.vehicle.clone(), difference))
    });
    let (t_s, vehicle, difference) = differences.reduce(|first, next| if next.0 < first.0 { next } else { first })?;
    Some(FirstDifference { t_s, vehicle, difference, largest_m: largest_distance_m(one, other) })
}

fn first_of_vehicle(columns: &[String], one: &[Vec<f64>], other: &[Vec<f64>]) -> Option<(usize, Difference)> {
    for (step, (a, b)) in one.iter().zip(other).enumerate() {
        if let Some(column) = a.iter().zip(b).position(|(a, b)| !is_equal(*a, *b)) {
            let values = [a[column], b[column]];
            let field = columns[column].clone();
            return Some((step, Difference::Number { field, values, ulps: ulps_between(values) }));
        }
    }
    (one.len() != other.len()).then(|| (one.len().min(other.len()), Difference::End))
}

fn is_equal(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// Number of steps between adjacent floating-point numbers from `a` to `b`.
fn ulps_between([a, b]: [f64; 2]) -> u64 {
    // Integers in the same order as the floating-point numbers.
    let ordered = |x: f64| {
        let bits = x.to_bits() as i64;
        if bits < 0 { i64::MIN - bits } else { bits }
    };
    ordered(a).abs_diff(ordered(b))
}

fn largest_distance_m(one: &Table, other: &Table) -> f64 {
    // Columns 1 to 3 hold the position.
    let distance = |(a, b): (&Vec<f64>, &Vec<f64>)| (1..4).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
    let vehicles = one.vehicles.iter().zip(&other.vehicles);
    vehicles.flat_map(|(a, b)| a.rows.iter().zip(&b.rows).map(distance)).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::{Difference, first_difference};
    use crate::output::recording::parquet::{Table, VehicleTable};

    fn table() -> Table {
        let rows =
            |offset: f64| (0..100).map(|step| vec![f64::from(step) * 0.01, offset, 0.1, 0.2, f64::NAN]).collect();
        let vehicle = |name: &str, offset| VehicleTable { vehicle: name.to_owned(), rows: rows(offset) };
        let columns = ["t_s", "x_m", "y_m", "z_m", "n_x"].map(str::to_owned).to_vec();
        Table { scenario: "pair".into(), columns, vehicles: vec![vehicle("uav-1", 1.0), vehicle("uav-2", 2.0)] }
    }

    #[test]
    fn one_ulp_is_found_and_named() {
        let mut other = table();
        let planted = &mut other.vehicles[1].rows[42][2];
        *planted = planted.next_up();
        other.vehicles[0].rows[60][1] = 7.0;
        let first = first_difference(&table(), &other).unwrap();
        assert_eq!((first.t_s, first.vehicle.as_str()), (0.42, "uav-2"));
        let Difference::Number { field, values, ulps } = first.difference else { panic!("a number differs") };
        assert_eq!((field.as_str(), values, ulps), ("y_m", [0.1, 0.1_f64.next_up()], 1));
        assert_eq!(first.largest_m, 6.0);
    }

    #[test]
    fn equal_logs_have_no_difference_and_a_log_that_ends_has() {
        assert_eq!(first_difference(&table(), &table()), None);
        let mut shorter = table();
        shorter.vehicles[0].rows.truncate(50);
        let first = first_difference(&table(), &shorter).unwrap();
        assert_eq!((first.t_s, first.difference), (0.5, Difference::End));
        let mut renamed = table();
        renamed.vehicles[0].vehicle = "uav-7".into();
        assert_eq!(first_difference(&table(), &renamed).unwrap().difference, Difference::Vehicles);
    }

    #[test]
    fn zeros_of_both_signs_differ_and_so_does_nan() {
        let mut other = table();
        other.vehicles[0].rows[0][0] = -0.0;
        let Difference::Number { ulps, .. } = first_difference(&table(), &other).unwrap().difference else { panic!() };
        assert_eq!(ulps, 0, "equal as numbers, different as bits");
        other.vehicles[0].rows[0][0] = f64::NAN;
        assert!(first_difference(&table(), &other).is_some());
    }
}
