//! Sunflow's meaning of shaders and lights: linear light, inverse squares, Fresnel mirrors (format reference, §3).

mod caustics;
mod coat;
mod direct;
mod halton;
mod indirect;
mod look;
mod photons;
mod point;
mod specular;
mod virtual_lights;

use std::sync::{Arc, Mutex, PoisonError};

use glam::Vec3;
use jaspe_texture::Space;

use crate::clock::{Clock, Spent, Stage};
use crate::environment::Environment;
use crate::film::Pixel;
use crate::geometry::{Geometry, Hit, Hits, Rays, Rows, Scratch, Surface};
use crate::light::{Fan, Light};
use crate::material::{Albedo, Coat, Gloss, Response};
use crate::options::{Look, Observer};
use crate::wave::{Batch, Path, Queues, RayKind, Rules, World};
use caustics::{CausticMap, Nearest};
use coat::Bsdf;
use direct::{Lit, Shadows, Waiting};
pub(crate) use indirect::Indirect;
use photons::Senders;
use point::{Point, Points};
use virtual_lights::VirtualLights;

/// The dialect's own part of a scene.
#[derive(Debug, Clone)]
pub(crate) struct Sunflow {
    pub lights: Vec<Light>,
    pub background: Option<Vec3>,
    /// A sky or a picture all around.
    pub surroundings: Option<Arc<Environment>>,
    pub indirect: Indirect,
    pub caustics: Option<Caustics>,
    /// Most reflections, refractions and diffuse bounces of a path.
    pub max_reflection: u8,
    pub max_refraction: u8,
    pub max_diffuse: u8,
}

/// Light that mirrors and glass throw.
#[derive(Debug, Clone)]
pub(crate) enum Caustics {
    /// Photons to be sent, how many of them make an estimate, and how near they must be.
    Wanted {
        emit: u32,
        gather: u32,
        radius: f32,
    },
    Map(Arc<CausticMap>),
}

/// Rays of a wave, about, where every sample sends many.
const RAYS: usize = 32_768;

/// Where a texture is looked at, and the side of what is seen of it there.
#[derive(Default)]
struct TexturePoints {
    points: Rows,
    footprints: Vec<f32>,
}

/// One thread's room for the hits of a batch.
#[derive(Default)]
pub(crate) struct Room {
    points: Points,
    texture_points: TexturePoints,
    colors: Vec<[f32; 3]>,
    /// Of the coat.
    gloss: Vec<[f32; 3]>,
    shadows: Shadows,
    waiting: Waiting,
    fan: Fan,
    /// What short rays meet.
    near: Hits,
    nearest: Nearest,
    scratch: Scratch,
}

impl Rules for Sunflow {
    /// Linear light.
    type Nodes = Vec<Vec3>;
    type Room = Room;
    const T_MIN: f32 = 0.0;

    fn wave(&self) -> usize {
        let fan = if let Indirect::Paths { samples } = self.indirect { samples } else { 1 };
        (RAYS / fan.max(1) as usize).clamp(16, 1024)
    }

    fn shade(&self, batch: &Batch<'_>, room: &mut Room, queues: &mut Queues<Vec<Vec3>>) {
        room.prepare(batch, &mut queues.clock);
        if let Albedo::Procedural(_) = batch.material.albedo {
            queues.stats.texture_points += batch.len() as u64;
        }
        let mut lit = Vec::new();
        for i in 0..batch.len() {
            let point = room.point(batch, i);
            let (bsdf, color) = self.respond(batch, &point, room, queues);
            if !bsdf.is_black() {
                lit.push(Lit { point, bsdf, color });
            }
            room.shadows.flush(batch.geometry, queues, &mut room.scratch);
        }
        self.illuminate(batch.geometry, &lit, room, queues);
        if let Indirect::VirtualLights(lights) = &self.indirect {
            lit.retain(|lit| lit.color != Vec3::ZERO && lit.point.path.depth.diffuse < self.max_diffuse);
            lights.illuminate(batch.geometry, &lit, room, queues);
            lights.compensate(self, batch.geometry, &lit, room, queues);
        }
        room.shadows.trace(batch.geometry, queues, &mut room.scratch);
    }

    fn miss(&self, path: &Path, direction: Vec3, nodes: &mut Vec<Vec3>) -> bool {
        if let Some(surroundings) = &self.surroundings
            && path.sees_light()
        {
            nodes[path.node as usize] += path.weight * surroundings.radiance(direction);
            return true;
        }
        // Sunflow: backgrounds are seen by camera rays only (R3).
        if let Some(background) = self.background.filter(|_| path.depth.total() == 0) {
            nodes[path.node as usize] += path.weight * background;
            return true;
        }
        false
    }

    fn seen(&self, geometry: &Geometry, rays: &Rays, hits: &Hits, i: usize) -> Vec3 {
        let (ray, hit) = (rays.get(i), hits.get(i));
        let Surface { geometric, normal, .. } = geometry.surface(&ray, &hit);
        if ray.direction.dot(geometric) >= 0.0 { -normal } else { normal }
    }

