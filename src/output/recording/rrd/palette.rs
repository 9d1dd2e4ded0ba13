//! The colours of recordings as the viewer takes them.

use rerun::Color;

pub use crate::output::recording::colours::*;

/// An opaque colour.
pub fn opaque([r, g, b]: [u8; 3]) -> Color {
    Color::from_rgb(r, g, b)
}

/// A translucent colour; `opacity` in [0, 1].
pub fn translucent([r, g, b]: [u8; 3], opacity: f64) -> Color {
    Color::from_unmultiplied_rgba(r, g, b, (255.0 * opacity) as u8)
}
