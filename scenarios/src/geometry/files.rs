//! Files of meshes and terrain: STL, OBJ, ESRI ASCII grid.
//!
//! The readers are our own, so that an error names the line, and that no number in a file decides how much memory is taken
//! before it has been compared with the size of the file.

mod esri_grid;
mod obj;
mod stl;

use super::{Placement, Surface, TerrainGrid};

/// Largest number of triangles of a mesh: some 2 GB in memory.
const MAX_TRIANGLES: usize = 8_000_000;
/// Largest number of corners of a terrain: 5000 by 5000.
const MAX_HEIGHTS: usize = 25_000_000;
/// Largest coordinate, m: beyond it rounding exceeds a micrometre.
const MAX_COORDINATE_M: f64 = 1e7;

/// What is wrong with the content of a file.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FileError {
    /// Line, from 1; `None` in a binary file, or of the file as a whole.
    pub line: Option<usize>,
    /// What was found.
    pub found: String,
    /// What was expected.
    pub expected: String,
    /// How to correct it.
    pub remedy: String,
}

impl FileError {
    fn new(found: impl Into<String>, expected: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { line: None, found: found.into(), expected: expected.into(), remedy: remedy.into() }
    }

    fn at_line(self, line: usize) -> Self {
        Self { line: Some(line), ..self }
    }
}

/// Corners and triangles as a file has them.
#[derive(Debug, Default, PartialEq)]
struct Polygons {
    corners: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
}

/// The surface in an STL or OBJ file, in the world frame.
///
/// - `extension`: that of the file, in lower case
///
/// # Errors
///
/// Another extension; a malformed, truncated, empty or huge file; coordinates that are not finite.
pub(crate) fn read_mesh(extension: &str, content: &[u8], placement: &Placement) -> Result<Surface, FileError> {
    let Polygons { corners, triangles } = match extension {
        "stl" => stl::read(content)?,
        "obj" => obj::read(text(content)?)?,
        other => {
            let remedy = "export it as STL or OBJ; meshes have no moving parts, so that one file is one rigid body";
            return Err(FileError::new(format!("a file name that ends in `.{other}`"), "`.stl` or `.obj`", remedy));
        }
    };
    let corners_m: Vec<[f64; 3]> = corners.iter().map(|corner| placement.to_world(*corner)).collect();
    let is_near = |coordinate: &f64| (-MAX_COORDINATE_M..=MAX_COORDINATE_M).contains(coordinate);
    if let Some(far) = corners_m.iter().flatten().find(|coordinate| !is_near(coordinate)) {
        let remedy = "check `scale` (0.001 for a file in millimetres) and `offset_m`";
        return Err(FileError::new(
            format!("a coordinate of {far} m"),
            format!("at most {MAX_COORDINATE_M} m"),
            remedy,
        ));
    }
    Surface::new(&corners_m, &triangles).map_err(|error| {
        FileError::new(error.to_string(), "triangles between corners of the file", "export the mesh again")
    })
}

/// The terrain in an ESRI ASCII grid, in the world frame.
///
/// # Errors
///
/// A malformed, truncated, empty or huge file; heights that are not finite.
pub(crate) fn read_terrain(content: &[u8], offset_m: [f64; 3]) -> Result<TerrainGrid, FileError> {
    esri_grid::read(text(content)?, offset_m)
}

fn text(content: &[u8]) -> Result<&str, FileError> {
    let binary = |_| FileError::new("bytes that are not text", "text in UTF-8", "export it as text, not as binary");
    std::str::from_utf8(content).map_err(binary)
}

/// A finite number.
fn number(word: &str) -> Result<f64, FileError> {
    match word.parse() {
        Ok(number) if f64::is_finite(number) => Ok(number),
        _ => Err(FileError::new(format!("`{word}`"), "a finite number", "correct the line, or export the file again")),
    }
}

#[cfg(test)]
mod tests;