    fn resolve(&self, nodes: &mut Vec<Vec3>, pixels: &mut [Pixel]) {
        // Scenes with absurd numbers overflow; one sample must not spoil its pixel, nor a sum of them overflow.
        let sane = |light: &Vec3| if light.is_finite() { light.min(Vec3::splat(1e30)) } else { Vec3::ZERO };
        pixels.iter_mut().zip(nodes).for_each(|(pixel, light)| *pixel = sane(light).extend(1.0).to_array());
    }
}

impl Room {
    /// Works out the points of a batch and their colours.
    fn prepare(&mut self, batch: &Batch<'_>, clock: &mut Clock) {
        let Room { points, texture_points, colors, gloss, .. } = self;
        points.locate(batch, clock);
        clock.lap(Stage::Shade);
        paint(&batch.material.albedo, batch, points, texture_points, colors);
        let specular = match &batch.material.response {
            Response::Matte(Coat::Phong { specular, .. } | Coat::Ward { specular, .. } | Coat::Mirror { specular }) => {
                specular
            }
            _ => &Gloss::Color(Vec3::ZERO),
        };
        match specular {
            Gloss::Color(color) => {
                gloss.clear();
                gloss.resize(colors.len(), color.to_array());
            }
            Gloss::Albedo(factor) => {
                gloss.clone_from(colors);
                gloss.iter_mut().flatten().for_each(|c| *c *= factor);
            }
            Gloss::Painted(albedo) => paint(albedo, batch, points, texture_points, gloss),
        }
        clock.lap(Stage::Texture);
    }

    /// A prepared point.
    fn point<'a>(&self, batch: &Batch<'a>, i: usize) -> Point<'a> {
        self.points.get(batch, i, Vec3::from_array(self.colors[i]), Vec3::from_array(self.gloss[i]))
    }
}

impl Path {
    /// Whether the ray sees lights, skies, mirrors and glass: blurred ones get that light by other ways.
    fn sees_light(&self) -> bool {
        !matches!(self.kind, RayKind::Glossy | RayKind::Gather)
    }
}

/// Colours of a batch, one per member.
fn paint(albedo: &Albedo, batch: &Batch<'_>, points: &Points, seen: &mut TexturePoints, colors: &mut Vec<[f32; 3]>) {
    let (geometry, point) = (batch.geometry, &points.surfaces.point);
    let uv = |i: usize| geometry.uv(&batch.hit(i), point.get(i));
    let count = batch.len();
    colors.resize(count, [0.0; 3]);
    match albedo {
        Albedo::Color(color) => colors.fill(color.to_array()),
        Albedo::Picture(picture) => {
            colors.iter_mut().enumerate().for_each(|(i, color)| *color = picture.smooth(uv(i)).to_array());
        }
        Albedo::Procedural(procedural) => {
            let local = |i: usize| geometry.pose(&batch.hit(i)).object_from_world.point(point.get(i));
            let TexturePoints { points: texture_points, footprints } = seen;
            texture_points.resize(count);
            match procedural.texture.space() {
                Space::World => {}
                Space::Local => (0..count).for_each(|i| texture_points.set(i, local(i))),
                Space::Uv => (0..count).for_each(|i| texture_points.set(i, uv(i).extend(0.0))),
            }
            let scale = |hit: &Hit| match procedural.texture.space() {
                Space::World => 1.0,
                Space::Local => geometry.pose(hit).object_from_world.scale(),
                Space::Uv => geometry.uv_scale(hit),
            };
            footprints.clear();
            footprints.extend((0..count).map(|i| points.footprint(batch, i) * scale(&batch.hit(i))));
            let texture_points = if procedural.texture.space() == Space::World { point } else { &*texture_points };
            procedural.evaluate(texture_points, Some(footprints), colors);
        }
        Albedo::Blend { color, over, amount } => {
            paint(over, batch, points, seen, colors);
            let mix = |over: &mut [f32; 3]| *over = color.lerp(Vec3::from_array(*over), *amount).to_array();
            colors.iter_mut().for_each(mix);
        }
    }
}

