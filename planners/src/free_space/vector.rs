//! Vectors of three components.

/// A position in m, a velocity in m/s or an acceleration in m/s²; world frame.
pub type Point = [f64; 3];

/// a + b.
pub fn plus(a: Point, b: Point) -> Point {
    std::array::from_fn(|axis| a[axis] + b[axis])
}

/// a - b.
pub fn minus(a: Point, b: Point) -> Point {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

/// factor · a.
pub fn scaled(a: Point, factor: f64) -> Point {
    a.map(|component| factor * component)
}

/// a · b.
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Length of a.
pub fn norm(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// Distance of two points.
pub fn distance(a: Point, b: Point) -> f64 {
    norm(minus(a, b))
}

/// The point at `share` of the way from a to b.
pub fn interpolate(a: Point, b: Point, share: f64) -> Point {
    std::array::from_fn(|axis| a[axis] + share * (b[axis] - a[axis]))
}

/// The nearest vector that is no longer than `most`.
pub fn shortened(a: Point, most: f64) -> Point {
    let length = norm(a);
    if length > most { scaled(a, most / length) } else { a }
}
