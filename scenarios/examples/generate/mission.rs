//! A mission, and its scenario file.

use std::fmt::Write;

/// Speed at start and goal, m/s (paper).
pub const SPEED_MPS: f64 = 35.0;

/// Start and goal of one vehicle, with headings.
#[derive(Clone, Copy)]
pub struct Route {
    pub start_m: [f64; 2],
    pub start_heading_deg: f64,
    pub goal_m: [f64; 2],
    pub goal_heading_deg: f64,
}

impl Route {
    /// The straight route from start to goal.
    pub fn straight(start_m: [f64; 2], goal_m: [f64; 2]) -> Self {
        let heading_deg = (goal_m[1] - start_m[1]).atan2(goal_m[0] - start_m[0]).to_degrees();
        Self { start_m, start_heading_deg: heading_deg, goal_m, goal_heading_deg: heading_deg }
    }

    pub fn length_m(&self) -> f64 {
        distance_m(self.start_m, self.goal_m)
    }

    /// Position at a fraction of the straight line.
    pub fn at(&self, fraction: f64) -> [f64; 2] {
        std::array::from_fn(|axis| self.start_m[axis] + fraction * (self.goal_m[axis] - self.start_m[axis]))
    }
}

/// What differs between the files.
pub struct Mission {
    pub name: String,
    pub description: String,
    pub tags: &'static str,
    /// Comment lines at the head of the file: the sources of the numbers.
    pub sources: &'static str,
    /// Limits of the map in x and y, m.
    pub map_m: [[f64; 2]; 2],
    /// Centre and radius, m.
    pub cylinders: Vec<([f64; 2], f64)>,
    pub separation_m: f64,
    pub separation_source: &'static str,
    pub simultaneous_arrival: bool,
    pub routes: Vec<Route>,
    /// Lines of `[planner]` after its name.
    pub planner: &'static str,
}

impl Mission {
    pub fn to_toml(&self) -> String {
        let mut text = String::from("#:schema ../../schema/scenario.json\n");
        for line in self.sources.lines() {
            writeln!(text, "# {line}").expect("writing to a string cannot fail");
        }
        let [x, y] = self.map_m;
        write!(
            text,
            "\nname = \"{}\"\ndescription = \"{}\"\ntags = {}\n\n[world.map] # ours\nx_m = [{}, {}]\ny_m = [{}, {}]\nz_m = [0, 1000]\n",
            self.name, self.description, self.tags, x[0], x[1], y[0], y[1]
        )
        .expect("writing to a string cannot fail");
        for (index, (center_m, radius_m)) in self.cylinders.iter().enumerate() {
            write!(
                text,
                "\n[[world.cylinders]]\nname = \"threat-{}\"\ncenter_m = [{}, {}]\nradius_m = {radius_m}\n",
                index + 1,
                center_m[0],
                center_m[1]
            )
            .expect("writing to a string cannot fail");
        }
        text.push_str(MODEL);
        write!(
            text,
            "\n[fleet]\nseparation_m = {} # {}\nsimultaneous_arrival = {}\n",
            self.separation_m, self.separation_source, self.simultaneous_arrival
        )
        .expect("writing to a string cannot fail");
        for (index, route) in self.routes.iter().enumerate() {
            write!(
                text,
                "\n[[vehicles]]\nname = \"uav-{}\"\nmodel = \"scout\"\nstart = {}\ngoal = {}\n",
                index + 1,
                waypoint(route.start_m, route.start_heading_deg),
                waypoint(route.goal_m, route.goal_heading_deg)
            )
            .expect("writing to a string cannot fail");
        }
        write!(text, "\n[planner]\nname = \"fleet-scp\"\n{}", self.planner).expect("writing to a string cannot fail");
        text
    }
}

fn waypoint([x_m, y_m]: [f64; 2], heading_deg: f64) -> String {
    let [x_m, y_m, heading_deg] = [round(x_m, 1e3), round(y_m, 1e3), round(heading_deg, 1e6)];
    format!("{{ x_m = {x_m}, y_m = {y_m}, z_m = 400, speed_mps = {SPEED_MPS}, heading_deg = {heading_deg} }}")
}

fn round(value: f64, per_unit: f64) -> f64 {
    (value * per_unit).round() / per_unit + 0.0
}

pub fn distance_m(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Duration without conflicts after the start and before the goal, s, so that every conflict can be resolved.
const CONFLICT_FREE_S: f64 = 20.0;

/// Whether two straight flights keep twice the separation near their starts and goals.
pub fn starts_and_ends_apart(a: &Route, b: &Route, separation_m: f64) -> bool {
    let steps = 20;
    (0..=steps).all(|step| {
        let fraction =
            |route: &Route| CONFLICT_FREE_S * SPEED_MPS / route.length_m() * f64::from(step) / f64::from(steps);
        let (of_a, of_b) = (fraction(a), fraction(b));
        let [after_start, before_goal] =
            [[of_a, of_b], [1.0 - of_a, 1.0 - of_b]].map(|[a_at, b_at]| distance_m(a.at(a_at), b.at(b_at)));
        after_start > 2.0 * separation_m && before_goal > 2.0 * separation_m
    })
}

const MODEL: &str = "
[models.fixed-wing.scout]
mass_kg = 20 # ours: the paper's point-mass model has no mass
body_radius_m = 1.5 # ours

# Physical limits (ours): margin for the tracker around the planning limits.
[models.fixed-wing.scout.limits]
altitude_m = [280, 520]
speed_mps = [22, 50]
flight_path_deg = [-12, 12]
n_x = [-0.4, 0.4]
n_y = [-0.5, 0.5]
n_z = [0.6, 1.4]

# Bounds of Wang, Xu, Long, Acta Automatica Sinica (2020), section 5.
[models.fixed-wing.scout.planning_limits]
altitude_m = [300, 500]
speed_mps = [30, 40]
flight_path_deg = [-5, 5]
n_x = [-0.2, 0.2]
n_y = [-0.2, 0.2]
n_z = [0.8, 1.2]
";
