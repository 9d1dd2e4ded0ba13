//! Labels in space that would cover each other.

use super::{Lines, Scene, Shape, colours, distance_m};

/// Width of a label, as a fraction of the diagonal of what is flown through.
const LABEL_WIDTH: f64 = 0.12;

/// Hides the names of the goals where a closest approach or a crash is marked near one of them, and the label of a closest
/// approach near another one that violates its limit, or comes first. Hidden labels show when their shape is pointed at.
pub(super) fn separate(scene: &mut Scene<'_>) {
    let Some(action) = scene.action else { return };
    let near_m = LABEL_WIDTH * distance_m(action.min_m, action.max_m);
    separate_marks(scene, near_m);
    let marks_m: Vec<[f64; 3]> = scene.items.iter().filter_map(|item| mark_m(&item.path[0], &item.shape)).collect();
    let goals = scene.items.iter_mut().find(|item| item.path == ["ends", "goals"]);
    if let Some(Shape::Points(goals)) = goals.map(|item| &mut item.shape) {
        let is_near = |goal_m: &[f64; 3]| marks_m.iter().any(|mark_m| distance_m(*goal_m, *mark_m) < near_m);
        goals.are_labels_shown &= !goals.positions_m.iter().any(is_near);
    }
}

fn separate_marks(scene: &mut Scene<'_>, near_m: f64) {
    let mut shown_m: Vec<[f64; 3]> = Vec::new();
    let mut marks: Vec<&mut Lines> = Vec::new();
    for item in scene.items.iter_mut().filter(|item| item.path[0] == "closest") {
        if let Shape::Lines(lines) = &mut item.shape {
            marks.push(lines);
        }
    }
    marks.sort_by_key(|lines| lines.paints.first().is_none_or(|paint| paint.rgb != colours::LIMIT));
    for lines in marks {
        let Some(at_m) = lines.strips.first().and_then(|strip| strip.first()).copied() else { continue };
        let is_covered = shown_m.iter().any(|other_m| distance_m(*other_m, at_m) < near_m);
        match &mut lines.label {
            Some(label) if is_covered => label.is_shown = false,
            _ => shown_m.push(at_m),
        }
    }
}

/// Where the label of a mark stands, m.
fn mark_m(kind: &str, shape: &Shape) -> Option<[f64; 3]> {
    match (kind, shape) {
        ("closest", Shape::Lines(lines)) => lines.strips.first()?.first().copied(),
        ("crashed", Shape::Points(points)) => points.positions_m.first().copied(),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Extent, Lines, Paint, Scene, Shape, colours};
    use super::separate;

    /// Marks at these places on a map of 100 m, with their colours; which of their labels are shown.
    fn shown(marks: &[(f64, [u8; 3])]) -> Vec<bool> {
        let extent = Extent { min_m: [0.0; 3], max_m: [100.0, 0.0, 0.0] };
        let mut scene = Scene { action: Some(extent), ..Scene::default() };
        for (index, (x_m, rgb)) in marks.iter().enumerate() {
            let line = Lines::new(vec![vec![[*x_m, 0.0, 0.0], [*x_m, 1.0, 0.0]]], Paint::opaque(*rgb), 1.0);
            scene.add_item(&["closest", &index.to_string()], line.labelled("mark", true));
        }
        separate(&mut scene);
        let label = |shape: &Shape| matches!(shape, Shape::Lines(lines) if lines.label.as_ref().unwrap().is_shown);
        scene.items.iter().map(|item| label(&item.shape)).collect()
    }

    #[test]
    fn of_two_labels_in_one_place_that_of_the_violation_is_shown() {
        assert_eq!(shown(&[(10.0, colours::KEPT), (90.0, colours::KEPT)]), [true, true]);
        assert_eq!(shown(&[(10.0, colours::KEPT), (12.0, colours::KEPT)]), [true, false]);
        assert_eq!(shown(&[(10.0, colours::KEPT), (12.0, colours::LIMIT)]), [false, true]);
    }
}
