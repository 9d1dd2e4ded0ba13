//! The shapes that a scene is made of. Lengths in m; widths and radii marked as such in points on the screen.

use serde::Serialize;

/// A shape.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Shape {
    /// Polylines.
    Lines(Lines),
    /// Points, with or without labels.
    Points(Points),
    /// Upright cylinders.
    Cylinders(Cylinders),
    /// The edges of a box.
    Box(BoxOutline),
    /// A sphere about the origin of its frame.
    Sphere(Sphere),
    /// A triangle mesh.
    Triangles(Triangles),
}

/// A colour with opacity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Paint {
    /// Red, green, blue.
    pub rgb: [u8; 3],
    /// In [0, 1].
    pub opacity: f64,
}

/// Text beside a shape.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Label {
    /// The text.
    pub text: String,
    /// Always shown, or only when the shape is pointed at?
    pub is_shown: bool,
}

/// Polylines.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Lines {
    /// The points of each line.
    pub strips: Vec<Vec<[f64; 3]>>,
    /// One for all lines, or one for each.
    pub paints: Vec<Paint>,
    /// Half the width, points on the screen: one for all lines, or one for each.
    pub radii: Vec<f32>,
    /// Label of all lines together.
    pub label: Option<Label>,
}

/// Points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Points {
    /// Where they are.
    pub positions_m: Vec<[f64; 3]>,
    /// One for all points, or one for each.
    pub paints: Vec<Paint>,
    /// Size of all of them.
    pub radius: Radius,
    /// No label, or one for each point.
    pub labels: Vec<String>,
    /// Are labels always shown, or only when a point is pointed at?
    pub are_labels_shown: bool,
}

/// Size of a point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Radius {
    /// Points on the screen, at any distance.
    Screen(f32),
    /// m.
    World(f64),
}

/// Upright cylinders, translucent with visible edges.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cylinders {
    /// Each of them.
    pub cylinders: Vec<Cylinder>,
    /// Colour of all of them.
    pub paint: Paint,
    /// Half the width of the edges, points on the screen.
    pub radius: f32,
}

/// An upright cylinder.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cylinder {
    /// Middle of its axis.
    pub centre_m: [f64; 3],
    /// Height.
    pub length_m: f64,
    /// Radius.
    pub radius_m: f64,
    /// Label.
    pub name: Option<String>,
}

/// The edges of an axis-aligned box.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BoxOutline {
    /// Centre.
    pub centre_m: [f64; 3],
    /// Half the lengths of its edges.
    pub half_size_m: [f64; 3],
    /// Colour.
    pub paint: Paint,
    /// Half the width of the edges, points on the screen.
    pub radius: f32,
    /// Label.
    pub label: Option<Label>,
}

/// A sphere, drawn as a wire frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Sphere {
    /// Radius.
    pub radius_m: f64,
    /// Colour.
    pub paint: Paint,
    /// Half the width of the lines, points on the screen.
    pub radius: f32,
}

/// A triangle mesh in one colour, visible from both sides.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Triangles {
    /// Corners of each triangle.
    pub triangles: Vec<[[f64; 3]; 3]>,
    /// Unit normal of each triangle.
    pub normals: Vec<[f64; 3]>,
    /// Colour.
    pub paint: Paint,
}

impl Shape {
    /// Number of points that it is made of.
    pub fn point_count(&self) -> usize {
        match self {
            Self::Lines(lines) => lines.strips.iter().map(Vec::len).sum(),
            Self::Points(points) => points.positions_m.len(),
            Self::Cylinders(cylinders) => cylinders.cylinders.len(),
            Self::Triangles(triangles) => 3 * triangles.triangles.len(),
            Self::Box(_) | Self::Sphere(_) => 1,
        }
    }
}

impl Paint {
    /// An opaque colour.
    pub fn opaque(rgb: [u8; 3]) -> Self {
        Self { rgb, opacity: 1.0 }
    }

    /// A translucent colour; `opacity` in [0, 1].
    pub fn translucent(rgb: [u8; 3], opacity: f64) -> Self {
        Self { rgb, opacity }
    }
}

impl Lines {
    /// Lines of one colour and width, without a label.
    pub fn new(strips: Vec<Vec<[f64; 3]>>, paint: Paint, radius: f32) -> Self {
        Self { strips, paints: vec![paint], radii: vec![radius], label: None }
    }

    /// With a label.
    pub fn labelled(self, text: impl Into<String>, is_shown: bool) -> Self {
        Self { label: Some(Label { text: text.into(), is_shown }), ..self }
    }
}

impl Points {
    /// A single point with a label.
    pub fn one(position_m: [f64; 3], rgb: [u8; 3], radius: f32, label: impl Into<String>, is_shown: bool) -> Self {
        Self {
            positions_m: vec![position_m],
            paints: vec![Paint::opaque(rgb)],
            radius: Radius::Screen(radius),
            labels: vec![label.into()],
            are_labels_shown: is_shown,
        }
    }
}

macro_rules! shape_from {
    ($($variant:ident($kind:ty)),*) => {$(
        impl From<$kind> for Shape {
            fn from(shape: $kind) -> Self {
                Self::$variant(shape)
            }
        }
    )*};
}

shape_from!(Lines(Lines), Points(Points), Cylinders(Cylinders), Box(BoxOutline), Sphere(Sphere), Triangles(Triangles));
