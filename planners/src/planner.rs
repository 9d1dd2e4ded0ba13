use scenarios::in_loop::InLoopPlanner;
use scenarios::{Iteration, Plan, Scenario};

/// Callback that receives each iteration of a planner as it ends.
pub type Progress<'a> = &'a mut dyn FnMut(&Iteration);

/// A planner, before the flight or in the loop.
///
/// # Examples
///
/// Planning with a registered planner:
///
/// ```
/// let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/multirotor");
/// let scenario = scenarios::load(format!("{folder}/paper-map.toml").as_ref()).unwrap();
/// let rrt = planners::find("rrt").unwrap();
/// assert_eq!((rrt.unsupported_reason)(&scenario), None);
/// let plan = rrt.plan(&scenario.planner_view(), 1, &mut |_| {});
/// assert_eq!(plan.status, scenarios::PlanStatus::Solved);
/// ```
///
/// Defining one. To register it, add it to the list `PLANNERS` of its family:
///
/// ```
/// use planners::{Planner, PlanningMode};
/// use scenarios::{Plan, Scenario};
///
/// const GIVES_UP: Planner = Planner {
///     name: "gives-up",
///     summary: "finds no plan",
///     handles: "everything",
///     unsupported_reason: |_: &Scenario| None,
///     mode: PlanningMode::BeforeFlight(|scenario, seed, _| {
///         Plan::no_plan(&scenario.name, "gives-up", seed, "it did not try")
///     }),
/// };
/// assert!(!GIVES_UP.plans_in_the_loop());
/// ```
#[derive(Clone, Copy)]
pub struct Planner {
    /// Name, as in `[planner] name` and `--planner`.
    pub name: &'static str,
    /// The method, in one sentence.
    pub summary: &'static str,
    /// The problems that it claims to handle, in a few words.
    pub handles: &'static str,
    /// Why it cannot handle a scenario; `None` if it can.
    pub unsupported_reason: fn(&Scenario) -> Option<String>,
    /// When it plans, and the function that does.
    pub mode: PlanningMode,
}