impl Sunflow {
    /// What a surface does with the ray that came to it. Returns how it takes light from the lights, and its matte colour.
    fn respond(
        &self,
        batch: &Batch<'_>,
        point: &Point<'_>,
        room: &mut Room,
        queues: &mut Queues<Vec<Vec3>>,
    ) -> (Bsdf, Vec3) {
        let specular = point.path.sees_light();
        match &batch.material.response {
            Response::Constant => self.emit(point, point.color, queues),
            Response::Emitter if specular && !point.inside => self.emit(point, point.color, queues),
            Response::Emitter => {}
            Response::Matte(coat) => return self.matte(batch, coat, point, specular, room, queues),
            Response::Look(Look::Gray) => return (Bsdf::matte(Vec3::splat(0.5)), Vec3::ZERO),
            Response::Mirror if specular => self.reflect(point, schlick(point.color, point.cosine), queues),
            Response::Glass { eta, absorption } if specular => self.glass(point, *eta, *absorption, queues),
            // Behind a blurred ray mirrors and glass are black: §3.6.
            Response::Mirror | Response::Glass { .. } => {}
            Response::AmbientOcclusion { dark, samples, distance } => {
                self.occlusion(point, [*dark, point.color], *samples, *distance, room, queues);
            }
            Response::Wireframe { line, width } => self.wireframe(batch, point, *line, *width, queues),
            Response::ViewIrradiance => self.gather(point, Vec3::ONE, room, queues),
            Response::ViewCaustics => self.add_caustics(point, Vec3::ONE, &mut room.nearest, queues),
            Response::Look(look) => self.look(batch, point, *look, room, queues),
        }
        (Bsdf::matte(Vec3::ZERO), Vec3::ZERO)
    }

    fn emit(&self, point: &Point<'_>, light: Vec3, queues: &mut Queues<Vec<Vec3>>) {
        queues.nodes[point.path.node as usize] += point.path.weight * light;
    }

    /// A matte surface with its coat: `specular` coats are left out behind blurred rays.
    fn matte(
        &self,
        batch: &Batch<'_>,
        coat: &Coat,
        point: &Point<'_>,
        specular: bool,
        room: &mut Room,
        queues: &mut Queues<Vec<Vec3>>,
    ) -> (Bsdf, Vec3) {
        let mut color = point.color;
        let mut bsdf = Bsdf::matte(color);
        match *coat {
            _ if !specular => {}
            Coat::None => {}
            Coat::Phong { power, samples, .. } => {
                bsdf = bsdf.with_phong(point, power);
                self.glossy_phong(point, power, samples, queues);
            }
            Coat::Ward { roughness, samples, .. } => {
                let frame = point.frame(batch);
                bsdf = bsdf.with_ward(point, frame, roughness);
                self.glossy_ward(point, frame, roughness, samples, queues);
            }
            Coat::Mirror { .. } => self.reflect(point, schlick(point.gloss, point.cosine), queues),
            Coat::Touch { reflection, .. } => {
                let share = 1.0 / (1.0 + reflection);
                color *= share;
                bsdf = Bsdf::matte(color);
                if reflection > 0.0 {
                    self.reflect(point, Vec3::splat(reflection * share), queues);
                }
            }
        }
        if color != Vec3::ZERO {
            self.gather(point, color, room, queues);
            self.add_caustics(point, color, &mut room.nearest, queues);
        }
        (bsdf, color)
    }

    /// Light that comes to a matte surface of a colour by way of mirrors and glass.
    fn add_caustics(&self, point: &Point<'_>, color: Vec3, nearest: &mut Nearest, queues: &mut Queues<Vec<Vec3>>) {
        if let Some(Caustics::Map(map)) = &self.caustics {
            let behind = point.path.depth.diffuse > 0;
            let irradiance = map.irradiance(point.front, point.surface.normal, behind, nearest);
            self.emit(point, color * irradiance * std::f32::consts::FRAC_1_PI, queues);
        }
    }

    /// Sends the photons that the scene asks for, and keeps what comes of them; in vain where the observer has enough.
    /// Returns what that cost, too.
    pub fn prepare(&self, world: &World, observer: &dyn Observer) -> (Sunflow, Spent) {
        let mut ready = self.clone();
        let senders = Senders { rules: self, world, observer, spent: Mutex::default() };
        if let Some(Caustics::Wanted { emit, gather, radius }) = self.caustics {
            ready.caustics = CausticMap::send(&senders, emit, gather, radius).map(|map| Caustics::Map(Arc::new(map)));
        }
        if let Indirect::Instant { samples, sets, bias, bias_samples } = self.indirect {
            let lights = VirtualLights::send(&senders, samples, sets, (bias, bias_samples));
            ready.indirect = Indirect::VirtualLights(Arc::new(lights));
        }
        (ready, senders.spent.into_inner().unwrap_or_else(PoisonError::into_inner))
    }

    /// Queues a secondary ray, unless it would bring nothing.
    fn queue(&self, point: &Point<'_>, [origin, direction]: [Vec3; 2], path: Path, queues: &mut Queues<Vec<Vec3>>) {
        if path.weight.max_element() > 0.0 && path.weight.is_finite() {
            let path = Path { cone: point.cone(path.kind), ..path };
            queues.next.push(point.leave(origin, direction), path);
        }
    }
}

/// Schlick's approximation of a mirror's reflectance; `color` is what it reflects head-on ([Schlick 1994] "An
/// Inexpensive BRDF Model for Physically-based Rendering", eq. 15).
fn schlick(color: Vec3, cosine: f32) -> Vec3 {
    let rest = 1.0 - cosine;
    let rest2 = rest * rest;
    color + (Vec3::ONE - color) * (rest2 * rest2 * rest)
}
