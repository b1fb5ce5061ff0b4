//! Bicubic Bézier patches → triangles (format reference, §3.13).

use glam::{DVec3, Vec2, Vec3};
use jaspe_scene::description::{BezierNet, Tessellation};

use crate::geometry::{MeshShape, PerVertex};

/// Sixteen control points: four rows along v, u fastest.
pub(super) type Patch = [DVec3; 16];

/// The patches of a table of points and of sixteen indices for each patch.
pub(super) fn patches_of_table<'a>(
    points: &'a [[f32; 3]],
    patches: &'a [[u16; 16]],
) -> impl Iterator<Item = Patch> + 'a {
    patches.iter().map(|patch| patch.map(|index| Vec3::from(points[usize::from(index)]).as_dvec3()))
}

/// The patches of a net, which share the points on their edges.
pub(super) fn patches_of_net(net: &BezierNet) -> impl Iterator<Item = Patch> + '_ {
    let [across, along] = net.patches();
    let [width, height] = net.size.map(|size| size as usize);
    let starts = (0..along as usize).flat_map(move |v| (0..across as usize).map(move |u| [3 * u, 3 * v]));
    starts.map(move |[u, v]| {
        std::array::from_fn(|k| {
            let (column, row) = ((u + k % 4) % width, (v + k / 4) % height);
            Vec3::from(net.points[column + width * row]).as_dvec3()
        })
    })
}

/// Each patch as a grid of `subdivs` × `subdivs` pairs of triangles, with texture coordinates from 0 to 1 over it.
pub(super) fn tessellate(
    patches: impl Iterator<Item = Patch>,
    Tessellation { subdivs, smooth }: Tessellation,
) -> MeshShape {
    let weights: Vec<[[f64; 4]; 2]> = (0..=subdivs).map(|i| bernstein(f64::from(i) / f64::from(subdivs))).collect();
    let mut mesh = MeshShape::default();
    let (mut normals, mut uvs) = (Vec::new(), Vec::new());
    let edge = subdivs + 1;
    for patch in patches {
        let first = mesh.points.len() as u32;
        for (j, v) in weights.iter().enumerate() {
            for (i, u) in weights.iter().enumerate() {
                mesh.points.push(blend(&patch, &u[0], &v[0]).as_vec3());
                uvs.push(Vec2::new(i as f32, j as f32) / subdivs as f32);
                if smooth {
                    let normal = blend(&patch, &u[1], &v[0]).cross(blend(&patch, &u[0], &v[1]));
                    // In double precision and scaled, since the square of a small model's edge may vanish otherwise.
                    normals.push(normal.normalize_or_zero().as_vec3());
                }
            }
        }
        let cells = (0..subdivs).flat_map(|j| (0..subdivs).map(move |i| first + i + edge * j));
        mesh.triangles.extend(cells.flat_map(|a| [[a, a + 1, a + edge], [a + 1, a + edge + 1, a + edge]]));
    }
    mesh.uvs = PerVertex::Vertex(uvs);
    if smooth {
        mesh.normals = PerVertex::Vertex(normals);
    }
    mesh
}

/// The cubic Bernstein polynomials at `t`, and their derivatives.
fn bernstein(t: f64) -> [[f64; 4]; 2] {
    let s = 1.0 - t;
    [
        [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t],
        [-3.0 * s * s, 3.0 * s * s - 6.0 * s * t, 6.0 * s * t - 3.0 * t * t, 3.0 * t * t],
    ]
}

fn blend(patch: &Patch, u: &[f64; 4], v: &[f64; 4]) -> DVec3 {
    let row = |i: usize| (0..4).map(|j| patch[4 * i + j] * u[j]).sum::<DVec3>();
    (0..4).map(|i| row(i) * v[i]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A flat patch over [0, 3]², with the height x y: it is bilinear, and so is the patch exactly.
    fn saddle() -> Patch {
        std::array::from_fn(|k| {
            let (x, y) = ((k % 4) as f64, (k / 4) as f64);
            DVec3::new(x, y, x * y)
        })
    }

    #[test]
    fn vertices_lie_on_the_surface_and_normals_stand_on_it() {
        let mesh = tessellate(std::iter::once(saddle()), Tessellation { subdivs: 5, smooth: true });
        assert_eq!((mesh.points.len(), mesh.triangles.len()), (36, 50));
        let PerVertex::Vertex(normals) = &mesh.normals else { panic!("smooth") };
        let PerVertex::Vertex(uvs) = &mesh.uvs else { panic!("uvs") };
        for ((point, normal), uv) in mesh.points.iter().zip(normals).zip(uvs) {
            assert!((point.z - point.x * point.y).abs() < 1e-5, "{point}");
            assert!((point.truncate() / 3.0 - *uv).length() < 1e-6);
            // The gradient of z − x y.
            let gradient = Vec3::new(-point.y, -point.x, 1.0).normalize();
            assert!(normal.distance(gradient) < 1e-5, "{normal} {gradient}");
        }
    }

    #[test]
    fn triangles_turn_the_way_of_their_normals() {
        let mesh = tessellate(std::iter::once(saddle()), Tessellation { subdivs: 3, smooth: true });
        let PerVertex::Vertex(normals) = &mesh.normals else { panic!("smooth") };
        for triangle in &mesh.triangles {
            let [a, b, c] = triangle.map(|i| mesh.points[i as usize]);
            assert!((b - a).cross(c - a).dot(normals[triangle[0] as usize]) > 0.0);
        }
    }

    #[test]
    fn flat_patches_have_no_normals() {
        let mesh = tessellate(std::iter::once(saddle()), Tessellation { subdivs: 1, smooth: false });
        assert!(matches!(mesh.normals, PerVertex::None));
        assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
    }

    #[test]
    fn patches_of_a_net_share_their_edges_and_wrap() {
        let points = (0..7 * 4).map(|k| [(k % 7) as f32, (k / 7) as f32, 0.0]).collect();
        let net = BezierNet { size: [7, 4], wrap: [false, false], points };
        let patches: Vec<Patch> = patches_of_net(&net).collect();
        assert_eq!(patches.len(), 2);
        assert_eq!((patches[0][3], patches[1][0]), (DVec3::new(3.0, 0.0, 0.0), DVec3::new(3.0, 0.0, 0.0)));
        let points = (0..6 * 4).map(|k| [(k % 6) as f32, (k / 6) as f32, 0.0]).collect();
        let net = BezierNet { size: [6, 4], wrap: [true, false], points };
        let patches: Vec<Patch> = patches_of_net(&net).collect();
        assert_eq!((patches.len(), patches[1][3], patches[1][0]), (2, DVec3::ZERO, DVec3::new(3.0, 0.0, 0.0)));
    }
}
