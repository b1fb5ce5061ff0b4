//! Triangles from the mesh files that `file-mesh` names: bytes in, a mesh out (format reference, §3.13).
//!
//! The readers are our own: each is a page, and none of the crates at hand keeps a mesh of millions of triangles in little
//! more than its own size.

mod obj;
mod ra3;
mod stl;

use std::path::Path;

use crate::geometry::MeshShape;

/// The formats that are read.
const FORMATS: &str = "OBJ, STL or RA3";

/// The mesh in a file, by the extension of its name. It has valid indices and finite points.
///
/// # Errors
/// What is wrong with the file, in words that follow "cannot be used: ".
pub(crate) fn read(bytes: &[u8], path: &Path) -> Result<MeshShape, String> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let mesh = match extension.as_str() {
        "obj" => obj::read(bytes),
        "stl" => stl::read(bytes),
        "ra3" => ra3::read(bytes),
        _ => Err(format!("its name does not end like that of a mesh: use {FORMATS}")),
    }?;
    let points = mesh.points.len();
    if let Some(index) = mesh.triangles.iter().flatten().find(|index| **index as usize >= points) {
        return Err(format!("a triangle wants point {index} of {points}, counted from 0"));
    }
    if mesh.points.iter().any(|point| !point.is_finite()) {
        return Err("it holds numbers that are not finite".to_owned());
    }
    Ok(mesh)
}

/// A mesh as its file has it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeshFile {
    /// Points: x, y, z.
    pub points: Vec<[f32; 3]>,
    /// Each triangle's points, as indices from 0.
    pub triangles: Vec<[u32; 3]>,
    /// Each triangle's texture coordinates u and v, corner by corner; none at all where the file has none.
    pub uvs: Vec<[[f32; 2]; 3]>,
}

/// Reads a mesh file (OBJ, STL or RA3), by the extension of its name. Its indices are valid, and its points finite.
///
/// # Errors
/// What is wrong with the file.
pub fn read_mesh(bytes: &[u8], path: &Path) -> Result<MeshFile, String> {
    let mesh = read(bytes, path)?;
    let uvs = (0..mesh.triangles.len()).map_while(|triangle| mesh.uvs.triangle(&mesh, triangle));
    let uvs = uvs.map(|corners| corners.map(|uv| uv.to_array())).collect();
    let points = mesh.points.iter().map(|point| point.to_array()).collect();
    Ok(MeshFile { points, uvs, triangles: mesh.triangles })
}

/// The four bytes at `at`, if there are so many.
fn four(bytes: &[u8], at: usize) -> Option<[u8; 4]> {
    bytes.get(at..at.checked_add(4)?)?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_formats_are_refused() {
        assert!(read(b"", Path::new("a.max")).is_err());
        assert!(read(b"", Path::new("obj")).is_err());
    }

    #[test]
    fn junk_is_survived() {
        let mut state = 1u32;
        let mut junk: Vec<u8> = (0..5000)
            .map(|_| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (state >> 24) as u8
            })
            .collect();
        for name in ["a.obj", "a.stl", "a.ra3"] {
            for length in [0, 1, 4, 8, 83, 84, 85, 100, 5000] {
                let _ = read(&junk[..length], Path::new(name));
            }
        }
        junk[..6].copy_from_slice(b"solid ");
        assert!(read(&junk, Path::new("a.stl")).is_err());
    }
}
