//! A large mesh is read within four times the size of its raw arrays, the text of the file included.
//!
//! A test binary of its own: the most memory that a process ever had is measured.

#![cfg(target_os = "linux")]

use std::fs::{self, File};
use std::io::{BufWriter, Write as _};
use std::path::Path;

use jaspe_scene::description::Geometry;
use jaspe_scene::{DiskLoader, read};

/// Edge of the grid of points.
const EDGE: usize = 700;

/// The largest resident size of this process so far, in bytes.
fn peak() -> usize {
    let status = fs::read_to_string("/proc/self/status").expect("Linux tells");
    let line = status.lines().find(|line| line.starts_with("VmHWM:")).expect("it is there");
    let kilobytes: usize = line.split_whitespace().nth(1).and_then(|word| word.parse().ok()).expect("a number");
    kilobytes * 1024
}

fn write_grid(path: &Path) -> std::io::Result<()> {
    let mut file = BufWriter::new(File::create(path)?);
    writeln!(file, "object {{ shader a type generic-mesh points {}", EDGE * EDGE)?;
    for i in 0..EDGE * EDGE {
        let (x, y) = ((i % EDGE) as f32 / EDGE as f32, (i / EDGE) as f32 / EDGE as f32);
        writeln!(file, "{x} {y} {}", x * y)?;
    }
    writeln!(file, "triangles {}", 2 * (EDGE - 1) * (EDGE - 1))?;
    for cell in 0..(EDGE - 1) * (EDGE - 1) {
        let a = cell % (EDGE - 1) + cell / (EDGE - 1) * EDGE;
        writeln!(file, "{} {} {}\n{} {} {}", a, a + 1, a + EDGE, a + 1, a + EDGE + 1, a + EDGE)?;
    }
    writeln!(file, "normals none uvs none }}")
}

#[test]
fn a_large_mesh_is_read_in_four_times_its_size() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("grid.sc");
    write_grid(&path).expect("the folder for tests can be written to");
    let before = peak();
    let (scene, diagnostics) = read(&path, &DiskLoader);
    let used = peak() - before;
    fs::remove_file(&path).expect("it was just written");
    assert!(diagnostics.is_empty());
    let Geometry::Mesh(mesh) = &scene.objects[0].geometry else { panic!("a mesh") };
    assert_eq!(mesh.triangles.len(), 2 * (EDGE - 1) * (EDGE - 1));
    let raw = 12 * (mesh.points.len() + mesh.triangles.len());
    assert!(used <= 4 * raw, "{used} bytes for arrays of {raw}: {:.2} times", used as f64 / raw as f64);
}
