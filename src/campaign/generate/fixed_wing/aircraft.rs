//! The models of fixed wings.

use scenarios::GRAVITY_MPS2;

/// Fraction of the planned lateral load factor that a path uses.
const TURN_FRACTION: f64 = 0.8;

/// A model.
#[derive(Debug)]
pub struct Aircraft {
    pub name: &'static str,
    /// Speed at start and goal, and on the path, m/s.
    pub cruise_mps: f64,
    mass_kg: f64,
    body_radius_m: f64,
    speed_mps: [f64; 2],
    planned_speed_mps: [f64; 2],
    n_y: f64,
    planned_n_y: f64,
}

/// The aircraft of the papers on fleets.
pub const SCOUT: &Aircraft = &Aircraft {
    name: "scout",
    cruise_mps: 35.0,
    mass_kg: 20.0,
    body_radius_m: 1.5,
    speed_mps: [22.0, 50.0],
    planned_speed_mps: [30.0, 40.0],
    n_y: 0.5,
    planned_n_y: 0.2,
};

const SMALL: &Aircraft = &Aircraft {
    name: "small",
    cruise_mps: 22.0,
    mass_kg: 5.0,
    body_radius_m: 0.8,
    speed_mps: [14.0, 34.0],
    planned_speed_mps: [18.0, 26.0],
    n_y: 0.5,
    planned_n_y: 0.2,
};

const FAST: &Aircraft = &Aircraft {
    name: "fast",
    cruise_mps: 52.0,
    mass_kg: 60.0,
    body_radius_m: 3.0,
    speed_mps: [34.0, 75.0],
    planned_speed_mps: [44.0, 60.0],
    n_y: 0.7,
    planned_n_y: 0.3,
};

impl Aircraft {
    /// All models.
    pub const ALL: [&Self; 3] = [SMALL, SCOUT, FAST];

    /// Radius of the tightest turn on a path, m.
    pub fn turn_radius_m(&self) -> f64 {
        self.cruise_mps * self.cruise_mps / (GRAVITY_MPS2 * TURN_FRACTION * self.planned_n_y)
    }

    /// Its table in a scenario file.
    pub fn to_toml(&self) -> String {
        let source = if self.name == SCOUT.name {
            "# Planning limits: Wang, Xu, Long, Acta Automatica Sinica (2020), section 5."
        } else {
            "# Planning limits: a margin for the tracker inside the physical ones."
        };
        let Self { name, mass_kg, body_radius_m, n_y, planned_n_y, .. } = self;
        let ([slow, fast], [planned_slow, planned_fast]) = (self.speed_mps, self.planned_speed_mps);
        format!(
            "\n[models.fixed-wing.{name}]\nmass_kg = {mass_kg}\nbody_radius_m = {body_radius_m}\n\n\
             [models.fixed-wing.{name}.limits]\naltitude_m = [280, 520]\nspeed_mps = [{slow}, {fast}]\n\
             flight_path_deg = [-12, 12]\nn_x = [-0.4, 0.4]\nn_y = [-{n_y}, {n_y}]\nn_z = [0.6, 1.4]\n\n\
             {source}\n[models.fixed-wing.{name}.planning_limits]\naltitude_m = [300, 500]\n\
             speed_mps = [{planned_slow}, {planned_fast}]\nflight_path_deg = [-5, 5]\nn_x = [-0.2, 0.2]\n\
             n_y = [-{planned_n_y}, {planned_n_y}]\nn_z = [0.8, 1.2]\n"
        )
    }
}
