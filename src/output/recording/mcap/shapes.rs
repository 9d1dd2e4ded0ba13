//! Shapes as Foxglove's scene entities.

use std::collections::BTreeMap;
use std::sync::Arc;

use foxglove::messages::{
    Color, CylinderPrimitive, LinePrimitive, Point3, Pose, Quaternion, SceneEntity, SceneUpdate, SpherePrimitive,
    TextPrimitive, TriangleListPrimitive, Vector3, line_primitive,
};
use foxglove::{Channel, Context};
use scenarios::Map;

use super::{INTERVAL_S, WORLD, channel, timestamp};
use crate::output::scene::{
    Animation, BoxOutline, Cylinders, Label, Lines, Paint, Points, Radius, Scene, Shape, Sphere, Triangles,
};

/// Diameter of a point of radius 4 on the screen as a fraction of the map's larger side: Foxglove's spheres have sizes in m.
const POINT_OF_MAP: f64 = 0.007;

/// Draws shapes on a map.
pub struct Artist {
    /// Diameter of a point of radius 1 on the screen, m.
    point_m: f64,
}

/// Logs everything in space except bodies: what never changes on `/world`, the rest on a topic for each item.
pub fn log(context: &Arc<Context>, scene: &Scene<'_>, artist: &Artist) {
    let world: Channel<SceneUpdate> = channel(context, "/world");
    let entities = scene.items.iter().map(|item| artist.entity(&item.path.join("/"), WORLD, 0.0, &item.shape));
    world.log_with_time(&update(entities.collect()), timestamp(0.0));
    let mut topics: BTreeMap<String, Channel<SceneUpdate>> = BTreeMap::new();
    let mut log = |path: &[String], t_s: f64, shape: &Shape| {
        let name = topic(path);
        let channel = topics.entry(name.clone()).or_insert_with(|| channel(context, &name));
        let entity = artist.entity(&path.join("/"), WORLD, t_s, shape);
        channel.log_with_time(&update(vec![entity]), timestamp(t_s));
    };
    for changes in &scene.changes {
        changes.shapes.iter().for_each(|(t_s, shape)| log(&changes.path, *t_s, shape));
    }
    for animation in &scene.animations {
        frames(animation).into_iter().for_each(|(t_s, shape)| log(&animation.path, t_s, &shape));
    }
}

/// Entities for one message.
pub fn update(entities: Vec<SceneEntity>) -> SceneUpdate {
    SceneUpdate { deletions: Vec::new(), entities }
}

/// The first two names of a path: parts of one item share a topic.
fn topic(path: &[String]) -> String {
    let names = path.iter().take(2).map(String::as_str);
    names.map(|name| format!("/{name}")).collect()
}

/// The shape of an animation every [`INTERVAL_S`] on average.
fn frames(animation: &Animation) -> Vec<(f64, Shape)> {
    let mut frames: Vec<(f64, Shape)> = Vec::new();
    let mut due_s = f64::NEG_INFINITY;
    for (index, (t_s, strip)) in animation.times_s.iter().zip(&animation.strips).enumerate() {
        if *t_s < due_s {
            continue;
        }
        due_s = (due_s + INTERVAL_S).max(*t_s);
        let paint = element(&animation.paints, index);
        let paints = paint.into_iter().collect();
        let lines = Lines { strips: vec![strip.clone()], paints, radii: vec![animation.radius], label: None };
        frames.push((*t_s, lines.into()));
    }
    frames
}

impl Artist {
    /// For a map.
    pub fn new(map: &Map) -> Self {
        Self { point_m: POINT_OF_MAP / 4.0 * map.x_m.width().max(map.y_m.width()) }
    }

    /// A shape in the frame `frame`.
    pub fn entity(&self, id: &str, frame: &str, t_s: f64, shape: &Shape) -> SceneEntity {
        let mut entity = SceneEntity {
            timestamp: Some(timestamp(t_s)),
            frame_id: frame.to_owned(),
            id: id.to_owned(),
            ..SceneEntity::default()
        };
        self.add(&mut entity, shape);
        entity
    }

    /// Adds a shape to an entity.
    pub fn add(&self, entity: &mut SceneEntity, shape: &Shape) {
        match shape {
            Shape::Lines(lines) => add_lines(entity, lines),
            Shape::Points(points) => self.add_points(entity, points),
            Shape::Cylinders(cylinders) => add_cylinders(entity, cylinders),
            Shape::Box(outline) => add_box(entity, outline),
            Shape::Sphere(sphere) => add_sphere(entity, sphere),
            Shape::Triangles(triangles) => add_triangles(entity, triangles),
        }
    }

    /// A label that is shown only when its point is pointed at is left out: Foxglove has no such labels.
    fn add_points(&self, entity: &mut SceneEntity, points: &Points) {
        let size_m = match points.radius {
            Radius::Screen(radius) => self.point_m * f64::from(radius),
            Radius::World(radius_m) => 2.0 * radius_m,
        };
        for (index, position_m) in points.positions_m.iter().enumerate() {
            let Some(paint) = element(&points.paints, index) else { continue };
            entity.spheres.push(SpherePrimitive {
                pose: Some(at(*position_m)),
                size: Some(Vector3 { x: size_m, y: size_m, z: size_m }),
                color: Some(color(paint)),
            });
            if let Some(label) = points.labels.get(index).filter(|_| points.are_labels_shown) {
                entity.texts.push(text(label, *position_m, paint));
            }
        }
    }
}

