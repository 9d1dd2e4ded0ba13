//! What simulator and judge do not know for a family is refused, so that nothing is overlooked in silence.

use crate::{Family, Issue, Scenario};

pub(super) fn issues(scenario: &Scenario) -> Vec<Issue> {
    let first = scenario.vehicles.first().and_then(|vehicle| scenario.models.get(&vehicle.model));
    match first.map(|model| model.family()) {
        None => Vec::new(),
        Some(Family::FixedWing) => [among_cylinders(scenario), nothing_to_sense(scenario), no_gates(scenario)].concat(),
        Some(Family::SlungLoad) => [alone_among_flat_obstacles(scenario), nothing_to_sense(scenario)].concat(),
        Some(Family::Multirotor) => without_ground(scenario).into_iter().chain(no_gates(scenario)).collect(),
    }
}

fn nothing_to_sense(scenario: &Scenario) -> Vec<Issue> {
    let (hidden, moving) = (scenario.world.hidden.len(), scenario.world.moving.len());
    let counts = [("world.hidden", hidden), ("world.moving", moving)].into_iter().filter(|(_, count)| *count > 0);
    let issue = |(field, count): (&str, usize)| {
        Issue::new(field, format!("{count} of them"), "none: only multirotors sense obstacles")
    };
    counts.map(issue).collect()
}

fn no_gates(scenario: &Scenario) -> Vec<Issue> {
    let found = format!("{} of them", scenario.world.gates.len());
    let issue = Issue::new("world.gates", found, "none: gates are for quadrotors with slung loads");
    if scenario.world.gates.is_empty() { Vec::new() } else { vec![issue] }
}

fn without_ground(scenario: &Scenario) -> Option<Issue> {
    let ground_m = scenario.world.ground_m?;
    let expected = "nothing: multirotors stay above the map's lowest altitude";
    Some(Issue::new("world.ground_m", ground_m.to_string(), expected).remedy("remove it, and raise world.map.z_m"))
}

fn among_cylinders(scenario: &Scenario) -> Vec<Issue> {
    let (boxes, prisms) = (scenario.world.boxes.len(), scenario.world.prisms.len());
    let counts = [("world.boxes", boxes), ("world.prisms", prisms)].into_iter().filter(|(_, count)| *count > 0);
    let issue = |(field, count): (&str, usize)| {
        Issue::new(field, format!("{count} of them"), "none: fixed wings fly among cylinders")
            .remedy("put cylinders round them")
    };
    counts.map(issue).collect()
}

fn alone_among_flat_obstacles(scenario: &Scenario) -> Vec<Issue> {
    let (cylinders, vehicles) = (scenario.world.cylinders.len(), scenario.vehicles.len());
    let cylinders = (cylinders > 0).then(|| {
        let expected = "none: slung loads fly among boxes and prisms";
        Issue::new("world.cylinders", format!("{cylinders} of them"), expected).remedy("put prisms round them")
    });
    let fleet = (vehicles > 1).then(|| {
        Issue::new("vehicles", format!("{vehicles} of them"), "one: slung loads fly alone")
            .remedy("make a scenario of each")
    });
    cylinders.into_iter().chain(fleet).collect()
}
