//! The files that a world refers to. Their paths are relative to the folder of the scenario file; from then on they are
//! absolute, so that a scenario that is written to another folder, or sent to an external planner, still finds them.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::geometry::{self, FileError, Loaded, Placement};
use crate::{Issue, Mesh, Terrain, World, closest_name, shipped};

/// Larger files are refused.
const MAX_BYTES: u64 = 1 << 30;

/// Reads the files of a world. Returns what is wrong with them.
pub(super) fn read(world: &mut World, scenario_file: &Path) -> Vec<Issue> {
    let meshes = world.meshes.iter_mut().enumerate();
    let mut issues: Vec<Issue> = meshes
        .filter_map(|(index, mesh)| {
            read_mesh(mesh, scenario_file).err().map(|it| it.issue("mesh", &format!("world.meshes[{index}].file")))
        })
        .collect();
    let terrain = world.terrain.as_mut().and_then(|terrain| read_terrain(terrain, scenario_file).err());
    issues.extend(terrain.map(|error| error.issue("terrain", "world.terrain.file")));
    issues
}

fn read_mesh(mesh: &mut Mesh, scenario_file: &Path) -> Result<(), Unread> {
    let path = resolved(&mesh.file, scenario_file);
    let content = content(&path)?;
    mesh.file = path.to_string_lossy().into_owned();
    // A scale that is not valid is reported with the field.
    if mesh.scale > 0.0 && mesh.scale.is_finite() {
        let placement = Placement::new(mesh.scale, mesh.rotation_deg.map(f64::to_radians), mesh.offset_m);
        let extension = path.extension().map(|it| it.to_string_lossy().to_lowercase()).unwrap_or_default();
        let surface = geometry::read_mesh(&extension, &content, &placement);
        mesh.surface = Loaded::new(surface.map_err(|error| Unread::malformed(&path, error))?);
    }
    Ok(())
}

fn read_terrain(terrain: &mut Terrain, scenario_file: &Path) -> Result<(), Unread> {
    let path = resolved(&terrain.file, scenario_file);
    let content = content(&path)?;
    terrain.file = path.to_string_lossy().into_owned();
    let grid = geometry::read_terrain(&content, terrain.offset_m);
    terrain.grid = Loaded::new(grid.map_err(|error| Unread::malformed(&path, error))?);
    Ok(())
}

/// The path as seen from the folder of the scenario file: absolute, or `shipped:`.
pub(super) fn resolved(file: &str, scenario_file: &Path) -> PathBuf {
    let file = Path::new(file);
    if shipped::request(file).is_some() {
        return file.to_owned();
    }
    let path = scenario_file.parent().unwrap_or(Path::new("")).join(file);
    if shipped::request(&path).is_some() { path } else { std::path::absolute(&path).unwrap_or(path) }
}

pub(super) fn content(path: &Path) -> Result<Vec<u8>, Unread> {
    if let Some(request) = shipped::request(path) {
        let attached = shipped::attached(request).map(<[u8]>::to_vec);
        return attached.ok_or_else(|| Unread::new(path, "no such shipped file", "a file of the program"));
    }
    let unreadable = |reason: std::io::Error| Unread::new(path, reason.to_string(), "a file that can be read");
    let mut content = Vec::new();
    File::open(path).and_then(|file| file.take(MAX_BYTES + 1).read_to_end(&mut content)).map_err(unreadable)?;
    if content.len() as u64 > MAX_BYTES {
        let remedy = "simplify the mesh, or cut the terrain to the map";
        return Err(Unread { remedy: remedy.into(), ..Unread::new(path, "more than 1 GiB", "a smaller file") });
    }
    Ok(content)
}

/// Why a file could not be used.
pub(super) struct Unread {
    path: PathBuf,
    line: Option<usize>,
    found: String,
    expected: String,
    remedy: String,
}

impl Unread {
    fn new(path: &Path, found: impl Into<String>, expected: &str) -> Self {
        let (folder, file) = (path.parent().unwrap_or(Path::new("")), path.file_name().unwrap_or_default());
        let files = std::fs::read_dir(folder).into_iter().flatten().filter_map(Result::ok);
        let files: Vec<String> = files.map(|it| it.file_name().to_string_lossy().into_owned()).collect();
        let remedy = match closest_name(&file.to_string_lossy(), files.iter().map(String::as_str)) {
            Some(name) if !path.exists() => format!("did you mean \"{name}\"? Paths are relative to the scenario file"),
            _ => "paths are relative to the folder of the scenario file".to_owned(),
        };
        Self { path: path.to_owned(), line: None, found: found.into(), expected: expected.to_owned(), remedy }
    }

    pub(super) fn malformed(path: &Path, error: FileError) -> Self {
        let FileError { line, found, expected, remedy } = error;
        Self { path: path.to_owned(), line, found, expected, remedy }
    }

    pub(super) fn issue(self, what: &str, field: &str) -> Issue {
        let line = self.line.map_or_else(String::new, |line| format!(":{line}"));
        let found = format!("{} in the {what} {}{line}", self.found, self.path.display());
        Issue::new(field, found, self.expected).remedy(self.remedy)
    }
}
