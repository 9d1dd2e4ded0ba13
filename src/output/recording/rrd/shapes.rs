//! Shapes as rerun's archetypes, below `/world`.

use rerun::components::FillMode;
use rerun::{
    AsComponents, Boxes3D, Color, Cylinders3D, Ellipsoids3D, EntityPath, EntityPathPart, LineStrips3D, Mesh3D,
    Points3D, RecordingStream, ViewCoordinates,
};

use super::{Logged, SIM_TIME, sim_times, to_f32};
use crate::output::scene::{
    Animation, BoxOutline, Cylinders, Label, Lines, Paint, Points, Radius, Scene, Shape, Sphere, Triangles,
};

/// Logs everything in space except bodies.
pub fn log(stream: &RecordingStream, scene: &Scene<'_>) -> Logged {
    stream.log_static("world", &ViewCoordinates::RIGHT_HAND_Z_UP())?;
    for item in &scene.items {
        stream.log_static(world_path(&item.path), archetype(&item.shape)?.as_ref())?;
    }
    for changes in &scene.changes {
        for (t_s, shape) in &changes.shapes {
            stream.set_duration_secs(SIM_TIME, *t_s);
            stream.log(world_path(&changes.path), archetype(shape)?.as_ref())?;
        }
    }
    stream.reset_time();
    scene.animations.iter().try_for_each(|animation| log_animation(stream, animation))
}

/// The entity of an item, whatever characters its names have.
pub fn world_path(names: &[String]) -> EntityPath {
    let names = names.iter().map(|name| EntityPathPart::new(name.as_str()));
    EntityPath::new([EntityPathPart::new("world")].into_iter().chain(names).collect())
}

/// The archetype of a shape.
pub fn archetype(shape: &Shape) -> Result<Box<dyn AsComponents>, Box<dyn std::error::Error + Send + Sync>> {
    Ok(match shape {
        Shape::Lines(lines) => Box::new(line_strips(lines)),
        Shape::Points(points) => Box::new(points_3d(points)),
        Shape::Cylinders(cylinders) => Box::new(cylinders_3d(cylinders)),
        Shape::Box(outline) => Box::new(boxes(outline)),
        Shape::Sphere(sphere) => Box::new(ellipsoids(sphere)),
        Shape::Triangles(triangles) => Box::new(mesh(triangles)),
    })
}

pub fn color(Paint { rgb: [r, g, b], opacity }: Paint) -> Color {
    Color::from_unmultiplied_rgba(r, g, b, (255.0 * opacity) as u8)
}

/// Radius in points on the screen.
fn screen(radius: f32) -> rerun::Radius {
    rerun::Radius::new_ui_points(radius)
}

fn colors(paints: &[Paint]) -> impl Iterator<Item = Color> {
    paints.iter().copied().map(color)
}

fn strip(points: &[[f64; 3]]) -> Vec<[f32; 3]> {
    points.iter().copied().map(to_f32).collect()
}

/// What changes is sent in columns, what does not is static.
fn log_animation(stream: &RecordingStream, animation: &Animation) -> Logged {
    let path = world_path(&animation.path);
    let style = LineStrips3D::update_fields().with_radii([screen(animation.radius)]);
    let lines = LineStrips3D::update_fields().with_strips(animation.strips.iter().map(|points| strip(points)));
    let (style, lines) = match animation.paints.as_slice() {
        [paint] => (style.with_colors([color(*paint)]), lines),
        paints => (style, lines.with_colors(colors(paints))),
    };
    stream.log_static(path.clone(), &style)?;
    let times = sim_times(animation.times_s.iter().copied());
    Ok(stream.send_columns(path, [times], lines.columns_of_unit_batches()?)?)
}

fn line_strips(Lines { strips, paints, radii, label }: &Lines) -> LineStrips3D {
    let lines = LineStrips3D::new(strips.iter().map(|points| strip(points)))
        .with_colors(colors(paints))
        .with_radii(radii.iter().copied().map(screen));
    match label {
        Some(Label { text, is_shown }) => lines.with_labels([text.as_str()]).with_show_labels(*is_shown),
        None => lines,
    }
}

fn points_3d(Points { positions_m, paints, radius, labels, are_labels_shown }: &Points) -> Points3D {
    let radius = match radius {
        Radius::Screen(points) => screen(*points),
        Radius::World(radius_m) => rerun::Radius::new_scene_units(*radius_m as f32),
    };
    let points = Points3D::new(strip(positions_m)).with_colors(colors(paints)).with_radii([radius]);
    if labels.is_empty() {
        return points;
    }
    points.with_labels(labels.iter().map(String::as_str)).with_show_labels(*are_labels_shown)
}

fn cylinders_3d(Cylinders { cylinders, paint, radius }: &Cylinders) -> Cylinders3D {
    let solid = Cylinders3D::from_lengths_and_radii(
        cylinders.iter().map(|cylinder| cylinder.length_m as f32),
        cylinders.iter().map(|cylinder| cylinder.radius_m as f32),
    )
    .with_centers(cylinders.iter().map(|cylinder| to_f32(cylinder.centre_m)))
    .with_colors([color(*paint)])
    .with_line_radii([screen(*radius)])
    .with_fill_mode(FillMode::TransparentFillMajorWireframe);
    match cylinders.iter().map(|cylinder| cylinder.name.as_deref()).collect::<Option<Vec<_>>>() {
        Some(names) => solid.with_labels(names),
        None => solid,
    }
}

fn boxes(BoxOutline { centre_m, half_size_m, paint, radius, label }: &BoxOutline) -> Boxes3D {
    let outline = Boxes3D::from_centers_and_half_sizes([to_f32(*centre_m)], [to_f32(*half_size_m)])
        .with_fill_mode(FillMode::MajorWireframe)
        .with_colors([color(*paint)])
        .with_radii([screen(*radius)]);
    match label {
        Some(Label { text, is_shown }) => outline.with_labels([text.as_str()]).with_show_labels(*is_shown),
        None => outline,
    }
}

fn ellipsoids(Sphere { radius_m, paint, radius }: &Sphere) -> Ellipsoids3D {
    Ellipsoids3D::from_half_sizes([[*radius_m as f32; 3]])
        .with_colors([color(*paint)])
        .with_line_radii([screen(*radius)])
        .with_fill_mode(FillMode::MajorWireframe)
}

fn mesh(Triangles { triangles, normals, paint }: &Triangles) -> Mesh3D {
    let indices = (0..triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    Mesh3D::new(triangles.iter().flatten().copied().map(to_f32))
        .with_vertex_normals(normals.iter().flat_map(|normal| [to_f32(*normal); 3]))
        .with_triangle_indices(indices)
        .with_albedo_factor(color(*paint).0)
}
