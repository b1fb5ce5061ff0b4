//! Lights.

use super::super::Parser;
use super::super::gi::MOST_SAMPLES;
use super::geometry::triangle_mesh;
use super::value::Parameters;
use crate::description::{Color, CornellBox, Ground, Light, LightKind, Mesh, Name, Triangles};
use crate::source::Span;

/// Declares a light. False if there is none of that type.
pub(super) fn light(parser: &mut Parser<'_>, p: &mut Parameters, name: &Name, class: &Name, span: Span) -> bool {
    let gray = |value: f32| Color::new_linear([value; 3], span);
    let kind = match class.value.as_str() {
        "point" => LightKind::Point {
            color: p.color("power").unwrap_or_else(|| gray(1.0)),
            power: 1.0,
            position: p.point("center").unwrap_or_default(),
        },
        "directional" => {
            let source = p.point("source").unwrap_or_default();
            let direction = p.point("dir").unwrap_or([0.0, 0.0, 1.0]);
            LightKind::Directional {
                source,
                target: std::array::from_fn(|axis| source[axis] + direction[axis]),
                radius: p.float("radius").unwrap_or(1.0),
                emit: p.color("radiance").unwrap_or_else(|| gray(1.0)),
                intensity: 1.0,
            }
        }
        "sphere" => LightKind::Spherical {
            color: p.color("radiance").unwrap_or_else(|| gray(1.0)),
            radiance: 1.0,
            center: p.point("center").unwrap_or_default(),
            radius: p.float("radius").filter(|radius| *radius > 0.0).unwrap_or(1.0),
            samples: samples(p, "samples", 4),
        },
        "triangle_mesh" => {
            let (emit, samples) = (p.color("radiance").unwrap_or_else(|| gray(1.0)), samples(p, "samples", 4));
            let Mesh { points, triangles, .. } = triangle_mesh(p).unwrap_or_default();
            let (name, shape) = (Some(name.clone()), Triangles { points, triangles });
            LightKind::Mesh { name, emit, radiance: 1.0, samples, shape }
        }
        "sunsky" => {
            let mut direction = |name: &str, default: [f32; 3]| {
                p.point(name).filter(|direction| *direction != [0.0; 3]).unwrap_or(default)
            };
            let (up, east) = (direction("up", [0.0, 0.0, 1.0]), direction("east", [0.0, 1.0, 0.0]));
            let sundir = direction("sundir", [1.0; 3]);
            let extends = p.bool("ground.extendsky").unwrap_or(false);
            let ground = p.color("ground.color").unwrap_or_else(|| gray(0.0));
            LightKind::SunSky {
                up,
                east,
                sundir,
                turbidity: p.float("turbidity").unwrap_or(6.0),
                samples: samples(p, "samples", 64),
                ground: if extends { Ground::Sky } else { Ground::Color(ground) },
            }
        }
        "ibl" => {
            let Some(image) = p.string("texture") else { return true };
            LightKind::Ibl {
                image,
                center: p.point("center").filter(|v| *v != [0.0; 3]).unwrap_or([0.0, 0.0, 1.0]),
                up: p.point("up").filter(|v| *v != [0.0; 3]).unwrap_or([0.0, 1.0, 0.0]),
                lock: p.bool("fixed").unwrap_or(false),
                samples: samples(p, "samples", 64),
                low_samples: samples(p, "lowsamples", 8),
            }
        }
        "cornell_box" => {
            let mut color =
                |name: &str, default: [f32; 3]| p.color(name).unwrap_or_else(|| Color::new_linear(default, span));
            let (left, right) = (color("leftColor", [0.8, 0.25, 0.25]), color("rightColor", [0.25, 0.25, 0.8]));
            let (top, bottom) = (color("topColor", [0.7; 3]), color("bottomColor", [0.7; 3]));
            let (back, emit) = (color("backColor", [0.7; 3]), color("radiance", [1.0; 3]));
            let corners = [p.point("corner0").unwrap_or([-1.0; 3]), p.point("corner1").unwrap_or([1.0; 3])];
            let samples = samples(p, "samples", 16);
            LightKind::CornellBox(CornellBox { corners, left, right, top, bottom, back, emit, samples })
        }
        _ => return false,
    };
    parser.scene.lights.push(Light { kind, span });
    true
}

fn samples(p: &mut Parameters, name: &str, default: u32) -> u32 {
    p.whole(name, 0, MOST_SAMPLES).unwrap_or(default)
}
