use super::{read_mesh, read_terrain};
use crate::geometry::Placement;
use crate::geometry::round::box_triangles;

fn placement(scale: f64) -> Placement {
    Placement::new(scale, [0.0; 3], [0.0; 3])
}

/// A box of these half sizes as a binary STL file.
fn binary(half_size: [f64; 3]) -> Vec<u8> {
    let triangles = box_triangles(half_size);
    let mut bytes = vec![0; 80];
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([0; 12]);
        triangle.iter().flatten().for_each(|it| bytes.extend((*it as f32).to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

fn text(half_size: [f64; 3]) -> String {
    let facet = |triangle: &[[f64; 3]; 3]| {
        let corners = triangle.map(|[x, y, z]| format!("vertex {x} {y} {z}\n")).concat();
        format!("facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet\n")
    };
    let facets: Vec<String> = box_triangles(half_size).iter().map(facet).collect();
    format!("solid box\n{}endsolid box\n", facets.concat())
}

/// A unit cube with corners from 0 to 1, as quadrilaterals.
const CUBE: &str = "# a cube\no cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nvn 0 0 1\n\
    f 1//1 4//1 3//1 2//1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf -5 -8 -4 -1\n";

#[test]
fn the_same_box_is_read_from_every_format() {
    let half = [0.5, 1.0, 1.5];
    let files = [("stl", binary(half)), ("stl", text(half).into_bytes())];
    for (extension, content) in files {
        let surface = read_mesh(extension, &content, &placement(1e-3)).unwrap();
        assert!(surface.is_closed() && surface.triangle_count() == 12);
        assert_eq!(surface.bounds_m(), [half.map(|it| -it * 1e-3), half.map(|it| it * 1e-3)]);
    }
    let cube = read_mesh("obj", CUBE.as_bytes(), &placement(2.0)).unwrap();
    assert!(cube.is_closed() && cube.triangle_count() == 12 && cube.bounds_m() == [[0.0; 3], [2.0; 3]]);
}

#[test]
fn spoilt_meshes_are_refused_with_line_and_remedy() {
    let error = |extension: &str, content: &[u8]| read_mesh(extension, content, &placement(1.0)).unwrap_err();
    let whole = binary([1.0; 3]);
    let mut huge = whole[..84].to_vec();
    huge[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let mut not_finite = whole.clone();
    not_finite[84 + 12..84 + 16].copy_from_slice(&f32::NAN.to_le_bytes());
    for content in [&[][..], &whole[..50], &whole[..whole.len() - 1], &huge, &not_finite] {
        let error = error("stl", content);
        assert!(!error.found.is_empty() && !error.remedy.is_empty(), "{error:?}");
    }
    assert!(error("stl", &not_finite).found.contains("triangle 1 of 12"));
    let truncated = text([1.0; 3]);
    assert!(error("stl", &truncated.as_bytes()[..truncated.len() / 2]).remedy.contains("truncated"));
    assert_eq!(error("stl", truncated.replacen("vertex -1", "vertex nan", 1).as_bytes()).line, Some(4));
    assert_eq!(error("obj", CUBE.replace("f 5 6 7 8", "f 5 6 7 9").as_bytes()).line, Some(13));
    assert_eq!(error("obj", CUBE.replace("f 5 6 7 8", "f 0 6 7 8").as_bytes()).line, Some(13));
    assert!(error("obj", b"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n").found.contains("no triangle with an area"));
    assert!(error("obj", b"").found.contains("no face"));
    assert!(error("ply", b"ply").expected.contains(".stl"));
    let far = read_mesh("obj", CUBE.as_bytes(), &placement(1e9)).unwrap_err();
    assert!(far.remedy.contains("0.001"));
}

const GRID: &str = "NCOLS 3\nNROWS 2\nXLLCORNER 95\nYLLCENTER 200\nCELLSIZE 10\nNODATA_value -9999\n1 2 3\n4 5 -9999\n";

#[test]
fn a_grid_lies_where_its_header_says() {
    let grid = read_terrain(GRID.as_bytes(), [-100.0, -200.0, 1.0]).unwrap();
    assert_eq!(grid.extent_m(), [[0.0, 20.0], [0.0, 10.0]]);
    // The first row is the northern one.
    assert_eq!((grid.height_m(0.0, 10.0), grid.height_m(5.0, 0.0)), (Some(2.0), Some(5.5)));
    assert_eq!(grid.gap_m([0.0, 5.0], [0.0, 10.0]), None);
    assert_eq!(grid.gap_m([0.0, 15.0], [0.0, 10.0]), Some([20.0, 0.0]));
}

#[test]
fn spoilt_grids_are_refused_with_line_and_remedy() {
    let error = |from: &str, to: &str| read_terrain(GRID.replace(from, to).as_bytes(), [0.0; 3]).unwrap_err();
    assert!(error("4 5 -9999", "4 5").found.contains("5 heights"));
    assert_eq!(error("4 5 -9999", "4 5 6 7").line, Some(8));
    assert_eq!(error("1 2 3", "1 nan 3").line, Some(7));
    assert!(error("1 2 3", "1 2 -3.4e38").remedy.contains("NODATA_value"));
    assert!(error("CELLSIZE 10\n", "").found.contains("cellsize"));
    assert!(error("NCOLS 3", "NCOLS 300000000").found.contains("ncols"));
    assert!(read_terrain(&[0xff, 0xfe, 0, 1], [0.0; 3]).is_err() && read_terrain(b"", [0.0; 3]).is_err());
}
