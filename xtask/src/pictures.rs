//! Pictures that the program renders of itself: references of the tests, and the gallery.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{cargo, root, run};

/// Renders the references of all scenes whose path contains `filter`, and removes references without a scene.
pub fn bless(filter: &str) -> Result<(), String> {
    let jaspe = build()?;
    let (scenes, references) = (root().join("tests/scenes"), root().join("tests/reference"));
    let cases = files(&scenes, "sc")?;
    let chosen: Vec<&PathBuf> = cases.iter().filter(|case| case.to_string_lossy().contains(filter)).collect();
    if chosen.is_empty() {
        return Err(format!("no scene below tests/scenes has `{filter}` in its path"));
    }
    let (mut changed, mut new) = (0, 0);
    for case in &chosen {
        let reference = references.join(case).with_extension("png");
        let before = fs::read(&reference).ok();
        fs::create_dir_all(reference.parent().unwrap_or(&references)).map_err(|error| error.to_string())?;
        run(Command::new(&jaspe).arg("render").arg(scenes.join(case)).arg("-o").arg(&reference).arg("--quiet"))?;
        let after = fs::read(&reference).ok();
        match before {
            None => new += 1,
            Some(_) if before != after => {
                changed += 1;
                println!("changed: {}", case.display());
            }
            Some(_) => {}
        }
    }
    for orphan in files(&references, "png")?.iter().filter(|path| !scenes.join(path).with_extension("sc").is_file()) {
        println!("removed: {}", orphan.display());
        fs::remove_file(references.join(orphan)).map_err(|error| error.to_string())?;
    }
    println!("{} rendered, {changed} changed, {new} new: look at them before you commit them", chosen.len());
    Ok(())
}

/// How wide the gallery's pictures are, in pixels.
const GALLERY_WIDTH: u32 = 400;

/// Renders every scene of `scenes/` into `docs/gallery/`.
pub fn gallery() -> Result<(), String> {
    let jaspe = build()?;
    let (scenes, gallery) = (root().join("scenes"), root().join("docs/gallery"));
    fs::create_dir_all(&gallery).map_err(|error| error.to_string())?;
    for case in files(&scenes, "sc")? {
        let scene = scenes.join(&case);
        let picture = gallery.join(case.file_name().unwrap_or_default()).with_extension("png");
        let mut command = Command::new(&jaspe);
        command.arg("render").arg(&scene).arg("-o").arg(&picture);
        if let Some(resolution) = gallery_resolution(&scene)? {
            command.args(["--resolution", &resolution]);
        }
        run(&mut command)?;
    }
    Ok(())
}

/// The scene's own shape at the gallery's width. In the report's dialect another size shows another part of the scene,
/// so those keep their own.
fn gallery_resolution(scene: &Path) -> Result<Option<String>, String> {
    let text = fs::read(scene).map_err(|error| format!("cannot read {}: {error}", scene.display()))?;
    let text = String::from_utf8_lossy(&text);
    let words: Vec<&str> = text.split_whitespace().collect();
    if words.windows(2).any(|pair| pair == ["dialect", "report"]) {
        return Ok(None);
    }
    let side = |word: &str| word.parse::<u32>().ok().filter(|side| *side > 0);
    let size = words.windows(3).rev().find_map(|triple| match triple {
        ["resolution", width, height] => side(width).zip(side(height)),
        _ => None,
    });
    let (width, height) = size.unwrap_or((640, 480));
    let height = (u64::from(height) * u64::from(GALLERY_WIDTH) / u64::from(width)).max(1);
    Ok(Some(format!("{GALLERY_WIDTH}x{height}")))
}

/// Builds the program as users have it, and says where it is.
fn build() -> Result<PathBuf, String> {
    run(&mut cargo(&["build", "--release", "--package", "jaspe"]))?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    Ok(target.join("release").join(format!("jaspe{}", std::env::consts::EXE_SUFFIX)))
}

/// Paths of all files below a folder with that extension, relative to it, sorted; none if there is no such folder.
fn files(folder: &Path, extension: &str) -> Result<Vec<PathBuf>, String> {
    let mut found = Vec::new();
    let mut waiting = vec![folder.to_owned()];
    while let Some(current) = waiting.pop().filter(|current| current.is_dir()) {
        for entry in fs::read_dir(&current).map_err(|error| format!("cannot read {}: {error}", current.display()))? {
            let path = entry.map_err(|error| error.to_string())?.path();
            if path.is_dir() {
                waiting.push(path);
            } else if path.extension().is_some_and(|found| found == extension) {
                found.extend(path.strip_prefix(folder).map(Path::to_owned));
            }
        }
    }
    found.sort();
    Ok(found)
}
