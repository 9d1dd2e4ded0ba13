//! Where do two flights of one scenario part?
//!
//! What should be the same to the last bit, and is not, has parted somewhere: the first row of the two logs that differs
//! names the time, the vehicle, and the number that was different first.

use crate::output::recording::parquet::Table;

/// The first difference of two logs.
#[derive(Clone, Debug, PartialEq)]
pub struct Parting {
    /// When, s.
    pub t_s: f64,
    /// Whose log.
    pub vehicle: String,
    /// What is different.
    pub difference: Difference,
    /// Largest distance of the two vehicles' positions from there on, of all vehicles, m.
    pub largest_m: f64,
}

/// What is different.
#[derive(Clone, Debug, PartialEq)]
pub enum Difference {
    /// A number.
    Number {
        /// Its column.
        field: String,
        /// In the one and in the other log.
        values: [f64; 2],
        /// Distance in units of the last place: numbers between the two, and one.
        ulps: u64,
    },
    /// One of the logs ends here.
    End,
    /// The logs are those of different vehicles.
    Vehicles,
}

/// The first difference in time, then in the order of the vehicles, then of the columns; `None` if there is none, NaN being
/// the same as NaN.
pub fn first_difference(one: &Table, other: &Table) -> Option<Parting> {
    let names = |table: &Table| table.vehicles.iter().map(|it| it.vehicle.clone()).collect::<Vec<_>>();
    if names(one) != names(other) || one.columns != other.columns {
        let vehicle = names(one).into_iter().next().unwrap_or_default();
        return Some(Parting { t_s: 0.0, vehicle, difference: Difference::Vehicles, largest_m: f64::NAN });
    }
    let partings = one.vehicles.iter().zip(&other.vehicles).filter_map(|(a, b)| {
        let (step, difference) = first_of_vehicle(&one.columns, &a.rows, &b.rows)?;
        let row = a.rows.get(step).or_else(|| b.rows.get(step))?;
        Some((row[0], a.vehicle.clone(), difference))
    });
    // The first of equals: vehicles that part at the same time are named in their order.
    let (t_s, vehicle, difference) = partings.reduce(|first, next| if next.0 < first.0 { next } else { first })?;
    Some(Parting { t_s, vehicle, difference, largest_m: largest_distance_m(one, other) })
}

fn first_of_vehicle(columns: &[String], one: &[Vec<f64>], other: &[Vec<f64>]) -> Option<(usize, Difference)> {
    for (step, (a, b)) in one.iter().zip(other).enumerate() {
        if let Some(column) = a.iter().zip(b).position(|(a, b)| !is_same(*a, *b)) {
            let values = [a[column], b[column]];
            let field = columns[column].clone();
            return Some((step, Difference::Number { field, values, ulps: ulps_between(values) }));
        }
    }
    (one.len() != other.len()).then(|| (one.len().min(other.len()), Difference::End))
}

fn is_same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// Steps from one number to the next larger one, until the other is reached.
fn ulps_between([a, b]: [f64; 2]) -> u64 {
    // As whole numbers that grow as the floating ones do, from the most negative to the most positive.
    let ordered = |x: f64| {
        let bits = x.to_bits() as i64;
        if bits < 0 { i64::MIN - bits } else { bits }
    };
    ordered(a).abs_diff(ordered(b))
}

fn largest_distance_m(one: &Table, other: &Table) -> f64 {
    // The position follows the time.
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
        let parting = first_difference(&table(), &other).unwrap();
        assert_eq!((parting.t_s, parting.vehicle.as_str()), (0.42, "uav-2"));
        let Difference::Number { field, values, ulps } = parting.difference else { panic!("a number differs") };
        assert_eq!((field.as_str(), values, ulps), ("y_m", [0.1, 0.1_f64.next_up()], 1));
        assert_eq!(parting.largest_m, 6.0);
    }

    #[test]
    fn what_is_the_same_has_not_parted_and_what_ends_has() {
        assert_eq!(first_difference(&table(), &table()), None);
        let mut shorter = table();
        shorter.vehicles[0].rows.truncate(50);
        let parting = first_difference(&table(), &shorter).unwrap();
        assert_eq!((parting.t_s, parting.difference), (0.5, Difference::End));
        let mut renamed = table();
        renamed.vehicles[0].vehicle = "uav-7".into();
        assert_eq!(first_difference(&table(), &renamed).unwrap().difference, Difference::Vehicles);
    }

    #[test]
    fn zeros_of_both_signs_and_nan_are_told_apart() {
        let mut other = table();
        other.vehicles[0].rows[0][0] = -0.0;
        let Difference::Number { ulps, .. } = first_difference(&table(), &other).unwrap().difference else { panic!() };
        assert_eq!(ulps, 0, "as numbers they are the same, as bits they are not");
        other.vehicles[0].rows[0][0] = f64::NAN;
        assert!(first_difference(&table(), &other).is_some());
    }
}
