//! The 2010 program's own scenes and pictures, where they are at hand (`../shared` beside the checkout).
//! Pictures made with a fixed noise table and one ray per pixel are compared pixel by pixel.

use std::path::{Path, PathBuf};

use jaspe_render::{Alpha, CompileOptions, Depth, Film, Picture, PicturePixels, RenderOptions, Samples};
use jaspe_render::{compile, develop, render};
use jaspe_scene::{Dialect, DiskLoader, read};

fn shared() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    folder.join("scenes/original").is_dir().then_some(folder)
}

fn film(path: &Path, options: &CompileOptions) -> Film {
    let (scene, diagnostics) = read(path, &DiskLoader);
    assert!(!diagnostics.has_errors(), "{}: {diagnostics:?}", path.display());
    let compiled = compile(&scene, &DiskLoader, options);
    let scene = compiled.scene.unwrap_or_else(|| panic!("{}: {:?}", path.display(), compiled.diagnostics));
    render(&scene, &RenderOptions::default(), &()).expect("nobody cancels").0
}

fn bytes(film: &Film) -> Vec<[u8; 3]> {
    match develop(film, Depth::Eight, Alpha::OnBlack).samples {
        Samples::Eight(samples) => samples.chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect(),
        Samples::Sixteen(_) => unreachable!("eight bits were asked for"),
    }
}

/// How far each pixel is from the reference: the largest difference of its channels.
fn differences(film: &Film, reference: &Path) -> Vec<u8> {
    let file = std::fs::read(reference).expect("the reference is there");
    let picture = Picture::decode(&file, reference).expect("the reference is a picture");
    assert_eq!((picture.width, picture.height), (film.width, film.height), "{}", reference.display());
    let PicturePixels::Bytes(expected) = picture.pixels else { panic!("references are bytes") };
    let channels = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).map(|i| a[i].abs_diff(b[i])).max().unwrap_or(0);
    bytes(film).iter().zip(&expected).map(channels).collect()
}

#[test]
fn fixed_table_pictures_agree_to_one_step() {
    let Some(shared) = shared() else { return };
    let references = shared.join("reference/original-renders/fixed-table");
    let options = CompileOptions {
        dialect: Some(Dialect::Report),
        resolution: Some([640, 480]),
        aa: Some([0, 0]),
        ..CompileOptions::default()
    };
    let mut count = 0;
    for entry in std::fs::read_dir(references).expect("the folder is there").flatten() {
        let name = entry.path().with_extension("sc").file_name().expect("a file has a name").to_owned();
        let film = film(&shared.join("scenes/original/procedural").join(&name), &options);
        let far = differences(&film, &entry.path()).iter().filter(|&&d| d > 1).count();
        assert!(far <= 20, "{name:?}: {far} pixels differ by more than one step");
        count += 1;
    }
    assert_eq!(count, 8);
}

#[test]
fn other_pictures_agree_but_for_edges() {
    let Some(shared) = shared() else { return };
    let options = CompileOptions { dialect: Some(Dialect::Report), ..CompileOptions::default() };
    // Scenes, and the share of pixels that edges and jitter may move by more than two steps.
    for (name, share) in [
        ("scene4", 0.0),
        ("scene18", 0.0),
        ("scene19", 0.0),
        ("scene21", 1e-4),
        ("scene2", 5e-4),
        ("simple", 0.005),
        ("spheres", 0.005),
        ("objects", 0.005),
        ("bunny", 0.02),
        ("marbles", 0.02),
    ] {
        let film = film(&shared.join(format!("scenes/original/{name}.sc")), &options);
        let differences = differences(&film, &shared.join(format!("reference/original-renders/{name}.png")));
        let far = differences.iter().filter(|&&d| d > 2).count() as f64 / differences.len() as f64;
        assert!(far <= share, "{name}: {:.3} % of the pixels differ", 100.0 * far);
    }
}
