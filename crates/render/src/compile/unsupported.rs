//! What a scene says and the renderer does not do yet: one remark for each, in one place.
//!
//! When something becomes supported, its arm here goes.

use jaspe_scene::description::GiKind;
use jaspe_scene::{Diagnostic, Diagnostics, Scene, Span};

use crate::motion::{Motion, Shutter};

/// Warns of objects that move while the shutter is open.
pub(super) fn report_motion(scene: &Scene, shutter: Shutter, diagnostics: &mut Diagnostics) {
    let objects = scene.objects.iter().filter(|object| object.visible).filter_map(|object| object.transform.as_ref());
    let mut transforms = objects.chain(scene.instances.iter().filter_map(|instance| instance.transform.as_ref()));
    if let Some(moving) = transforms.find(|transform| !Motion::new(&transform.kind).is_still())
        && shutter.has_duration()
    {
        let message = "moving objects are not blurred yet: they stand as in the middle of the exposure";
        diagnostics.push(Diagnostic::warning(moving.span, message));
    }
}

/// Warns of everything that will be passed over.
pub(super) fn report(scene: &Scene, diagnostics: &mut Diagnostics) {
    let mut skipped = |span: Span, what: String| {
        diagnostics.push(Diagnostic::warning(span, format!("skipped: {what} is not supported yet")));
    };
    if let Some(gi) = &scene.gi
        && matches!(gi.kind, GiKind::Instant { bias_samples: 1.., .. })
    {
        skipped(gi.span, "the light of `bias-samples`".to_owned());
    }
}
