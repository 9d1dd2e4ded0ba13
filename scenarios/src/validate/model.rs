//! Vehicle models: their names here, their parameters in the module of their family.

use super::identifier::entity_name;
use crate::{Issue, Models, Range, VehicleModel};

pub(super) fn issues(models: &Models) -> Vec<Issue> {
    let mut issues = Vec::new();
    for (name, model) in models.iter() {
        let field = format!("models.{}.{name}", model.family().key());
        issues.extend(entity_name(&field, name));
        issues.extend(model.issues(&field));
    }
    issues.extend(duplicate_names(models));
    issues
}

fn duplicate_names(models: &Models) -> Vec<Issue> {
    let issue = |(name, model): (&str, &dyn VehicleModel)| {
        let (family, other) = (model.family(), models.get(name)?.family());
        (family != other).then(|| {
            let expected = format!("a unique name; a {} model has the same", other.key());
            let field = format!("models.{}.{name}", family.key());
            Issue::new(field, format!("\"{name}\""), expected).remedy("rename one of them")
        })
    };
    models.iter().filter_map(issue).collect()
}

/// Planning limits that exceed the physical limits of the same name. Reversed ranges are reported elsewhere.
pub(crate) fn planning_inside_physical(
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
            .remedy("narrow the planning limits, or widen the physical ones if the vehicle allows it")
    };
    outside.map(issue).collect()
}