/// Many lines of one colour and width become one list of segments.
fn add_lines(entity: &mut SceneEntity, lines: &Lines) {
    use line_primitive::Type::{LineList, LineStrip};
    match (lines.paints.as_slice(), lines.radii.as_slice()) {
        ([paint], [radius]) if lines.strips.len() > 1 => {
            let segments = lines.strips.iter().flat_map(|strip| strip.windows(2)).flatten().copied();
            entity.lines.push(line(segments.collect(), *paint, *radius, LineList));
        }
        _ => {
            for (index, strip) in lines.strips.iter().enumerate() {
                let (Some(paint), Some(radius)) = (element(&lines.paints, index), element(&lines.radii, index)) else {
                    continue;
                };
                entity.lines.push(line(strip.clone(), paint, radius, LineStrip));
            }
        }
    }
    let anchor = lines.strips.first().and_then(|strip| centre_m(strip));
    if let (Some(label), Some(position_m), Some(paint)) = (&lines.label, anchor, lines.paints.first()) {
        entity.texts.push(text(&label.text, position_m, *paint));
    }
}

fn add_cylinders(entity: &mut SceneEntity, Cylinders { cylinders, paint, .. }: &Cylinders) {
    for cylinder in cylinders {
        let diameter_m = 2.0 * cylinder.radius_m;
        entity.cylinders.push(CylinderPrimitive {
            pose: Some(at(cylinder.centre_m)),
            size: Some(Vector3 { x: diameter_m, y: diameter_m, z: cylinder.length_m }),
            bottom_scale: 1.0,
            top_scale: 1.0,
            // Foxglove draws no edges; without them a surface has to be fainter not to hide what is inside.
            color: Some(color(Paint { opacity: 0.6 * paint.opacity, ..*paint })),
        });
        if let Some(name) = &cylinder.name {
            let [x, y, z] = cylinder.centre_m;
            entity.texts.push(text(name, [x, y, z + cylinder.length_m / 2.0], *paint));
        }
    }
}

fn add_box(entity: &mut SceneEntity, BoxOutline { centre_m, half_size_m, paint, radius, label }: &BoxOutline) {
    let corner = |i: usize| {
        let side = |axis: usize| if i >> axis & 1 == 0 { -1.0 } else { 1.0 };
        std::array::from_fn(|axis| centre_m[axis] + side(axis) * half_size_m[axis])
    };
    // Every edge joins two corners whose numbers differ in one bit.
    let edges = (0..8).flat_map(|i| [1, 2, 4].map(|bit| (i, i | bit))).filter(|(from, to)| from != to);
    let points = edges.flat_map(|(from, to)| [corner(from), corner(to)]).collect();
    entity.lines.push(line(points, *paint, *radius, line_primitive::Type::LineList));
    if let Some(Label { text: name, .. }) = label {
        entity.texts.push(text(name, *centre_m, *paint));
    }
}

fn add_sphere(entity: &mut SceneEntity, Sphere { radius_m, paint, .. }: &Sphere) {
    let diameter_m = 2.0 * radius_m;
    entity.spheres.push(SpherePrimitive {
        pose: Some(at([0.0; 3])),
        size: Some(Vector3 { x: diameter_m, y: diameter_m, z: diameter_m }),
        color: Some(color(*paint)),
    });
}

fn add_triangles(entity: &mut SceneEntity, Triangles { triangles, paint, .. }: &Triangles) {
    entity.triangles.push(TriangleListPrimitive {
        pose: Some(at([0.0; 3])),
        points: triangles.iter().flatten().copied().map(point).collect(),
        color: Some(color(*paint)),
        ..TriangleListPrimitive::default()
    });
}

/// The element of `index` of a list with one element for all, or one for each.
fn element<T: Copy>(values: &[T], index: usize) -> Option<T> {
    values.get(index).or(values.first()).copied()
}

fn centre_m(points: &[[f64; 3]]) -> Option<[f64; 3]> {
    let count = points.len() as f64;
    let mean = std::array::from_fn(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / count);
    (!points.is_empty()).then_some(mean)
}

fn line(points: Vec<[f64; 3]>, paint: Paint, radius: f32, kind: line_primitive::Type) -> LinePrimitive {
    LinePrimitive {
        r#type: kind as i32,
        pose: Some(at([0.0; 3])),
        thickness: 2.0 * f64::from(radius),
        scale_invariant: true,
        points: points.into_iter().map(point).collect(),
        color: Some(color(paint)),
        ..LinePrimitive::default()
    }
}

fn text(text: &str, position_m: [f64; 3], paint: Paint) -> TextPrimitive {
    TextPrimitive {
        pose: Some(at(position_m)),
        billboard: true,
        font_size: 12.0,
        scale_invariant: true,
        color: Some(color(Paint { opacity: 1.0, ..paint })),
        text: text.to_owned(),
    }
}

fn at([x, y, z]: [f64; 3]) -> Pose {
    Pose { position: Some(Vector3 { x, y, z }), orientation: Some(Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }) }
}

fn point([x, y, z]: [f64; 3]) -> Point3 {
    Point3 { x, y, z }
}

fn color(Paint { rgb, opacity }: Paint) -> Color {
    let [r, g, b] = rgb.map(|channel| f64::from(channel) / 255.0);
    Color { r, g, b, a: opacity }
}
