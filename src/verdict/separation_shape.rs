/// How the distance between two vehicles is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SeparationShape {
    /// In the horizontal plane.
    Horizontal,
    /// In space.
    Spatial,
}
