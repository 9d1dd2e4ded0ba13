//! The list of all figures, and the page that shows them.

use scenarios::{CostMap, PathTiming, Solver};

use super::Figure;
use super::flights::{Change, FlightFigures, View};
use super::studies::{Method, Printed, Study};

const SEPARATION: View = View::Series("separation", "separation_m", "Smallest distance between two vehicles over time");
const ALTITUDE: View = View::Series("altitude", "altitude_m", "Altitude over time");
const AIRSPEED: View = View::Series("speed", "airspeed_mps", "Speed over time");
const N_X: View = View::Series("n-x", "n_x", "Load factor along the velocity over time");
const N_Y: View = View::Series("n-y", "n_y", "Horizontal load factor over time");
const N_Z: View = View::Series("n-z", "n_z", "Vertical load factor over time");
/// The figures of a mission of the first paper.
const MISSION: &[View] = &[View::FromAbove, ALTITUDE, AIRSPEED, N_X, N_Y, N_Z, SEPARATION];
/// The figures of a flight through a map of the third paper.
const TRACK: &[View] =
    &[View::WithCostMap, View::Series("clearance", "clearance_m", "Distance to the nearest obstacle over time")];

/// Paths flown as planned, at the largest speed and without regard to the acceleration limit.
const AS_PLANNED: Change = Change::Timing(PathTiming::ConstantSpeed);

const fn flight(
    paper: u8,
    name: &'static str,
    scenario: &'static str,
    planner: &'static str,
    change: Change,
    views: &'static [View],
) -> FlightFigures {
    FlightFigures { paper, name, scenario, planner, change, views }
}

/// Figures of single flights.
pub const FLIGHTS: [FlightFigures; 11] = [
    flight(1, "1-rendezvous", "fixed-wing/rendezvous-7.toml", "parallel-scp", Change::Nothing, MISSION),
    flight(1, "1-reconfiguration", "fixed-wing/reconfiguration-7.toml", "parallel-scp", Change::Nothing, MISSION),
    flight(
        2,
        "2-rendezvous-15",
        "fixed-wing/rendezvous-15.toml",
        "dpd-scp",
        Change::Nothing,
        &[View::FromAbove, View::Convergence, View::Spacing, SEPARATION],
    ),
    flight(
        2,
        "2-exchange-100",
        "fixed-wing/exchange-100.toml",
        "dpd-scp",
        Change::Nothing,
        &[View::FromAbove, SEPARATION],
    ),
    flight(3, "3-visibility", "multirotor/paper-map.toml", "rhc-fpso", Change::CostMap(CostMap::Visibility), TRACK),
    flight(3, "3-voronoi", "multirotor/paper-map.toml", "rhc-fpso", Change::CostMap(CostMap::Voronoi), TRACK),
    flight(
        3,
        "3-voronoi-vertices",
        "multirotor/paper-map.toml",
        "rhc-fpso",
        Change::CostMap(CostMap::VoronoiVertices),
        TRACK,
    ),
    flight(3, "3-sparse-astar", "multirotor/paper-map.toml", "sparse-astar", AS_PLANNED, &[View::FromAbove]),
    flight(3, "3-rrt", "multirotor/paper-map.toml", "rrt", AS_PLANNED, &[View::FromAbove]),
    flight(3, "3-pop-up", "multirotor/pop-up.toml", "rhc-fpso", Change::Nothing, &[View::FromAbove, AIRSPEED]),
    flight(
        4,
        "4-rectangle",
        "slung/rectangle.toml",
        "slung-lgr",
        Change::Nothing,
        &[
            View::WithEnvelopes,
            View::EnvelopeRadius,
            View::Series("clearance", "clearance_m", "Distance of body, cable, load and envelope to the obstacle"),
            View::Series("swing", "swing_deg", "Angle of the cable from straight down"),
            View::Series("thrust", "thrust_n", "Thrust of each rotor"),
            View::Series("tension", "tension_n", "Tension of the cable"),
            View::Series("cable", "cable", "State of the cable: 1 taut, 0 slack"),
        ],
    ),
];

