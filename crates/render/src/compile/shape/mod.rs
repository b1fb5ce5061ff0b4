//! Shapes that few words describe: as triangles, as spheres, or by their formula (format reference, §3.13).

mod bezier;
mod gumbo;
mod teapot;

use std::path::Path;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use jaspe_scene::description::{ByteOrder, Geometry, Name, PointSource};
use jaspe_scene::{Diagnostic, Diagnostics, Loader, Scene};

use crate::geometry::analytic::{self, Analytic, Flake};
use crate::geometry::{MeshShape, PerVertex, Placement, Plan, SphereSet};
use crate::math;
use crate::mesh_file;
use crate::motion::Shutter;

/// What shapes are made from, besides their own words.
pub(super) struct Sources<'a> {
    pub scene: &'a Scene,
    pub loader: &'a dyn Loader,
    pub shutter: Shutter,
}

impl Sources<'_> {
    /// Adds a shape of this module with all its appearances. False for another, or one whose file cannot be used,
    /// which is then reported.
    pub fn add(
        &self,
        plan: &mut Plan,
        geometry: &Geometry,
        places: &[Placement],
        diagnostics: &mut Diagnostics,
    ) -> bool {
        if let Some(set) = flake(geometry).and_then(Flake::spheres) {
            plan.spheres(set, places);
        } else if let Some(shape) = analytic(geometry) {
            plan.analytic(shape, places);
        } else if let Geometry::Particles { points, count, radius } = geometry {
            match self.particles(points, *count, *radius) {
                Ok(set) => plan.spheres(set, places),
                Err(diagnostic) => diagnostics.push(diagnostic),
            }
        } else if let Some(mesh) = self.mesh(geometry, diagnostics) {
            plan.mesh(mesh, places);
        } else {
            return false;
        }
        true
    }

    /// The triangles of a shape; `None` for one that has none, or whose file cannot be used, which is then reported.
    fn mesh(&self, geometry: &Geometry, diagnostics: &mut Diagnostics) -> Option<MeshShape> {
        match geometry {
            Geometry::BezierMesh { net, tessellation } => {
                Some(bezier::tessellate(bezier::patches_of_net(net), *tessellation))
            }
            Geometry::Teapot(tessellation) => {
                let patches = bezier::patches_of_table(&teapot::POINTS, &teapot::PATCHES);
                Some(bezier::tessellate(patches, *tessellation))
            }
            Geometry::Gumbo(tessellation) => {
                let patches = bezier::patches_of_table(&gumbo::POINTS, &gumbo::PATCHES);
                Some(bezier::tessellate(patches, *tessellation))
            }
            Geometry::FileMesh { file, smooth_normals } => {
                let mesh = self.load(file).and_then(|(path, bytes)| {
                    mesh_file::read(&bytes, Path::new(&path)).map_err(|why| unusable(file, &why))
                });
                match mesh {
                    Ok(mesh) => Some(if *smooth_normals { smooth(mesh) } else { mesh }),
                    Err(diagnostic) => {
                        diagnostics.push(diagnostic);
                        None
                    }
                }
            }
            _ => None,
        }
    }

    /// Spheres of one size around points of the scene or of a file.
    fn particles(&self, points: &PointSource, count: Option<u32>, radius: f32) -> Result<SphereSet, Diagnostic> {
        let most = count.map_or(usize::MAX, |count| count as usize);
        let centers: Vec<Vec3> = match points {
            PointSource::Points(points) => points.iter().take(most).map(|&point| point.into()).collect(),
            PointSource::File { file, order } => {
                let (_, bytes) = self.load(file)?;
                let read = match order {
                    ByteOrder::BigEndian => f32::from_be_bytes,
                    ByteOrder::LittleEndian => f32::from_le_bytes,
                };
                let (numbers, _) = bytes.as_chunks::<4>();
                let (points, _) = numbers.as_chunks::<3>();
                points.iter().take(most).map(|point| Vec3::from(point.map(read))).collect()
            }
        };
        // What is not finite is in no place; the tree leaves it out.
        Ok(SphereSet { spheres: centers.into_iter().map(|center| center.extend(radius)).collect(), uv: false })
    }

    /// Looks for a file on the include path, then where the program runs.
    fn load(&self, name: &Name) -> Result<(String, Arc<[u8]>), Diagnostic> {
        let written = Path::new(name.value.strip_prefix("//").unwrap_or(&name.value));
        let folders = &self.scene.include_folders;
        for path in folders.iter().map(|folder| folder.join(written)).chain([written.to_path_buf()]) {
            match self.loader.load(&path) {
                Ok(bytes) => return Ok((path.display().to_string(), bytes)),
                Err(error) if error.kind() == std::io::ErrorKind::NotFound => {}
                Err(error) => return Err(unusable(name, &error.to_string())),
            }
        }
        let hint = "add the folder that holds it with the line `includepath FOLDER`";
        Err(Diagnostic::error(name.span, format!("the file `{}` was not found", name.value)).hint(hint))
    }
}

