//! Wavefront OBJ: the lines `v` and `f`. Everything else, such as materials and groups, is ignored. Faces with more than three
//! corners are divided in a fan from the first, which is right if they are convex.

use super::{FileError, MAX_TRIANGLES, Polygons, number};

/// Reads a file.
pub fn read(content: &str) -> Result<Polygons, FileError> {
    let mut polygons = Polygons::default();
    for (index, line) in content.lines().enumerate() {
        let mut words = line.split_ascii_whitespace();
        let result = match words.next() {
            Some("v") => corner(words).map(|corner| polygons.corners.push(corner)),
            Some("f") => face(words, polygons.corners.len()).and_then(|face| add(&mut polygons, &face)),
            _ => Ok(()),
        };
        result.map_err(|error| error.at_line(index + 1))?;
    }
    if polygons.triangles.is_empty() {
        let found = format!("{} `v` lines and no face", polygons.corners.len());
        return Err(FileError::new(found, "at least one `f` line", "the file is empty or truncated: export it again"));
    }
    Ok(polygons)
}

/// The first three numbers; a weight or a colour may follow.
fn corner<'t>(words: impl Iterator<Item = &'t str>) -> Result<[f64; 3], FileError> {
    let numbers = words.take(3).map(number).collect::<Result<Vec<f64>, FileError>>()?;
    let found = format!("{} coordinates", numbers.len());
    numbers.try_into().map_err(|_| FileError::new(found, "three coordinates of a corner", "export the file again"))
}

/// Indices of the corners, from 0. In the file they count from 1, or back from -1, the last corner before the line.
fn face<'t>(words: impl Iterator<Item = &'t str>, count: usize) -> Result<Vec<u32>, FileError> {
    let index = |word: &str| {
        let first = word.split('/').next().unwrap_or_default();
        let unknown = || {
            let expected = format!("the index of one of the {count} corners above, from 1, or back from -1");
            FileError::new(format!("`{word}`"), expected, "correct the line, or export the file again")
        };
        let index: i64 = first.parse().map_err(|_| unknown())?;
        let from_zero = if index < 0 { count as i64 + index } else { index - 1 };
        if (0..count as i64).contains(&from_zero) { Ok(from_zero as u32) } else { Err(unknown()) }
    };
    let corners = words.map(index).collect::<Result<Vec<u32>, FileError>>()?;
    if corners.len() < 3 {
        let found = format!("a face with {} corners", corners.len());
        return Err(FileError::new(found, "at least three corners", "remove the line, or export the file again"));
    }
    Ok(corners)
}

fn add(polygons: &mut Polygons, face: &[u32]) -> Result<(), FileError> {
    polygons.triangles.extend(face.windows(2).skip(1).map(|pair| [face[0], pair[0], pair[1]]));
    if polygons.triangles.len() <= MAX_TRIANGLES {
        return Ok(());
    }
    let found = format!("more than {MAX_TRIANGLES} triangles");
    Err(FileError::new(found, format!("at most {MAX_TRIANGLES}"), "simplify the mesh, for example to centimetres"))
}
