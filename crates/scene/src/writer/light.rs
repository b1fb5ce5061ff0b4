//! The `light` block.

use std::io::{self, Write};

use super::text::{Block, color, number, numbers, quoted};
use crate::description::{CornellBox, Ground, Light, LightKind};

pub(super) fn light(light: &Light, out: &mut dyn Write) -> io::Result<()> {
    let block = Block::new("light").entry("type", light.kind.keyword());
    match &light.kind {
        LightKind::Point { color: c, power, position } => {
            block.entry("color", color(c)).entry("power", number(*power)).entry("p", numbers(position))
        }
        LightKind::Directional { source, target, radius, emit, intensity } => block
            .entry("source", numbers(source))
            .entry("target", numbers(target))
            .entry("radius", number(*radius))
            .entry("emit", color(emit))
            .entry("intensity", number(*intensity)),
        LightKind::Spherical { color: c, radiance, center, radius, samples } => block
            .entry("color", color(c))
            .entry("radiance", number(*radiance))
            .entry("center", numbers(center))
            .entry("radius", number(*radius))
            .entry("samples", number(*samples)),
        LightKind::Mesh { name, emit, radiance, samples, shape } => {
            let mut block = block
                .option("name", name.as_ref().map(|name| quoted(&name.value)))
                .entry("emit", color(emit))
                .entry("radiance", number(*radiance))
                .entry("samples", number(*samples));
            block.rows(&format!("points {}", shape.points.len()), &shape.points, out)?;
            block.rows(&format!("triangles {}", shape.triangles.len()), &shape.triangles, out)?;
            block
        }
        LightKind::SunSky { up, east, sundir, turbidity, samples, ground } => {
            let block = block
                .entry("up", numbers(up))
                .entry("east", numbers(east))
                .entry("sundir", numbers(sundir))
                .entry("turbidity", number(*turbidity))
                .entry("samples", number(*samples));
            match ground {
                Ground::Sky => block.entry("ground.extendsky", "true"),
                Ground::Color(ground) => block.entry("ground.color", color(ground)),
            }
        }
        LightKind::Ibl { image, center, up, lock, samples, low_samples } => block
            .entry("image", quoted(&image.value))
            .entry("center", numbers(center))
            .entry("up", numbers(up))
            .entry("lock", lock.to_string())
            .entry("samples", number(*samples))
            .entry("lowsamples", number(*low_samples)),
        LightKind::CornellBox(CornellBox { corners, left, right, top, bottom, back, emit, samples }) => block
            .entry("corner0", numbers(&corners[0]))
            .entry("corner1", numbers(&corners[1]))
            .entry("left", color(left))
            .entry("right", color(right))
            .entry("top", color(top))
            .entry("bottom", color(bottom))
            .entry("back", color(back))
            .entry("emit", color(emit))
            .entry("samples", number(*samples)),
    }
    .close(out)
}
