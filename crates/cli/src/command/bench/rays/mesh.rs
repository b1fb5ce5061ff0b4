//! Meshes to trace rays through: those that are made here, and those of files.

use std::path::Path;

use jaspe_noise::{Basis, Combine, Noise, Sum, math};
use jaspe_render::{CompileOptions, MeshFile, read_mesh};
use jaspe_scene::DiskLoader;

use crate::failure::Failure;
use crate::scene_file;

/// Points along each edge of the terrain, and around the blob: a million triangles each.
const SIDE: u32 = 708;

/// A mesh and what to call it.
pub struct Subject {
    pub name: String,
    pub mesh: MeshFile,
}

/// A ball with bumps, 72 thousand triangles: what a scanned figure is like.
pub fn blob() -> Subject {
    ball("blob", 190)
}

/// The same in a million triangles.
pub fn fine_blob() -> Subject {
    ball("fine blob", SIDE)
}

/// A landscape of a million triangles.
pub fn terrain() -> Subject {
    let heights = Sum::new(Noise::new(Basis::Improved, 7), Combine::Plain, 8);
    let mesh = grid([SIDE + 1; 2], |x, z| {
        let (x, z) = (x as f32 / SIDE as f32 * 2.0 - 1.0, z as f32 / SIDE as f32 * 2.0 - 1.0);
        [x, 0.2 * heights.at([2.0 * x, 0.5, 2.0 * z]), z]
    });
    Subject { name: "terrain".to_owned(), mesh }
}

fn ball(name: &str, side: u32) -> Subject {
    let bumps = Sum::new(Noise::new(Basis::Improved, 3), Combine::Plain, 6);
    let mesh = grid([side + 1; 2], |i, j| {
        let turn = |part: u32, turns: f32| part as f32 / side as f32 * turns * std::f32::consts::TAU;
        let (around, polar) = (turn(i, 1.0), turn(j, 0.5));
        let [x, y, z] = [math::sin(polar) * math::cos(around), math::cos(polar), math::sin(polar) * math::sin(around)];
        let radius = 0.8 + 0.3 * bumps.at([2.0 * x, 2.0 * y, 2.0 * z]);
        [x * radius, y * radius, z * radius]
    });
    Subject { name: name.to_owned(), mesh }
}

/// Two triangles for each cell of a grid of points.
fn grid([width, height]: [u32; 2], point: impl Fn(u32, u32) -> [f32; 3]) -> MeshFile {
    let points = (0..height).flat_map(|j| (0..width).map(move |i| (i, j))).map(|(i, j)| point(i, j)).collect();
    let cells = (0..height - 1).flat_map(|j| (0..width - 1).map(move |i| j * width + i));
    let triangles = cells.flat_map(|at| [[at, at + width, at + 1], [at + 1, at + width, at + width + 1]]).collect();
    MeshFile { points, triangles, uvs: Vec::new() }
}

/// The triangles of a mesh file or of a scene.
pub fn read(path: &Path) -> Result<Subject, Failure> {
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    let unusable = |why: &str| Failure::new(format!("`{}` cannot be used: {why}", path.display()));
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
    let mesh = if matches!(extension.as_str(), "obj" | "stl" | "ra3") {
        let bytes = std::fs::read(path).map_err(|error| Failure::reading(path, &error))?;
        read_mesh(&bytes, path).map_err(|why| unusable(&why))?
    } else {
        let loaded = scene_file::load(path, &[], &CompileOptions::default(), &DiskLoader)?;
        let broken = || unusable("the scene has errors").hint(format!("`jaspe check {}` shows them", path.display()));
        loaded.scene.ok_or_else(broken)?.triangles()
    };
    if mesh.triangles.is_empty() {
        return Err(unusable("it has no triangles"));
    }
    Ok(Subject { name, mesh })
}
