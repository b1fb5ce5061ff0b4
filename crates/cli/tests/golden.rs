//! Golden pictures: every `tests/scenes/**/NAME.sc` is rendered and compared with `tests/reference/**/NAME.png`.
//!
//! Tolerance: one 8-bit step; 0.05 % of the pixels may be further off, and none by more than four steps. A failure
//! writes expected, difference and actual side by side below `target/`. `cargo xtask bless` renders the references anew.

mod common;

use common::{jaspe, root};
use image::{GenericImage as _, Rgba, RgbaImage};
use std::path::{Path, PathBuf};

/// How many scenes there are: a walk that finds nothing must not pass. Change it with the scenes.
const CASE_COUNT: usize = 45;

const STEP: u8 = 1;
const SHARE_PAST_STEP: f64 = 0.0005;
const HARD_LIMIT: u8 = 4;
const LARGEST_SIZE: [u32; 2] = [160, 120];
const LARGEST_FILE: usize = 20 * 1024;

#[test]
fn scenes_look_as_they_did() {
    let (scenes, references) = (root().join("tests/scenes"), root().join("tests/reference"));
    let cases = files(&scenes, "sc");
    let mut failures: Vec<String> = Vec::new();
    for case in &cases {
        let reference = references.join(case).with_extension("png");
        if let Err(failure) = check(&scenes.join(case), &reference, case) {
            failures.push(format!("{}: {failure}", case.display()));
        }
    }
    for orphan in files(&references, "png").iter().filter(|path| !scenes.join(path).with_extension("sc").is_file()) {
        failures.push(format!("{}: a reference without a scene", orphan.display()));
    }
    assert!(failures.is_empty(), "{} of {} failed:\n{}", failures.len(), cases.len(), failures.join("\n"));
    assert_eq!(cases.len(), CASE_COUNT, "scenes came or went: change CASE_COUNT");
}

/// Paths of all files below a folder with that extension, relative to it, sorted.
fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(current) = waiting.pop() {
        for entry in std::fs::read_dir(&current).expect("the folder can be read") {
            let path = entry.expect("the entry can be read").path();
            if path.is_dir() {
                waiting.push(path);
            } else if path.extension().is_some_and(|found| found == extension) {
                found.push(path.strip_prefix(folder).expect("it is below the folder").to_owned());
            }
        }
    }
    found.sort();
    found
}

fn check(scene: &Path, reference: &Path, case: &Path) -> Result<(), String> {
    let bytes = std::fs::read(reference).map_err(|_| "no reference: `cargo xtask bless` makes one".to_owned())?;
    if bytes.len() > LARGEST_FILE {
        return Err(format!("the reference has {} bytes, more than {LARGEST_FILE}", bytes.len()));
    }
    let expected = image::load_from_memory(&bytes).map_err(|error| error.to_string())?.into_rgba8();
    if expected.width() > LARGEST_SIZE[0] || expected.height() > LARGEST_SIZE[1] {
        return Err(format!("the reference is larger than {LARGEST_SIZE:?}"));
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden").join(case).with_extension("");
    std::fs::create_dir_all(&folder).expect("folders below target can be made");
    let actual = render(scene, &folder.join("actual.png"))?;
    let failure = match difference(&expected, &actual) {
        Ok(()) => return Ok(()),
        Err(failure) => failure,
    };
    let sheet = folder.join("expected-difference-actual.png");
    triptych(&expected, &actual).save(&sheet).expect("files below target can be written");
    Err(format!("{failure}; see {}", sheet.display()))
}

fn render(scene: &Path, output: &Path) -> Result<RgbaImage, String> {
    let run = jaspe().arg("render").arg(scene).arg("-o").arg(output).arg("--quiet").output();
    let run = run.expect("the program starts");
    if !run.status.success() {
        return Err(format!("rendering failed:\n{}", String::from_utf8_lossy(&run.stderr)));
    }
    Ok(image::open(output).map_err(|error| error.to_string())?.into_rgba8())
}

fn error(a: &Rgba<u8>, b: &Rgba<u8>) -> u8 {
    (0..4).map(|i| a.0[i].abs_diff(b.0[i])).max().unwrap_or(0)
}

fn difference(expected: &RgbaImage, actual: &RgbaImage) -> Result<(), String> {
    if expected.dimensions() != actual.dimensions() {
        return Err(format!("expected {:?} pixels, found {:?}", expected.dimensions(), actual.dimensions()));
    }
    let errors = || expected.pixels().zip(actual.pixels()).map(|(a, b)| error(a, b));
    let largest = errors().max().unwrap_or(0);
    let past = errors().filter(|error| *error > STEP).count();
    let allowed = (SHARE_PAST_STEP * errors().count() as f64) as usize;
    if largest > HARD_LIMIT || past > allowed {
        return Err(format!("{past} pixels are off by more than {STEP} ({allowed} may be), the worst by {largest}"));
    }
    Ok(())
}

/// Expected, difference (enlarged 16 times, on black) and actual side by side.
fn triptych(expected: &RgbaImage, actual: &RgbaImage) -> RgbaImage {
    let (width, height) = (expected.width().max(actual.width()), expected.height().max(actual.height()));
    let mut sheet = RgbaImage::from_pixel(3 * width, height, Rgba([128, 128, 128, 255]));
    let difference = RgbaImage::from_fn(width, height, |x, y| {
        match (expected.get_pixel_checked(x, y), actual.get_pixel_checked(x, y)) {
            (Some(a), Some(b)) => {
                let channel = |i: usize| a.0[i].abs_diff(b.0[i]).saturating_mul(16);
                Rgba([channel(0).max(channel(3)), channel(1), channel(2), 255])
            }
            _ => Rgba([255, 0, 255, 255]),
        }
    });
    for (at, picture) in [expected, &difference, actual].into_iter().enumerate() {
        sheet.copy_from(picture, at as u32 * width, 0).expect("the sheet is wide enough");
    }
    sheet
}

#[test]
fn the_comparison_sees_what_it_shall() {
    let plain = RgbaImage::from_pixel(100, 100, Rgba([100, 100, 100, 255]));
    let changed = |count: u32, step: u8| {
        let mut picture = plain.clone();
        (0..count).for_each(|i| picture.get_pixel_mut(i % 100, i / 100).0[1] += step);
        difference(&plain, &picture).is_ok()
    };
    assert!(changed(10_000, 1) && changed(5, 4));
    assert!(!changed(6, 2) && !changed(1, 5));
    assert!(difference(&plain, &RgbaImage::new(100, 99)).is_err());
}
