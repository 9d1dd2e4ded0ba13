//! STL, binary and text. Normals are ignored: the order of the corners gives the orientation.

use super::{FileError, MAX_TRIANGLES, Polygons, number, text};

const HEADER_BYTES: usize = 84;
const TRIANGLE_BYTES: usize = 50;

/// Reads a file. A binary file is known by its length, since the headers of some begin with `solid`, too.
pub fn read(content: &[u8]) -> Result<Polygons, FileError> {
    let stated = content.get(80..84).map(|bytes| u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]) as usize);
    let is_binary =
        |count: usize| count.checked_mul(TRIANGLE_BYTES).is_some_and(|it| it + HEADER_BYTES == content.len());
    match stated {
        Some(count) if is_binary(count) => read_binary(&content[HEADER_BYTES..], count),
        _ if content.trim_ascii_start().starts_with(b"solid") && text(content).is_ok() => read_text(text(content)?),
        Some(count) => {
            let found = format!("{} bytes, with {count} triangles in the header", content.len());
            let expected =
                format!("{HEADER_BYTES} bytes and {TRIANGLE_BYTES} for each triangle, or text after `solid`");
            Err(FileError::new(found, expected, "the file is truncated or no STL: export or download it again"))
        }
        None => Err(FileError::new(
            format!("{} bytes", content.len()),
            format!("at least {HEADER_BYTES} bytes, or text after `solid`"),
            "the file is empty or truncated: export it again",
        )),
    }
}

fn read_binary(content: &[u8], count: usize) -> Result<Polygons, FileError> {
    bounded(count)?;
    let coordinate = |bytes: &[u8]| f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
    let corner = |bytes: &[u8]| [0, 4, 8].map(|at| coordinate(&bytes[at..]));
    let corners: Vec<[f64; 3]> =
        content.chunks_exact(TRIANGLE_BYTES).flat_map(|bytes| [12, 24, 36].map(|at| corner(&bytes[at..]))).collect();
    if let Some(at) = corners.iter().position(|corner| !corner.iter().all(|it| it.is_finite())) {
        let found = format!("a corner that is not finite, in triangle {} of {count}", at / 3 + 1);
        return Err(FileError::new(found, "finite coordinates", "repair the mesh, or export it again"));
    }
    Ok(soup(corners))
}

fn read_text(content: &str) -> Result<Polygons, FileError> {
    let mut corners = Vec::new();
    for (index, line) in content.lines().enumerate() {
        let mut words = line.split_ascii_whitespace();
        if words.next() == Some("vertex") {
            corners.push(corner(words).map_err(|error| error.at_line(index + 1))?);
        }
        bounded(corners.len() / 3)?;
    }
    let has_end =
        content.lines().rev().find(|line| !line.trim().is_empty()).is_some_and(|it| it.trim().starts_with("endsolid"));
    if corners.is_empty() || corners.len() % 3 != 0 || !has_end {
        let found =
            format!("{} corners and {} `endsolid` at the end", corners.len(), if has_end { "an" } else { "no" });
        let expected = "three `vertex` lines for each triangle, and `endsolid` at the end";
        return Err(FileError::new(found, expected, "the file is empty or truncated: export it again"));
    }
    Ok(soup(corners))
}

fn corner<'t>(words: impl Iterator<Item = &'t str>) -> Result<[f64; 3], FileError> {
    let numbers = words.map(number).collect::<Result<Vec<f64>, FileError>>()?;
    let found = format!("{} coordinates", numbers.len());
    numbers.try_into().map_err(|_| FileError::new(found, "three coordinates of a corner", "export the file again"))
}

/// Triangles of three corners each.
fn soup(corners: Vec<[f64; 3]>) -> Polygons {
    let triangles = (0..corners.len() as u32 / 3).map(|index| [0, 1, 2].map(|corner| 3 * index + corner)).collect();
    Polygons { corners, triangles }
}

/// The number of triangles is at least one and not too large.
fn bounded(count: usize) -> Result<(), FileError> {
    if count <= MAX_TRIANGLES {
        return Ok(());
    }
    let expected = format!("at most {MAX_TRIANGLES} triangles");
    Err(FileError::new(format!("{count} triangles"), expected, "simplify the mesh, for example to centimetres"))
}
