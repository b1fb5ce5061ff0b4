//! Which triangle of a mesh each pixel of its maps belongs to.

use std::collections::VecDeque;

use glam::{DVec2, DVec3};

use crate::model::{Chart, Model};
use crate::surface::Frame;

/// For each pixel a triangle: the one that covers it, or else one that is near, so that what filters and mipmaps gather across a
/// seam continues the chart.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layout {
    extent: [u32; 2],
    triangles: Vec<u32>,
}

/// No triangle yet.
const NONE: u32 = u32::MAX;

/// A triangle's texture coordinates, in the square from 0 to 1 if it is within one tile of the plane.
fn uvs(model: &Model, triangle: usize) -> [DVec2; 3] {
    let uvs = model.corners(triangle).map(|corner| DVec2::from(corner.uv));
    let tile = ((uvs[0] + uvs[1] + uvs[2]) / 3.0).floor();
    uvs.map(|uv| uv - tile)
}

impl Layout {
    /// That of a mesh; `None` where no pixel's centre is in a chart.
    pub fn new(model: &Model, extent: [u32; 2]) -> Option<Layout> {
        let mut layout = Layout { extent, triangles: vec![NONE; extent[0] as usize * extent[1] as usize] };
        for triangle in 0..model.triangles.len() {
            layout.cover(triangle as u32, uvs(model, triangle));
        }
        layout.spread().then_some(layout)
    }

    /// Gives a triangle the pixels whose centres are in it and that are still free.
    fn cover(&mut self, triangle: u32, uvs: [DVec2; 3]) {
        let [width, height] = self.extent.map(f64::from);
        // In pixels from the upper left corner; centres are at halves.
        let [a, b, c] = uvs.map(|uv| DVec2::new(uv.x * width, (1.0 - uv.y) * height));
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        let range = |least: f64, most: f64, side: u32| {
            let end = |place: f64| place.clamp(0.0, f64::from(side)) as u32;
            end((least - 0.5).ceil())..end((most - 0.5).floor() + 1.0)
        };
        let side = |from: DVec2, to: DVec2, at: DVec2| (to - from).perp_dot(at - from);
        for y in range(least.y, most.y, self.extent[1]) {
            for x in range(least.x, most.x, self.extent[0]) {
                let at = DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                let sides = [side(a, b, at), side(b, c, at), side(c, a, at)];
                let inside = sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0);
                let place = y as usize * self.extent[0] as usize + x as usize;
                if inside && self.triangles[place] == NONE {
                    self.triangles[place] = triangle;
                }
            }
        }
    }

    /// Gives the free pixels the triangles of their neighbours, ring by ring. False if all are free.
    fn spread(&mut self) -> bool {
        let [width, height] = self.extent.map(|side| side as usize);
        let mut waiting: VecDeque<usize> = (0..self.triangles.len()).filter(|&i| self.triangles[i] != NONE).collect();
        let found = !waiting.is_empty();
        while let Some(place) = waiting.pop_front() {
            let (x, y) = (place % width, place / width);
            let neighbours = [
                (x > 0).then(|| place - 1),
                (x + 1 < width).then(|| place + 1),
                (y > 0).then(|| place - width),
                (y + 1 < height).then(|| place + width),
            ];
            for neighbour in neighbours.into_iter().flatten() {
                if self.triangles[neighbour] == NONE {
                    self.triangles[neighbour] = self.triangles[place];
                    waiting.push_back(neighbour);
                }
            }
        }
        found
    }

    /// The frame of a pixel, with the mesh so many times as large.
    pub fn frame(&self, model: &Model, [x, y]: [i64; 2], scale: f64) -> Frame {
        let [width, height] = self.extent;
        let (x, y) = (x.rem_euclid(i64::from(width)), y.rem_euclid(i64::from(height)));
        let triangle = self.triangles[y as usize * width as usize + x as usize] as usize;
        let corners = model.corners(triangle);
        let (points, uvs) = (corners.map(|corner| scale * DVec3::from(corner.point)), uvs(model, triangle));
        let chart = Chart::new(points, uvs).expect("a model has charts only that span something");
        let [width, height] = [width, height].map(f64::from);
        let uv = DVec2::new((x as f64 + 0.5) / width, 1.0 - (y as f64 + 0.5) / height);
        // The normal between the corners; on the border of the triangle where the pixel is outside.
        let area = (uvs[1] - uvs[0]).perp_dot(uvs[2] - uvs[0]);
        let weight = |k: usize| {
            let (from, to) = (uvs[(k + 1) % 3], uvs[(k + 2) % 3]);
            ((to - from).perp_dot(uv - from) / area).clamp(0.0, 1.0)
        };
        let normal: DVec3 = (0..3).map(|k| weight(k) * DVec3::from(corners[k].normal)).sum();
        let normal = normal.normalize_or(DVec3::from(corners[0].normal));
        let tangent = chart.tangent(normal);
        let bitangent = chart.hand * normal.cross(tangent);
        Frame { point: chart.point(uv), right: chart.by_u / width, up: chart.by_v / height, tangent, bitangent }
    }
}
