//! Sunflow's example scenes, where they lie beside the project: mean colours as Sunflow 0.07.3 renders them (the format
//! reference's check values, §7.2).

use std::path::{Path, PathBuf};

use jaspe_render::{CompileOptions, Film, RenderOptions, compile, flip, render, srgb_decode, srgb_encode};
use jaspe_scene::{DiskLoader, read};

/// A scene, the size at which it was measured, mean red, green and blue.
type Means = (&'static str, [u32; 2], [f32; 3]);

const MEANS: [Means; 11] = [
    ("shader_examples/AO002", [200, 150], [0.1991, 0.0129, 0.2214]),
    ("shader_examples/Glass001", [150, 150], [0.0431; 3]),
    ("shader_examples/Glass003", [150, 150], [0.0386, 0.0389, 0.0389]),
    ("shader_examples/Mirror001", [150, 150], [0.0422, 0.0350, 0.0394]),
    ("shader_examples/Phong001", [150, 150], [0.0341, 0.0588, 0.0803]),
    ("shader_examples/Phong002", [150, 150], [0.0627, 0.0627, 0.1074]),
    ("shader_examples/Phong003", [200, 150], [0.0393; 3]),
    ("shader_examples/Ward001", [150, 150], [0.0604, 0.1051, 0.0604]),
    ("bump_demo", [200, 112], [0.1647, 0.1537, 0.1128]),
    ("bunny_ibl", [160, 120], [0.6676, 0.6283, 0.7276]),
    ("cornell_box_jensen", [200, 150], [0.6138, 0.5183, 0.6204]),
];

/// A scene, its size, and the mean colours of the ninths of its picture, row by row from the top.
type Ninths = (&'static str, [u32; 2], [[f32; 3]; 9]);

const BLOCKS: [Ninths; 3] = [
    (
        "bump_demo",
        [200, 112],
        [
            [0.187, 0.215, 0.314],
            [0.059, 0.171, 0.108],
            [0.058, 0.076, 0.108],
            [0.305, 0.327, 0.099],
            [0.243, 0.230, 0.028],
            [0.228, 0.062, 0.084],
            [0.154, 0.165, 0.101],
            [0.129, 0.085, 0.085],
            [0.124, 0.061, 0.093],
        ],
    ),
    (
        "bunny_ibl",
        [160, 120],
        [
            [1.30, 1.25, 1.74],
            [1.56, 1.50, 1.82],
            [1.14, 1.12, 1.25],
            [0.430, 0.383, 0.376],
            [0.197, 0.189, 0.192],
            [0.489, 0.432, 0.428],
            [0.293, 0.258, 0.249],
            [0.264, 0.231, 0.223],
            [0.342, 0.295, 0.282],
        ],
    ),
    (
        "cornell_box_jensen",
        [200, 150],
        [
            [0.311, 0.137, 0.175],
            [2.72, 2.66, 2.72],
            [0.170, 0.134, 0.323],
            [0.477, 0.192, 0.220],
            [0.623, 0.567, 0.648],
            [0.235, 0.206, 0.479],
            [0.356, 0.183, 0.208],
            [0.380, 0.345, 0.411],
            [0.245, 0.223, 0.378],
        ],
    ),
];

fn scene(name: &str) -> Option<PathBuf> {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes/sunflow").join(name).with_extension("sc");
    path.exists().then_some(path)
}

/// A scene at a size, or at its own.
fn film(path: &Path, size: Option<[u32; 2]>) -> Film {
    let (scene, diagnostics) = read(path, &DiskLoader);
    assert!(!diagnostics.has_errors(), "{}: {diagnostics:?}", path.display());
    let options = CompileOptions { resolution: size, ..CompileOptions::default() };
    let compiled = compile(&scene, &DiskLoader, &options).scene.expect("no errors");
    render(&compiled, &RenderOptions::default(), &()).expect("not cancelled").0
}

/// Mean colours of the parts of a picture of so many columns and rows; light from nowhere counts as black.
fn blocks(path: &Path, size: [u32; 2], parts: usize) -> Vec<[f32; 3]> {
    let film = film(path, Some(size));
    let (width, height) = (film.width as usize, film.height as usize);
    let part = |row: usize, column: usize| {
        let mut sum = [0.0f64; 3];
        let (rows, columns) =
            (row * height / parts..(row + 1) * height / parts, column * width / parts..(column + 1) * width / parts);
        let count = (rows.len() * columns.len()) as f64;
        for y in rows {
            for x in columns.clone() {
                let pixel = film.pixels[y * width + x];
                (0..3).for_each(|c| sum[c] += f64::from(pixel[c]));
            }
        }
        sum.map(|sum| (sum / count) as f32)
    };
    (0..parts)
        .flat_map(|row| (0..parts).map(move |column| (row, column)))
        .map(|(row, column)| part(row, column))
        .collect()
}

#[test]
fn pictures_are_as_bright_as_sunflows() {
    for (name, size, expected) in MEANS {
        let Some(path) = scene(name) else { continue };
        let mean = blocks(&path, size, 1)[0];
        let off = (0..3).any(|c| (mean[c] - expected[c]).abs() > 0.02 * expected[c] + 1e-4);
        assert!(!off, "{name}: {mean:?}, expected {expected:?}");
    }
}

#[test]
fn ninths_of_pictures_are_as_bright_as_sunflows() {
    for (name, size, expected) in BLOCKS {
        let Some(path) = scene(name) else { continue };
        for (i, (mean, expected)) in blocks(&path, size, 3).iter().zip(&expected).enumerate() {
            let off = (0..3).any(|c| (mean[c] - expected[c]).abs() > 0.04 * expected[c] + 1e-3);
            assert!(!off, "{name}, ninth {i}: {mean:?}, expected {expected:?}");
        }
    }
}

/// Display values of a picture of light, or of one that was un-premultiplied, halved and on black.
fn halved(width: usize, light: impl Fn(usize) -> [f32; 3]) -> impl Fn(usize) -> [f32; 3] {
    move |i| {
        let (x, y) = (i % (width / 2), i / (width / 2));
        let corners = [0, 1, width, width + 1].map(|offset| light(2 * y * width + 2 * x + offset));
        [0, 1, 2].map(|c| {
            let mean = corners.iter().map(|corner| f64::from(corner[c].clamp(0.0, 1.0))).sum::<f64>() / 4.0;
            srgb_encode(mean) as f32
        })
    }
}

#[test]
fn pictures_look_like_sunflows() {
    // Scenes without indirect light must be nearer; the Julia set alone would take half a minute.
    let limits = MEANS.map(|(name, _, _)| (name, if name.contains('/') { 0.05 } else { 0.08 }));
    for (name, limit) in limits {
        let Some(path) = scene(name) else { continue };
        let file = path.file_stem().expect("a file").to_string_lossy().into_owned() + ".png";
        let reference =
            Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/reference/sunflow-renders").join(file);
        if !reference.exists() {
            continue;
        }
        let reference = image::open(&reference).expect("a picture").into_rgba32f();
        let ours = film(&path, None);
        assert_eq!([ours.width, ours.height], [reference.width(), reference.height()], "{name}");
        let (width, count) = (ours.width as usize, (ours.width / 2 * (ours.height / 2)) as usize);
        let theirs = |i: usize| {
            let pixel = reference.get_pixel((i % width) as u32, (i / width) as u32);
            [0, 1, 2].map(|c| (srgb_decode(f64::from(pixel[c])) * f64::from(pixel[3])) as f32)
        };
        let own = |i: usize| [0, 1, 2].map(|c| ours.pixels[i][c]);
        let theirs: Vec<[f32; 3]> = (0..count).map(halved(width, theirs)).collect();
        let own: Vec<[f32; 3]> = (0..count).map(halved(width, own)).collect();
        let errors = flip(&theirs, &own, width / 2);
        let mean = errors.iter().sum::<f32>() / errors.len() as f32;
        assert!(mean < limit, "{name}: {mean}");
    }
}