/// Spheres on spheres.
fn flake(geometry: &Geometry) -> Option<Flake> {
    let Geometry::SphereFlake { level, axis, radius } = geometry else { return None };
    let axis = Vec3::from(*axis).as_dvec3().normalize_or(DVec3::Z);
    Some(Flake { level: *level, axis, radius: f64::from(*radius) })
}

/// The shapes that are met by a formula.
fn analytic(geometry: &Geometry) -> Option<Arc<dyn Analytic>> {
    Some(match geometry {
        Geometry::Torus { tube, ring } => Arc::new(analytic::Torus { tube: f64::from(*tube), ring: f64::from(*ring) }),
        Geometry::Cylinder => Arc::new(analytic::Cylinder),
        Geometry::Banchoff => Arc::new(analytic::Banchoff),
        Geometry::SphereFlake { .. } => Arc::new(flake(geometry)?),
        Geometry::Julia { c, iterations, epsilon } => Arc::new(analytic::Julia {
            c: c.map(f64::from).into(),
            iterations: *iterations,
            epsilon: f64::from(*epsilon),
        }),
        Geometry::Hair(hair) => Arc::new(analytic::Hair {
            segments: hair.segments as usize,
            width: hair.width,
            points: hair.points.iter().map(|&point| point.into()).collect(),
        }),
        _ => return None,
    })
}

fn unusable(name: &Name, why: &str) -> Diagnostic {
    Diagnostic::error(name.span, format!("the file `{}` cannot be used: {why}", name.value))
}

/// Gives each vertex the mean of the normals around it, weighted by the areas of their triangles.
fn smooth(mut mesh: MeshShape) -> MeshShape {
    let mut normals = vec![Vec3::ZERO; mesh.points.len()];
    for (index, triangle) in mesh.triangles.iter().enumerate() {
        let [a, b, c] = mesh.triangle_points(index);
        // Twice the area long.
        let normal = math::unit_normal(a, b, c) * (b - a).cross(c - a).length();
        triangle.iter().for_each(|&vertex| normals[vertex as usize] += normal);
    }
    normals.iter_mut().for_each(|normal| *normal = normal.normalize_or_zero());
    mesh.normals = PerVertex::Vertex(normals);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use jaspe_scene::description::Tessellation;

    fn mesh(geometry: &Geometry) -> MeshShape {
        let (scene, loader) = (Scene::default(), jaspe_scene::MemoryLoader::default());
        Sources { scene: &scene, loader: &loader, shutter: Shutter::of(None) }
            .mesh(geometry, &mut Diagnostics::default())
            .expect("a mesh")
    }

    fn bounds(mesh: &MeshShape) -> (Vec3, Vec3) {
        let fold = |pick: fn(Vec3, Vec3) -> Vec3| mesh.points.iter().copied().reduce(pick).expect("points");
        (fold(Vec3::min), fold(Vec3::max))
    }

    #[test]
    fn the_teapot_has_its_size() {
        let pot = mesh(&Geometry::Teapot(Tessellation::default()));
        assert_eq!(pot.triangles.len(), 32 * 2 * 64);
        let (min, max) = bounds(&pot);
        assert!(min.z.abs() < 1e-3 && (max.z - 120.0).abs() < 1e-3, "{min} {max}");
        assert!(min.x > -121.0 && min.x < -110.0 && max.x > 135.0 && max.x < 142.0, "{min} {max}");
        assert!((min.y + 80.0).abs() < 1.0 && (max.y - 80.0).abs() < 1.0, "{min} {max}");
        // It is the same on both sides of y = 0.
        assert!((min.y + max.y).abs() < 1e-3);
    }

    #[test]
    fn the_elephant_has_its_size() {
        let (min, max) = bounds(&mesh(&Geometry::Gumbo(Tessellation { subdivs: 4, smooth: true })));
        assert!(min.cmpge(Vec3::new(0.79, -2.55, -0.92)).all(), "{min}");
        assert!(max.cmple(Vec3::new(23.55, 16.55, 20.31)).all(), "{max}");
        assert!((max - min).min_element() > 15.0, "{min} {max}");
    }

    #[test]
    fn smooth_normals_are_weighted_by_area() {
        let points = vec![Vec3::ZERO, Vec3::X * 2.0, Vec3::Y, Vec3::Z];
        let shape = MeshShape { points, triangles: vec![[0, 1, 2], [0, 2, 3]], ..MeshShape::default() };
        let PerVertex::Vertex(normals) = smooth(shape).normals else { panic!("smooth") };
        assert!(normals[0].distance(Vec3::new(1.0, 0.0, 2.0).normalize()) < 1e-6, "{}", normals[0]);
        assert_eq!(normals[1], Vec3::Z);
    }
}
