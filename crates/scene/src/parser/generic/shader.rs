//! Shaders and modifiers.

use super::super::gi::MOST_SAMPLES;
use super::super::{Namespace, Parser};
use super::unwritten;
use super::value::Parameters;
use crate::description::{Blend, Color, ColorOrTexture, Modifier, ModifierKind, Name, Shader, ShaderKind};
use crate::source::Span;

/// Declares a shader. False if there is none of that type.
pub(super) fn shader(parser: &mut Parser<'_>, p: &mut Parameters, name: &Name, class: &Name, span: Span) -> bool {
    let gray = |value: f32| Color::new_linear([value; 3], span);
    // The textured forms take a picture in place of the colour.
    let textured = class.value.strip_prefix("textured_");
    let diffuse = |p: &mut Parameters, key: &str, default: f32| match textured {
        Some(_) => ColorOrTexture::Texture(p.string("texture").unwrap_or_else(|| unwritten("", span))),
        None => ColorOrTexture::Color(p.color(key).unwrap_or_else(|| gray(default))),
    };
    let samples = |p: &mut Parameters, default: u32| p.whole("samples", 0, MOST_SAMPLES).unwrap_or(default);
    let specular = |p: &mut Parameters| p.color("specular").unwrap_or_else(|| gray(0.5));
    let kind = match textured.unwrap_or(&class.value) {
        "constant" => ShaderKind::Constant { color: diffuse(p, "color", 1.0) },
        "diffuse" => ShaderKind::Diffuse { diffuse: diffuse(p, "diffuse", 1.0) },
        "quick_gray" | "simple" => ShaderKind::Diffuse { diffuse: ColorOrTexture::Color(gray(0.5)) },
        "phong" => ShaderKind::Phong {
            diffuse: diffuse(p, "diffuse", 0.5),
            specular: specular(p),
            power: p.float("power").unwrap_or(20.0),
            samples: samples(p, 4),
        },
        "mirror" => ShaderKind::Mirror { color: p.color("color").unwrap_or_else(|| gray(1.0)) },
        "glass" => ShaderKind::Glass {
            eta: p.float("eta").filter(|eta| *eta > 0.0).unwrap_or(1.3),
            color: p.color("color").unwrap_or_else(|| gray(1.0)),
            absorption_distance: p.float("absorption.distance").unwrap_or(0.0),
            absorption_color: p.color("absorption.color").unwrap_or_else(|| gray(0.5)),
        },
        "shiny_diffuse" => {
            ShaderKind::Shiny { diffuse: diffuse(p, "diffuse", 0.5), reflection: p.float("shiny").unwrap_or(0.5) }
        }
        "ward" => {
            let mut rough = |name: &str| p.float(name).filter(|rough| *rough > 0.0).unwrap_or(1.0);
            let roughness = [rough("roughnessX"), rough("roughnessY")];
            let (diffuse, specular) = (diffuse(p, "diffuse", 0.5), specular(p));
            ShaderKind::Ward { diffuse, specular, roughness, samples: samples(p, 4) }
        }
        "ambient_occlusion" => ShaderKind::AmbientOcclusion {
            bright: diffuse(p, "bright", 1.0),
            dark: p.color("dark").unwrap_or_else(|| gray(0.0)),
            samples: samples(p, 32),
            distance: p.float("maxdist").unwrap_or(0.0),
        },
        "uber" => {
            let mut layer = |name: &str, default: f32| Blend {
                color: p.color(name).unwrap_or_else(|| gray(0.5)),
                texture: p.string(&format!("{name}.texture")),
                blend: p.float(&format!("{name}.blend")).unwrap_or(default).clamp(0.0, 1.0),
            };
            let diffuse = layer("diffuse", 1.0);
            let specular = layer("specular", diffuse.blend);
            let glossy = p.float("glossyness").unwrap_or(0.0).clamp(0.0, 1.0);
            ShaderKind::Uber { diffuse, specular, glossy, samples: samples(p, 4) }
        }
        "wireframe" => ShaderKind::Wireframe {
            line: p.color("line").unwrap_or_else(|| gray(0.0)),
            fill: p.color("fill").unwrap_or_else(|| gray(1.0)),
            width: p.float("width").unwrap_or(std::f32::consts::PI / 8192.0),
        },
        "view_caustics" => ShaderKind::ViewCaustics,
        "view_irradiance" => ShaderKind::ViewIrradiance,
        "view_global" => ShaderKind::ViewGlobal,
        "show_instance_id" => ShaderKind::Id,
        _ => return false,
    };
    parser.declare(Namespace::Shader, name);
    parser.scene.shaders.push(Shader { name: name.clone(), kind, span });
    true
}

/// Declares a modifier. False if there is none of that type.
pub(super) fn modifier(parser: &mut Parser<'_>, p: &mut Parameters, name: &Name, class: &Name, span: Span) -> bool {
    let texture = |p: &mut Parameters| p.string("texture").unwrap_or_else(|| unwritten("", span));
    let kind = match class.value.as_str() {
        "bump_map" => ModifierKind::Bump { texture: texture(p), scale: p.float("scale").unwrap_or(1.0) },
        "normal_map" => ModifierKind::NormalMap { texture: texture(p) },
        "perlin" => ModifierKind::Perlin {
            function: p.int("function").map_or(0, |function| i32::try_from(function).unwrap_or(2)),
            size: p.float("size").unwrap_or(1.0),
            scale: p.float("scale").unwrap_or(50.0),
        },
        _ => return false,
    };
    parser.declare(Namespace::Modifier, name);
    parser.scene.modifiers.push(Modifier { name: name.clone(), kind, span });
    true
}
