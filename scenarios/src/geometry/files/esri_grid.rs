//! ESRI ASCII grid: a header of keys and numbers, then heights row by row from the north.

use std::collections::BTreeMap;

use super::{FileError, MAX_COORDINATE_M, MAX_HEIGHTS, number};
use crate::geometry::TerrainGrid;

const FORM: &str = "ncols, nrows, xllcorner and yllcorner (or xllcenter and yllcenter), cellsize";

/// Reads a file. The heights are those at the centres of the cells, which become the corners of triangles.
pub fn read(content: &str, offset_m: [f64; 3]) -> Result<TerrainGrid, FileError> {
    let is_header = |line: &&str| {
        line.trim_start().starts_with(|c: char| c.is_ascii_alphabetic())
            && !line.trim_start().to_ascii_lowercase().starts_with("nan")
    };
    let header_lines = content.lines().take_while(is_header).count();
    let header = Header::read(content.lines().take(header_lines))?;
    let [columns, rows] = header.size;
    let mut heights_m = vec![f64::NAN; columns * rows];
    let mut count = 0;
    for (index, line) in content.lines().enumerate().skip(header_lines) {
        for word in line.split_ascii_whitespace() {
            let height_m = number(word).map_err(|error| error.at_line(index + 1))?;
            let (row, column) = (count / columns, count % columns);
            if row == rows {
                return Err(miscounted(&header, "more").at_line(index + 1));
            }
            if Some(height_m) != header.no_data {
                heights_m[(rows - 1 - row) * columns + column] = in_range(height_m + offset_m[2], index + 1)?;
            }
            count += 1;
        }
    }
    if count < columns * rows {
        return Err(miscounted(&header, &count.to_string()));
    }
    let origin_m = std::array::from_fn(|axis| header.origin_m[axis] + offset_m[axis]);
    Ok(TerrainGrid::new(origin_m, header.cell_m, header.size, heights_m))
}

fn in_range(height_m: f64, line: usize) -> Result<f64, FileError> {
    if height_m.abs() <= MAX_COORDINATE_M {
        return Ok(height_m);
    }
    let remedy = "if it stands for missing data, give it as NODATA_value in the header";
    Err(FileError::new(format!("a height of {height_m} m"), format!("at most {MAX_COORDINATE_M} m"), remedy)
        .at_line(line))
}

fn miscounted(header: &Header, count: &str) -> FileError {
    let [columns, rows] = header.size;
    let expected = format!("{}: {rows} rows of {columns}", columns * rows);
    FileError::new(
        format!("{count} heights"),
        expected,
        "the file is truncated or its header is wrong: export it again",
    )
}

struct Header {
    size: [usize; 2],
    /// The centre of the cell in the south-west, m.
    origin_m: [f64; 2],
    cell_m: f64,
    no_data: Option<f64>,
}

impl Header {
    fn read<'t>(lines: impl Iterator<Item = &'t str>) -> Result<Self, FileError> {
        let mut values = BTreeMap::new();
        for (index, line) in lines.enumerate() {
            let mut words = line.split_ascii_whitespace();
            let key = words.next().unwrap_or_default().to_ascii_lowercase();
            values.insert(key, number(words.next().unwrap_or_default()).map_err(|error| error.at_line(index + 1))?);
        }
        let value = |key: &str| {
            let missing = || {
                FileError::new(format!("no `{key}`"), format!("a header with {FORM}"), "export it as ESRI ASCII grid")
            };
            values.get(key).copied().ok_or_else(missing)
        };
        let size = [size("ncols", value("ncols")?)?, size("nrows", value("nrows")?)?];
        if size[0] * size[1] > MAX_HEIGHTS {
            let remedy = "cut out the part under the map, or use larger cells";
            let found = format!("{} by {} heights", size[0], size[1]);
            return Err(FileError::new(found, format!("at most {MAX_HEIGHTS} in all"), remedy));
        }
        let cell_m = value("cellsize")?;
        if !(1e-3..=1e6).contains(&cell_m) {
            return Err(FileError::new(format!("a cellsize of {cell_m}"), "0.001 m to 1000 km", "give it in metres"));
        }
        let origin = |axis: &str| {
            let center = value(&format!("{axis}llcenter"));
            center.or_else(|_| Ok(value(&format!("{axis}llcorner"))? + cell_m / 2.0))
        };
        Ok(Self { size, origin_m: [origin("x")?, origin("y")?], cell_m, no_data: values.get("nodata_value").copied() })
    }
}

fn size(key: &str, value: f64) -> Result<usize, FileError> {
    if value.fract() == 0.0 && (2.0..=MAX_HEIGHTS as f64).contains(&value) {
        return Ok(value as usize);
    }
    let expected = format!("a whole number from 2 to {MAX_HEIGHTS}");
    Err(FileError::new(format!("{key} {value}"), expected, "export it as ESRI ASCII grid"))
}
