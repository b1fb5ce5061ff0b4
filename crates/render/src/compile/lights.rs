//! Lights in Sunflow's meaning, and the shapes by which they are seen.

use std::sync::Arc;

use glam::{DMat4, Vec3};
use jaspe_scene::description::{CornellBox, Ground, LightKind};
use jaspe_scene::{Diagnostics, Dialect, Scene};

use super::bounded;
use super::materials::{Materials, Pictures, working};
use crate::affine;
use crate::environment::{self, Environment, Table};
use crate::geometry::{MeshShape, Placement, Plan};
use crate::light::{Arrival, Ball, Beam, Ceiling, Lamp, Light, Shining};
use crate::material::{Albedo, Coat, Material, Response};

/// The lights of a scene.
#[derive(Default)]
pub(super) struct Lit {
    pub lights: Vec<Light>,
    pub surroundings: Option<Arc<Environment>>,
    shapes: Vec<(Seen, Vec<u32>)>,
}

/// How a light is seen.
enum Seen {
    Ball { center: Vec3, radius: f32 },
    Triangles(MeshShape),
}

/// How many samples a light gets: one where the scene asks for none.
fn light_samples(written: u32) -> u32 {
    bounded(written).max(1)
}

pub(super) fn compile(
    scene: &Scene,
    pictures: &mut Pictures<'_>,
    materials: &mut Materials<'_>,
    diagnostics: &mut Diagnostics,
) -> Lit {
    let mut lit = Lit::default();
    for light in &scene.lights {
        lit.add(&light.kind, pictures, materials, diagnostics);
    }
    lit
}

impl Lit {
    /// Adds the shapes by which the lights are seen.
    pub fn show(self, plan: &mut Plan) -> (Vec<Light>, Option<Arc<Environment>>) {
        for (shape, materials) in self.shapes {
            match shape {
                Seen::Ball { center, radius } => {
                    let matrix = affine::ball(center.to_array(), radius);
                    Placement::new(matrix, materials).iter().for_each(|place| plan.sphere(place));
                }
                Seen::Triangles(mesh) => {
                    if let Some(place) = Placement::new(DMat4::IDENTITY, materials) {
                        plan.mesh(mesh, &[place]);
                    }
                }
            }
        }
        (self.lights, self.surroundings)
    }

    fn add(
        &mut self,
        kind: &LightKind,
        pictures: &mut Pictures<'_>,
        materials: &mut Materials<'_>,
        diagnostics: &mut Diagnostics,
    ) {
        let linear = |color| working(color, Dialect::Sunflow);
        let shining = |radiance| Material::new(Albedo::Color(radiance), Response::Emitter);
        match kind {
            LightKind::Point { color, power, position } => {
                let (position, power) = (Vec3::from_array(*position), linear(color) * *power);
                self.lights.push(Light::Point(Lamp { position, power }));
            }
            LightKind::Directional { source, target, radius, emit, intensity } => {
                let source = Vec3::from_array(*source);
                if let Some(direction) = (Vec3::from_array(*target) - source).try_normalize() {
                    let irradiance = linear(emit) * *intensity;
                    self.lights.push(Light::Directional(Beam { source, direction, radius: *radius, irradiance }));
                }
            }
            LightKind::Spherical { color, radiance, center, radius, samples } => {
                let (center, radiance) = (Vec3::from_array(*center), linear(color) * *radiance);
                let samples = light_samples(*samples);
                self.lights.push(Light::Ball(Ball { center, radius: *radius, radiance, samples }));
                self.shapes.push((Seen::Ball { center, radius: *radius }, vec![materials.add(shining(radiance))]));
            }
            LightKind::Mesh { emit, radiance, samples, shape, .. } => {
                let radiance = linear(emit) * *radiance;
                let mesh = MeshShape {
                    points: shape.points.iter().map(|&point| point.into()).collect(),
                    triangles: shape.triangles.clone(),
                    ..MeshShape::default()
                };
                let corners = (0..mesh.triangles.len()).map(|i| mesh.triangle_points(i));
                let triangles = Shining::all(corners, radiance).into();
                self.lights.push(Light::Triangles { triangles, samples: light_samples(*samples) });
                self.shapes.push((Seen::Triangles(mesh), vec![materials.add(shining(radiance))]));
            }
            LightKind::SunSky { up, east, sundir, turbidity, samples, ground } => {
                let [up, east, sundir] = [*up, *east, *sundir].map(Vec3::from_array);
                let ground = match ground {
                    Ground::Sky => None,
                    Ground::Color(color) => Some(linear(color)),
                };
                if let Some((direction, irradiance)) = environment::sun(up, sundir, *turbidity) {
                    self.lights.push(Light::Sun(Arrival { direction, distance: f32::INFINITY, irradiance }));
                }
                let sky = Environment::sky(up, east, sundir, *turbidity, ground);
                self.surround(sky, [*samples, *samples], false);
            }
            LightKind::Ibl { image, center, up, lock, samples, low_samples } => match pictures.picture(image) {
                Ok(map) => {
                    let environment = Environment::picture(map, Vec3::from_array(*center), Vec3::from_array(*up));
                    self.surround(environment, [*samples, *low_samples], *lock);
                }
                Err(diagnostic) => diagnostics.push(diagnostic),
            },
            LightKind::CornellBox(room) => self.cornell(room, materials),
        }
    }