/// When a planner plans.
#[derive(Clone, Copy)]
pub enum PlanningMode {
    /// Before the flight, for all vehicles at once: plans a scenario with a seed.
    BeforeFlight(fn(&Scenario, u64, Progress<'_>) -> Plan),
    /// During the flight: creates the planner of one vehicle, by its index, with a seed.
    InLoop(fn(&Scenario, usize, u64) -> Box<dyn InLoopPlanner>),
}

impl Planner {
    /// Does it plan during the flight?
    pub fn plans_in_the_loop(&self) -> bool {
        matches!(self.mode, PlanningMode::InLoop(_))
    }

    /// Plans before the flight. The same seed gives the same plan, wall times aside, on any number of threads. That no plan
    /// was found is not an error, but a status of the plan.
    ///
    /// - `scenario`: what is known before the flight, see [`Scenario::planner_view`]; it must be supported
    ///   ([`unsupported_reason`](Self::unsupported_reason) is `None`)
    /// - `seed`: seed of all random numbers
    /// - `progress`: receives each iteration
    ///
    /// # Panics
    ///
    /// If the planner plans in the loop.
    pub fn plan(&self, scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
        match self.mode {
            PlanningMode::BeforeFlight(plan) => plan(scenario, seed, progress),
            PlanningMode::InLoop(_) => panic!("{} plans in the loop: there is no plan before the flight", self.name),
        }
    }

    /// Creates the in-loop planner of one vehicle. The same seed and the same observations give the same results on any
    /// number of threads.
    ///
    /// - `scenario`: what is known before the flight, see [`Scenario::planner_view`]; it must be supported
    ///   ([`unsupported_reason`](Self::unsupported_reason) is `None`)
    /// - `vehicle`: index of the vehicle
    /// - `seed`: seed of all random numbers
    ///
    /// # Panics
    ///
    /// If the planner plans before the flight, or there is no such vehicle.
    pub fn in_loop(&self, scenario: &Scenario, vehicle: usize, seed: u64) -> Box<dyn InLoopPlanner> {
        match self.mode {
            PlanningMode::InLoop(create) => create(scenario, vehicle, seed),
            PlanningMode::BeforeFlight(_) => panic!("{} plans before the flight, not in the loop", self.name),
        }
    }
}

/// Why a planner that does not model geofences cannot handle a scenario; `None` if there are none.
pub(crate) fn ignored_geofence(scenario: &Scenario) -> Option<String> {
    let fence = scenario.world.geofences.first()?;
    Some(format!("it does not plan around geofences such as `{}`", fence.name))
}

/// Why a planner that flies straight to the goal cannot handle a scenario; `None` if there are no via-points.
pub(crate) fn ignored_via_point(scenario: &Scenario) -> Option<String> {
    let vehicle = scenario.vehicles.iter().find(|vehicle| !vehicle.via.is_empty())?;
    Some(format!("it does not plan through via-points, which `{}` has", vehicle.name))
}

/// Why a planner that models upright obstacles only cannot handle a scenario; `None` if there are no others.
pub(crate) fn ignored_solid(scenario: &Scenario) -> Option<String> {
    let solid = scenario.world.solids().into_iter().next()?;
    Some(format!("it does not plan around `{}`, {}", solid.name(), solid.kind()))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use scenarios::{Geofence, GeofenceKind, Scenario, SeparationShape, Sphere, ViaPoint, Waypoint};

    #[test]
    fn planners_that_do_not_know_geofences_refuse_them_by_name() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
        for file in ["slung/rectangle.toml", "fixed-wing/rendezvous-7.toml"] {
            let mut scenario = scenarios::load(&folder.join(file)).unwrap();
            let fitting = |scenario: &Scenario| {
                crate::registry().iter().filter(|planner| (planner.unsupported_reason)(scenario).is_none()).count()
            };
            assert!(fitting(&scenario) > 0, "{file}");
            let polygon_m = vec![[-1e5, -1e5], [1e5, -1e5], [0.0, 1e5]];
            let fence =
                Geofence { name: "airport".into(), kind: GeofenceKind::StayIn, polygon_m, rings_m: vec![], z_m: None };
            scenario.world.geofences.push(fence);
            assert_eq!(fitting(&scenario), 0, "{file}");
            let planner = crate::find(&scenario.planner.name).unwrap();
            assert!((planner.unsupported_reason)(&scenario).unwrap().contains("`airport`"), "{file}");
        }
    }

    /// Fixed wings may cross above each other within a cylinder's height; their planners keep them apart horizontally.
    #[test]
    fn planners_refuse_separation_rules_that_they_cannot_keep() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
        let load = |file: &str| scenarios::load(&folder.join(file)).unwrap();
        let reason = |scenario: &Scenario| {
            (crate::find(&scenario.planner.name).unwrap().unsupported_reason)(scenario).unwrap_or_default()
        };
        let mut fleet = load("fixed-wing/rendezvous-7.toml");
        fleet.fleet.separation_shape = Some(SeparationShape::Cylinder);
        fleet.fleet.separation_height_m = Some(30.0);
        assert_eq!(reason(&fleet), "");
        assert_eq!(fleet.horizontal_separation_m(), Some(100.0));
        let first = fleet.vehicles[0].start;
        fleet.vehicles[1].start = Waypoint { z_m: first.z_m + 40.0, ..first };
        assert!(reason(&fleet).contains("start nearer to each other"), "{}", reason(&fleet));
        let mut crossing = load("multirotor/crossing-4.toml");
        crossing.fleet.separation_shape = Some(SeparationShape::Ellipsoid);
        crossing.fleet.separation_height_m = Some(1.5);
        assert_eq!(reason(&crossing), "");
        crossing.fleet.separation_shape = Some(SeparationShape::Horizontal);
        assert!(reason(&crossing).contains("in space"), "{}", reason(&crossing));
    }

    #[test]
    fn rhc_alone_flies_through_via_points() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
        for file in ["slung/rectangle.toml", "fixed-wing/rendezvous-7.toml", "multirotor/trap.toml"] {
            let mut scenario = scenarios::load(&folder.join(file)).unwrap();
            let [x_m, y_m, z_m] = scenario.vehicles[0].start.position_m();
            scenario.vehicles[0].via = vec![ViaPoint { x_m, y_m, z_m, radius_m: 0.5, window_s: None }];
            let fitting = crate::registry().iter().filter(|planner| (planner.unsupported_reason)(&scenario).is_none());
            assert!(fitting.clone().all(|planner| planner.name.starts_with("rhc")), "{file}");
            assert_eq!(fitting.count() > 0, file.starts_with("multirotor"), "{file}");
        }
    }

    #[test]
    fn planners_that_know_upright_obstacles_only_refuse_others_by_name() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios");
        for (file, refuse) in
            [("slung/rectangle.toml", true), ("fixed-wing/rendezvous-7.toml", true), ("multirotor/trap.toml", false)]
        {
            let mut scenario = scenarios::load(&folder.join(file)).unwrap();
            scenario.world.spheres.push(Sphere { name: "balloon".into(), center_m: [0.0; 3], radius_m: 1.0 });
            let planner = crate::find(&scenario.planner.name).unwrap();
            let reason = (planner.unsupported_reason)(&scenario);
            assert_eq!(reason.as_deref(), refuse.then_some("it does not plan around `balloon`, a sphere"), "{file}");
        }
    }
}
