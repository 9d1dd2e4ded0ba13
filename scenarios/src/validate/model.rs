//! Vehicle models: their names here, the rest by family.

mod fixed_wing;
mod multirotor;
mod slung_load;

use crate::{Issue, Models, Range};

pub(super) fn issues(models: &Models) -> Vec<Issue> {
    let fixed_wing = models.fixed_wing.iter().flat_map(|(name, model)| fixed_wing::issues(name, model));
    let slung_load = models.slung_load.iter().flat_map(|(name, model)| slung_load::issues(name, model));
    let multirotor = models.multirotor.iter().flat_map(|(name, model)| multirotor::issues(name, model));
    fixed_wing.chain(slung_load).chain(multirotor).chain(names_of_two_families(models)).collect()
}

fn names_of_two_families(models: &Models) -> Vec<Issue> {
    let issue = |family: &str, name: &String, other: &str| {
        let expected = format!("a name of its own; a {other} model has this one already");
        Issue::new(format!("models.{family}.{name}"), format!("\"{name}\""), expected).remedy("rename one of the two")
    };
    let is_fixed_wing = |name: &&String| models.fixed_wing.contains_key(*name);
    let slung = models.slung_load.keys().filter(is_fixed_wing).map(|name| issue("slung-load", name, "fixed-wing"));
    let multirotors = models.multirotor.keys().filter_map(|name| {
        let other = if is_fixed_wing(&name) { "fixed-wing" } else { "slung-load" };
        (is_fixed_wing(&name) || models.slung_load.contains_key(name)).then(|| issue("multirotor", name, other))
    });
    slung.chain(multirotors).collect()
}

/// Ranges of planning limits that reach beyond the physical ones of the same name. What is not in order says nothing.
fn planning_inside_physical(
    field: &str,
    planning: impl IntoIterator<Item = (&'static str, Range)>,
    physical: impl IntoIterator<Item = (&'static str, Range)>,
) -> Vec<Issue> {
    let outside = planning.into_iter().zip(physical).filter(|((_, planning), (_, physical))| {
        physical.min < physical.max && (planning.min < physical.min || planning.max > physical.max)
    });
    let issue = |((name, planning), (_, physical)): ((&str, Range), (&str, Range))| {
        let expected = format!("a range inside {physical}, the physical limits ({field}.limits.{name})");
        Issue::new(format!("{field}.planning_limits.{name}"), planning.to_string(), expected)
            .remedy("narrow the planning limits, or widen the physical ones if the vehicle can do more")
    };
    outside.map(issue).collect()
}
