//! Scenes that people have made are read as they meant them.

mod common;

use std::path::Path;

use common::scenes;
use jaspe_scene::{DiskLoader, Severity, read};

#[test]
fn the_scenes_of_this_project_give_no_remark() {
    let found = scenes("scenes");
    let first = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/six-materials.sc");
    assert_eq!(found.is_empty(), !first.exists());
    for path in found {
        let (_, diagnostics) = read(&path, &DiskLoader);
        assert!(diagnostics.is_empty(), "{}: {diagnostics:#?}", path.display());
    }
}

/// The scenes of the 2010 program and of Sunflow lie beside some checkouts.
#[test]
fn other_scenes_have_no_errors() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/scenes");
    let found = scenes("../shared/scenes");
    assert_eq!(found.is_empty(), !root.exists());
    for path in found {
        let (scene, diagnostics) = read(&path, &DiskLoader);
        assert_eq!(diagnostics.count(Severity::Error), 0, "{}: {diagnostics:#?}", path.display());
        let is_sunflows =
            path.components().any(|part| matches!(part.as_os_str().to_str(), Some("sunflow" | "sunflow-strict")));
        for diagnostic in &diagnostics {
            let is_skip = diagnostic.message.ends_with("is not supported yet");
            assert!(is_skip || !is_sunflows, "{}: {diagnostic:?}", path.display());
        }
        assert!(!scene.cameras.is_empty(), "{} has no camera", path.display());
    }
}