const FLEETS: &[usize] = &[1, 2, 3, 4, 5, 6, 7];
const SOLVERS: &[Method] = &[
    Method { label: "customised (block)", planner: "parallel-scp", solver: Some(Solver::Block), sizes: FLEETS },
    Method {
        label: "general (Clarabel)",
        planner: "parallel-scp",
        solver: Some(Solver::Clarabel),
        sizes: &[1, 2, 3, 5, 7],
    },
];

/// Figures over fleet sizes.
pub const STUDIES: [Study; 3] = [
    Study {
        paper: 1,
        name: "1-rendezvous-fleets",
        scenario: "fixed-wing/rendezvous-7.toml",
        methods: SOLVERS,
        printed: &[
            Printed { label: "paper, customised", method: 0, vehicles: 7, flight_time_s: 256.63, planning_s: 3.0 },
            Printed { label: "paper, SeDuMi", method: 1, vehicles: 7, flight_time_s: 232.86, planning_s: 19.0 },
        ],
    },
    Study {
        paper: 1,
        name: "1-reconfiguration-fleets",
        scenario: "fixed-wing/reconfiguration-7.toml",
        methods: SOLVERS,
        printed: &[
            Printed { label: "paper, customised", method: 0, vehicles: 7, flight_time_s: 191.24, planning_s: 2.4 },
            Printed { label: "paper, SeDuMi", method: 1, vehicles: 7, flight_time_s: 191.91, planning_s: 13.1 },
        ],
    },
    Study {
        paper: 2,
        name: "2-methods",
        scenario: "fixed-wing/rendezvous-15.toml",
        methods: &[
            Method { label: "coupled", planner: "coupled-scp", solver: None, sizes: &[2, 3, 5] },
            Method { label: "serial priority", planner: "serial-scp", solver: None, sizes: &[2, 3, 5, 7] },
            Method { label: "parallel", planner: "parallel-scp", solver: None, sizes: &[2, 3, 5, 7, 10, 15] },
            Method { label: "dynamic priority (DPD)", planner: "dpd-scp", solver: None, sizes: &[2, 3, 5, 7, 10, 15] },
        ],
        printed: &[Printed {
            label: "paper, DPD",
            method: 3,
            vehicles: 15,
            flight_time_s: 174.4,
            planning_s: f64::NAN,
        }],
    },
];

/// Titles of the papers' sections.
const PAPERS: [&str; 4] = [
    "Fixed-wing fleets by parallel sequential convex programming (Wang, Xu, Long 2020)",
    "Large fleets by dynamic priorities (Xu, Wang, Cao, Sun, Long 2022)",
    "Receding horizon with particle swarms and cost maps",
    "A quadrotor with a slung load (Kang, Huang, Wen 2020)",
];

/// Every figure, table and claim of the papers with our result beside it.
const CLAIMS: &str = include_str!("claims.md");

/// The page, from which the drawings are in `figures/`.
pub fn page(figures: &[Figure]) -> String {
    let mut page = String::from(
        "# The papers' figures\n\nDrawn by `harness figures -o docs` from plans and simulated flights of this version. Where \
         a paper prints no positions, they are ours, so that figures are to be compared in their shape; where it prints \
         a number, it stands beside ours. Red lines are limits, red areas obstacles.\n\n",
    );
    page.push_str(CLAIMS);
    for (paper, title) in (1..).zip(PAPERS) {
        let of_paper: Vec<&Figure> = figures.iter().filter(|figure| figure.paper == paper).collect();
        if of_paper.is_empty() {
            continue;
        }
        page.push_str(&format!("\n## {title}\n"));
        for Figure { name, caption, .. } in of_paper {
            page.push_str(&format!("\n{caption}.\n\n![{name}](figures/{name}.svg)\n"));
        }
    }
    page
}
