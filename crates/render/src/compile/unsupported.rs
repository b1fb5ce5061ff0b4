//! What a scene says and the renderer does not do yet: one remark for each, in one place.
//!
//! When something becomes supported, its arm here goes.

use jaspe_scene::description::{LightKind, Sampler, ShaderKind};
use jaspe_scene::{Diagnostic, Diagnostics, Scene, Span};

/// Warns of everything that will be passed over.
pub(super) fn report(scene: &Scene, diagnostics: &mut Diagnostics) {
    let mut skipped = |span: Span, what: String| {
        diagnostics.push(Diagnostic::warning(span, format!("skipped: {what} is not supported yet")));
    };
    if let Some(sampler) = scene.image.sampler.filter(|sampler| sampler.value != Sampler::Bucket) {
        skipped(sampler.span, "this sampler".to_owned());
    }
    if let Some(gi) = &scene.gi {
        skipped(gi.span, format!("`gi` of type `{}`", gi.kind.keyword()));
    }
    if let Some(caustics) = &scene.caustics {
        skipped(caustics.span, "`photons`".to_owned());
    }
    for light in scene.lights.iter().filter(|light| !lights(&light.kind)) {
        skipped(light.span, format!("light type `{}`", light.kind.keyword()));
    }
    for shader in scene.shaders.iter().filter(|shader| !shades(&shader.kind)) {
        skipped(shader.span, format!("shader type `{}`", shader.kind.keyword()));
    }
    for modifier in &scene.modifiers {
        skipped(modifier.span, format!("modifier type `{}`", modifier.kind.keyword()));
    }
}

fn lights(kind: &LightKind) -> bool {
    matches!(kind, LightKind::Point { .. } | LightKind::Directional { .. })
}

/// Whether more than a grey is made of a shader. What could not be read has been reported.
fn shades(kind: &ShaderKind) -> bool {
    match kind {
        ShaderKind::Constant { .. }
        | ShaderKind::Diffuse { .. }
        | ShaderKind::Phong { .. }
        | ShaderKind::Mirror { .. }
        | ShaderKind::Glass { .. }
        | ShaderKind::Procedural { .. }
        | ShaderKind::Unsupported => true,
        ShaderKind::Shiny { .. }
        | ShaderKind::Ward { .. }
        | ShaderKind::AmbientOcclusion { .. }
        | ShaderKind::Uber { .. }
        | ShaderKind::Wireframe { .. }
        | ShaderKind::ViewCaustics
        | ShaderKind::ViewIrradiance
        | ShaderKind::ViewGlobal
        | ShaderKind::Id => false,
    }
}
