//! The quantities that are plotted for each aircraft, with their limits.

use rayon::prelude::*;
use scenarios::Scenario;
use scenarios::fixed_wing::Limits;
use sim::{Flight, Sample, VehicleLog};

use super::super::{PlotView, distance_m, norm};

/// A plotted quantity of one vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Distance from the plan.
    Tracking,
    /// Load factor along the velocity.
    Nx,
    /// Horizontal load factor.
    Ny,
    /// Vertical load factor.
    Nz,
    /// Speed relative to the air.
    Airspeed,
    /// Altitude.
    Altitude,
}

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::Tracking, Self::Nx, Self::Ny, Self::Nz, Self::Airspeed, Self::Altitude];

    /// The plot that it belongs to.
    pub fn group(self) -> &'static str {
        match self {
            Self::Tracking => "tracking_m",
            Self::Nx => "n_x",
            Self::Ny => "n_y",
            Self::Nz => "n_z",
            Self::Airspeed => "airspeed_mps",
            Self::Altitude => "altitude_m",
        }
    }

    /// Its name with its unit.
    pub fn field(self) -> &'static str {
        match self {
            Self::Tracking => "tracking_error_m",
            Self::Nx => "n_x",
            Self::Ny => "n_y",
            Self::Nz => "n_z",
            Self::Airspeed => "airspeed_mps",
            Self::Altitude => "altitude_m",
        }
    }

    /// Title of its plot.
    pub fn title(self) -> &'static str {
        match self {
            Self::Tracking => "Tracking error: distance from the plan [m]",
            Self::Nx => "Load factor n_x, along the velocity [-]",
            Self::Ny => "Load factor n_y, horizontal, positive to the left [-]",
            Self::Nz => "Load factor n_z, vertical [-]",
            Self::Airspeed => "Airspeed [m/s]",
            Self::Altitude => "Altitude [m]",
        }
    }

    /// Its unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Tracking | Self::Altitude => "m",
            Self::Nx | Self::Ny | Self::Nz => "-",
            Self::Airspeed => "m/s",
        }
    }

    /// Its value in a sample, in its unit.
    pub fn of(self, sample: &Sample) -> f64 {
        match self {
            Self::Tracking => distance_m(sample.position_m, sample.reference_position_m),
            Self::Nx => sample.load_factors().control.n_x,
            Self::Ny => sample.load_factors().control.n_y,
            Self::Nz => sample.load_factors().control.n_z,
            Self::Airspeed => norm(sample.air_velocity_mps()),
            Self::Altitude => sample.position_m[2],
        }
    }

    /// A plot of all vehicles and limits.
    pub fn plot(self, scenario: &Scenario, flight: &Flight, has_legend: bool) -> PlotView {
        let limits = self.limits(scenario).into_iter().map(|(_, value)| value);
        let plot = PlotView { has_legend, ..PlotView::new(self.group(), self.title(), 1.0) };
        plot.spanning(limits.chain(self.extremes(flight)))
    }

    /// Smallest and largest finite value of every vehicle.
    fn extremes(self, flight: &Flight) -> Vec<f64> {
        let of_vehicle = |log: &VehicleLog| {
            let values = || log.samples.iter().map(|sample| self.of(sample)).filter(|value| value.is_finite());
            [values().reduce(f64::min), values().reduce(f64::max)]
        };
        flight.vehicles.par_iter().flat_map_iter(of_vehicle).flatten_iter().collect()
    }

    /// Its limits with their names: the scenario's tracking limit, or the physical limits of every model in the fleet.
    pub fn limits(self, scenario: &Scenario) -> Vec<(String, f64)> {
        if self == Self::Tracking {
            return vec![("limit".to_owned(), scenario.limits().tracking_max_m)];
        }
        let mut models: Vec<&str> = scenario.vehicles.iter().map(|vehicle| vehicle.model.as_str()).collect();
        models.sort_unstable();
        models.dedup();
        let alone = models.len() == 1;
        let limits = models.iter().filter_map(|name| Some((*name, &scenario.models.fixed_wing.get(*name)?.limits)));
        let named = |bound: &str, model: &str| if alone { bound.to_owned() } else { format!("{bound} of {model}") };
        limits
            .flat_map(|(model, limits)| {
                let range = self.range(limits);
                [(named("lowest", model), range.min), (named("highest", model), range.max)]
            })
            .filter(|(_, value)| value.is_finite())
            .collect()
    }

    fn range(self, limits: &Limits) -> scenarios::Range {
        match self {
            Self::Tracking => scenarios::Range::new(0.0, f64::INFINITY),
            Self::Nx => limits.n_x,
            Self::Ny => limits.n_y,
            Self::Nz => limits.n_z,
            Self::Airspeed => limits.speed_mps,
            Self::Altitude => limits.altitude_m,
        }
    }
}
