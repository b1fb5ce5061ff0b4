//! Pictures that the program renders of itself: references of the tests, and the gallery.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::{cargo, root, run, target};

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

/// Renders the scenes that lie in `scenes/` itself into `docs/gallery/`, each at its own size, and the preview of a baked set. JPEG, because the pictures
/// are for looking at and the repository keeps every version of them.
pub fn gallery() -> Result<(), String> {
    let jaspe = build()?;
    let (scenes, gallery) = (root().join("scenes"), root().join("docs/gallery"));
    fs::create_dir_all(&gallery).map_err(|error| error.to_string())?;
    for case in files(&scenes, "sc")?.iter().filter(|case| case.components().count() == 1) {
        let picture = gallery.join(case).with_extension("jpg");
        run(Command::new(&jaspe).arg("render").arg(scenes.join(case)).arg("-o").arg(&picture))?;
    }
    // The preview of a baked set, for the page on baking.
    let set = gallery.join("set");
    run(Command::new(&jaspe).args(["bake", "organic", "--format", "jpeg", "--preview", "-o"]).arg(&set))?;
    let moved = fs::rename(set.join("preview.jpg"), gallery.join("bake.jpg"));
    moved.and_then(|()| fs::remove_dir_all(&set)).map_err(|error| error.to_string())
}

/// Builds the program as users have it, and says where it is.
fn build() -> Result<PathBuf, String> {
    run(&mut cargo(&["build", "--release", "--package", "jaspe"]))?;
    Ok(target().join("release").join(format!("jaspe{}", std::env::consts::EXE_SUFFIX)))
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