    fn surround(&mut self, environment: Environment, samples: [u32; 2], lock: bool) {
        let environment = Arc::new(environment);
        let [samples, low_samples] = samples.map(light_samples);
        let light = if lock {
            Light::beams(&environment, [samples, low_samples], self.lights.len() as u64)
        } else {
            Light::Surroundings { table: Arc::new(Table::new(&environment)), samples }
        };
        self.lights.push(light);
        self.surroundings.get_or_insert(environment);
    }

    /// The room's walls and ceiling, and the light in its middle.
    fn cornell(&mut self, room: &CornellBox, materials: &mut Materials<'_>) {
        let [a, b] = room.corners.map(Vec3::from_array);
        let (min, max) = (a.min(b), a.max(b));
        let radiance = working(&room.emit, Dialect::Sunflow);
        let light = Ceiling { room: [min, max], radiance, samples: light_samples(room.samples) };
        let mut mesh = MeshShape::default();
        let mut rectangle = |corners: [Vec3; 4], slot: u32| {
            let first = mesh.points.len() as u32;
            mesh.points.extend(corners);
            mesh.triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
            mesh.slots.extend([slot; 2]);
        };
        let at = Vec3::new;
        let along_x = |x: f32| [at(x, min.y, min.z), at(x, max.y, min.z), at(x, max.y, max.z), at(x, min.y, max.z)];
        let along_z = |low: Vec3, high: Vec3, z: f32| {
            [at(low.x, low.y, z), at(low.x, high.y, z), at(high.x, high.y, z), at(high.x, low.y, z)]
        };
        let turned = |[a, b, c, d]: [Vec3; 4]| [a, d, c, b];
        // All corners run counter-clockwise as seen from within.
        rectangle(turned(along_x(min.x)), 0);
        rectangle(along_x(max.x), 1);
        rectangle(
            [at(min.x, max.y, min.z), at(min.x, max.y, max.z), at(max.x, max.y, max.z), at(max.x, max.y, min.z)],
            2,
        );
        rectangle(turned(along_z(min, max, min.z)), 3);
        // The ceiling, around its middle ninth.
        let [low, high] = light.corners();
        let (xs, ys) = ([min.x, low.x, high.x, max.x], [min.y, low.y, high.y, max.y]);
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            let slot = if (i, j) == (1, 1) { 5 } else { 4 };
            rectangle(along_z(at(xs[i], ys[j], max.z), at(xs[i + 1], ys[j + 1], max.z), max.z), slot);
        }
        let matte = |color| Material::new(Albedo::Color(working(color, Dialect::Sunflow)), Response::Matte(Coat::None));
        let walls = [&room.left, &room.right, &room.back, &room.bottom, &room.top].map(matte);
        let mut slots: Vec<u32> = walls.into_iter().map(|wall| materials.add(wall)).collect();
        slots.push(materials.add(Material::new(Albedo::Color(radiance), Response::Emitter)));
        self.shapes.push((Seen::Triangles(mesh), slots));
        self.lights.push(Light::Ceiling(light));
    }
}
