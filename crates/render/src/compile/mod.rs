//! Scene → [`CompiledScene`]: names resolved, transforms baked, textures loaded, hierarchy built, dialect chosen.
//! Past this point nothing has a name, and nothing is optional.

mod lights;
mod materials;
mod objects;
mod shape;

use std::sync::Arc;

use glam::Vec3;
use jaspe_scene::description::{Camera as CameraDescription, Color, Filter, GiKind, Lens, LightKind, Sampler, View};
use jaspe_scene::{Diagnostic, Diagnostics, Dialect, Loader, Scene};

use crate::camera::Camera;
use crate::environment::Environment;
use crate::filter::Taps;
use crate::geometry::{Geometry, Plan};
use crate::light::Light;
use crate::mesh_file::MeshFile;
use crate::motion::Shutter;
use crate::options::{CompileOptions, RenderOptions};
use crate::report::{Grid, Report, ReportCamera, ReportLight};
use crate::sampler::SampleKey;
use crate::sunflow::{Caustics, Indirect, Sunflow};
use crate::wave::{Samples, Seen, Shots, Workspace, World};
use lights::Lit;
use materials::Pictures;

/// A scene ready to render: immutable and valid.
#[derive(Debug)]
pub struct CompiledScene {
    pub(crate) size: [u32; 2],
    pub(crate) world: World,
    pub(crate) meaning: Meaning,
    pub(crate) sampling: Sampling,
}

/// What depends on the dialect.
#[derive(Debug)]
pub(crate) enum Meaning {
    Sunflow { rules: Sunflow, camera: Camera, shutter: Shutter, filter: Filter, jitter: bool },
    Report { rules: Report },
}

/// How many samples pixels get.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Sampling {
    /// The same number everywhere.
    Fixed { count: u32 },
    /// `4^level × repeats` per pixel, from the least level to the most, where `contrast` asks for it.
    Adaptive { min_level: u32, max_level: u32, repeats: u32, contrast: f32 },
    /// `edge² × repeats` per pixel, placed as the 2010 program did.
    Report { edge: u32, repeats: u32 },
}

/// What [`compile`] made of a scene, with everything it has to say about it.
#[derive(Debug)]
pub struct Compilation {
    /// The scene, unless the diagnostics hold an error.
    pub scene: Option<CompiledScene>,
    /// In the order in which they were found.
    pub diagnostics: Diagnostics,
}

/// The dimension of the time of a sample, out of the way of those of its path.
const TIME: u32 = u32::MAX;
/// Samples per pixel of the sampler `multipass` where the scene names none.
const MULTIPASS: u32 = 16;
/// Sunflow's picture size where the scene names none.
const DEFAULT_SIZE: [u32; 2] = [640, 480];

impl CompiledScene {
    /// Width and height of the picture in pixels.
    pub fn resolution(&self) -> [u32; 2] {
        self.size
    }

    /// All triangles that the scene shows, in the world; texture coordinates are left out.
    pub fn triangles(&self) -> MeshFile {
        self.world.geometry.triangles()
    }

    /// Whose meaning the scene's words were given.
    pub fn dialect(&self) -> Dialect {
        match self.meaning {
            Meaning::Sunflow { .. } => Dialect::Sunflow,
            Meaning::Report { .. } => Dialect::Report,
        }
    }

    /// What pixels take from their neighbours.
    pub(crate) fn taps(&self) -> Taps {
        match (&self.meaning, self.sampling) {
            (Meaning::Report { .. }, _) => Taps::NONE,
            (Meaning::Sunflow { filter, .. }, Sampling::Fixed { count: 1 }) => Taps::over_points(*filter),
            (Meaning::Sunflow { filter, .. }, _) => Taps::over_areas(*filter),
        }
    }

    /// Aims the samples of a wave.
    pub(crate) fn aim(&self, shots: &Shots<'_>, seed: u64, samples: &mut Samples) {
        samples.of = shots.of;
        match &self.meaning {
            &Meaning::Sunflow { ref camera, shutter, jitter, .. } => {
                samples.resize(shots.count());
                samples.spread = camera.spread() / (shots.of as f32).sqrt();
                let moving = self.world.geometry.is_moving();
                samples.rays.time.clear();
                for (i, ([x, y], index)) in shots.iter().enumerate() {
                    let key = SampleKey::among(x, y, [index, shots.of], seed);
                    // A single sample stands for the pixel's centre. Several lie alike in all pixels, so that edges
                    // come out smooth; with `jitter`, every pixel has its own.
                    let [dx, dy] = match (shots.of, jitter) {
                        (1, _) => [0.5; 2],
                        (_, false) => SampleKey::pattern(index),
                        (_, true) => key.pair(0),
                    };
                    let lens = if camera.has_aperture() { key.pair(1) } else { [0.5; 2] };
                    let time = if moving || camera.is_moving() { key.pair(TIME)[0] } else { 0.5 };
                    samples.rays.time.extend(moving.then(|| shutter.moment(f64::from(time)) as f32));
                    let ray = camera.ray(x as f32 + dx, y as f32 + dy, lens, time);
                    samples.set(i, ray, key);
                }
            }
            Meaning::Report { rules } => {
                let grid = match self.sampling {
                    Sampling::Report { edge, repeats } => Grid { edge, repeats },
                    _ => Grid { edge: 1, repeats: shots.of },
                };
                rules.camera.samples(grid, shots, seed, samples);
            }
        }
    }
}

/// Resolves names, bakes transforms, loads textures and builds the hierarchy.
///
/// The scene is compiled as far as it goes, so that all errors come in one run; with any error there is no scene.
pub fn compile(scene: &Scene, loader: &dyn Loader, options: &CompileOptions) -> Compilation {
    let mut diagnostics = Diagnostics::default();
    let dialect = options.dialect.or(scene.dialect.map(|dialect| dialect.value)).unwrap_or_default();
    let mut pictures = Pictures::new(scene, dialect, loader);
    let mut materials = materials::compile(scene, &mut pictures, options.look, &mut diagnostics);
    let lit = match dialect {
        Dialect::Sunflow => lights::compile(scene, &mut pictures, &mut materials, &mut diagnostics),
        Dialect::Report => Lit::default(),
    };
    let mut plan = Plan::default();
    let (lights, surroundings) = lit.show(&mut plan);
    let shutter = Shutter::of(scene.cameras.last());
    let sources = shape::Sources { scene, loader, shutter };
    let planned = objects::compile(&sources, dialect, plan, &mut materials, &mut diagnostics);
    let Some(camera) = scene.cameras.last() else {
        diagnostics.push(Diagnostic::error(None, "the scene has no camera").hint(
            "add one, for instance `camera { type pinhole eye 0 0 10 target 0 0 0 up 0 1 0 fov 60 aspect 1.333 }`",
        ));
        return Compilation { scene: None, diagnostics };
    };
    let scene_size = scene.image.resolution.map_or(DEFAULT_SIZE, |size| size.value);
    let size = options.resolution.unwrap_or(scene_size);
    let meaning = match dialect {
        Dialect::Sunflow => sunflow(scene, camera, size, (lights, surroundings)),
        Dialect::Report => {
            let camera = report_camera(camera, scene_size[0], size, &mut diagnostics);
            report(scene, camera, planned.plane_normals, &planned.geometry, size)
        }
    };
    let sampling = sampling(scene, dialect, options);
    let world = World { geometry: planned.geometry, materials: materials.all };
    let compiled = CompiledScene { size, world, meaning, sampling };
    if compiled.world.geometry.objects.is_empty() && scene.background.is_none() {
        diagnostics.push(Diagnostic::warning(None, "the scene shows nothing: it has no visible object"));
    } else if options.look.is_none() {
        note_darkness(scene, &compiled, &mut diagnostics);
    }
    let scene = (!diagnostics.has_errors()).then_some(compiled);
    Compilation { scene, diagnostics }
}

fn sampling(scene: &Scene, dialect: Dialect, options: &CompileOptions) -> Sampling {
    let aa = options.aa.or(scene.image.aa.map(|aa| aa.value)).unwrap_or([0, 0]);
    let [min, max] = [aa[0].clamp(-4, 5), aa[1].clamp(aa[0].clamp(-4, 5), 5)];
    let repeats = scene.image.samples.map_or(1, |samples| samples.value.clamp(1, 256));
    if let Some(count) = options.samples {
        return Sampling::Fixed { count: count.max(1) };
    }
    let sampler = scene.image.sampler.map_or(Sampler::Bucket, |sampler| sampler.value);
    match (dialect, sampler) {
        (Dialect::Report, _) => Sampling::Report { edge: 1 << max.max(0), repeats },
        (Dialect::Sunflow, Sampler::Fast) => Sampling::Fixed { count: 1 },
        (Dialect::Sunflow, Sampler::Multipass) => Sampling::Fixed {
            count: scene.image.samples.map_or(MULTIPASS, |samples| samples.value.clamp(1, MOST_SAMPLES)),
        },
        (Dialect::Sunflow, Sampler::Bucket) => {
            // Sunflow goes below one sample per pixel; every pixel gets one here.
            let (min_level, max_level) = (min.max(0) as u32, max.max(0) as u32);
            if min_level == max_level {
                return Sampling::Fixed { count: (1 << (2 * min_level)) * repeats };
            }
            let contrast = scene.image.contrast.map_or(0.1, |contrast| contrast.value.clamp(0.0, 1.0));
            Sampling::Adaptive { min_level, max_level, repeats, contrast }
        }
    }
}

fn sunflow(
    scene: &Scene,
    camera: &CameraDescription,
    size: [u32; 2],
    (lights, surroundings): (Vec<Light>, Option<Arc<Environment>>),
) -> Meaning {
    let depth = |written: Option<jaspe_scene::Spanned<u32>>, default: u32| {
        written.map_or(default, |depth| depth.value).min(255) as u8
    };
    let depths = &scene.trace_depths;
    let (indirect, max_diffuse) = indirect(scene, depth(depths.diffuse, 1));
    let rules = Sunflow {
        lights,
        surroundings,
        background: scene.background.as_ref().map(|background| Vec3::from_array(background.color.linear())),
        indirect,
        caustics: scene.caustics.map(|c| Caustics::Wanted {
            emit: c.emit.min(MOST_PHOTONS),
            gather: c.gather,
            radius: c.radius,
        }),
        max_reflection: depth(depths.reflection, 4),
        max_refraction: depth(depths.refraction, 4),
        max_diffuse,
    };
    let multipass = scene.image.sampler.is_some_and(|sampler| sampler.value == Sampler::Multipass);
    let filter = scene.image.filter.map_or(Filter::Box, |filter| filter.value);
    let filter = if multipass { Filter::Bspline } else { filter };
    let jitter = multipass || scene.image.jitter.is_some_and(|jitter| jitter.value);
    let shutter = Shutter::of(Some(camera));
    Meaning::Sunflow { rules, camera: Camera::new(camera, size), shutter, filter, jitter }
}

/// Most samples that one point takes of anything: whatever a scene asks for, memory is bounded.
const MOST_SAMPLES: u32 = 1 << 16;
/// Fewest rays of a point whose light would be kept for its neighbours, if the scene asks for that many.
const LEAST_CACHED: u32 = 16;
/// Most sets of virtual lights.
const MOST_SETS: u32 = 256;
/// Most photons that are sent for caustics.
const MOST_PHOTONS: u32 = 1 << 24;

/// A number of samples within bounds.
fn bounded(samples: u32) -> u32 {
    samples.min(MOST_SAMPLES)
}

/// How indirect light is found, and how often paths bounce for it.
fn indirect(scene: &Scene, depth: u8) -> (Indirect, u8) {
    let Some(gi) = &scene.gi else { return (Indirect::None, depth) };
    let linear = |color: &Color| Vec3::from_array(color.linear());
    match &gi.kind {
        GiKind::Path { samples } => (Indirect::Paths { samples: bounded(*samples) }, depth),
        // Sunflow: without a map there is one bounce (R6), with it there are as many as photons make.
        GiKind::IrradianceCache { samples, global, .. } => {
            // Every pixel takes some, where Sunflow takes them all at a few points.
            let samples = samples.div_ceil(16).max((*samples).min(LEAST_CACHED));
            (Indirect::Paths { samples: bounded(samples) }, if global.is_some() { depth } else { depth.min(1) })
        }
        &GiKind::Instant { samples, sets, bias, bias_samples } => {
            let (samples, bias_samples) = (bounded(samples), bounded(bias_samples));
            (Indirect::Instant { samples, sets: sets.min(MOST_SETS), bias, bias_samples }, depth)
        }
        GiKind::AmbientOcclusion { bright, dark, samples, max_distance } => {
            let (dark, bright) = (linear(dark), linear(bright));
            (Indirect::Occlusion { dark, bright, samples: bounded(*samples), distance: *max_distance }, depth)
        }
        GiKind::Fake { up, sky, ground } => {
            let up = Vec3::from_array(*up).normalize_or(Vec3::Y);
            (Indirect::Slope { up, sky: linear(sky), ground: linear(ground) }, depth)
        }
    }
}

/// The original's camera: pinhole whatever the lens, by `eye`, `target` and `up`.
fn report_camera(
    camera: &CameraDescription,
    scene_width: u32,
    size: [u32; 2],
    diagnostics: &mut Diagnostics,
) -> ReportCamera {
    let fov = match camera.lens {
        Lens::Pinhole { fov, .. } | Lens::Thinlens { fov, .. } => fov,
        Lens::Spherical | Lens::Fisheye => {
            diagnostics.push(
                Diagnostic::error(camera.span, "this lens does not exist in the dialect `report`")
                    .hint("use `type pinhole`, or render with `--dialect sunflow`"),
            );
            90.0
        }
    };
    let view = match &camera.view {
        View::LookAt { eye, target, up } => [*eye, *target, *up].map(Vec3::from_array),
        View::Transform(transform) => {
            let matrix: crate::affine::Affine = crate::affine::matrix(&transform.kind).into();
            let eye = matrix.point(Vec3::ZERO);
            [eye, eye + matrix.vector(Vec3::NEG_Z), matrix.vector(Vec3::Y)]
        }
    };
    ReportCamera::new(view, fov, scene_width, size)
}

fn report(
    scene: &Scene,
    camera: ReportCamera,
    plane_normals: Vec<Vec3>,
    geometry: &Geometry,
    size: [u32; 2],
) -> Meaning {
    let lights = scene.lights.iter().filter_map(|light| match &light.kind {
        LightKind::Point { color, power, position } => Some(ReportLight {
            position: Vec3::from_array(*position),
            color: Vec3::from_array(color.raw()),
            range: *power,
        }),
        // The original skips every other light.
        _ => None,
    });
    let mut rules = Report { camera, lights: lights.collect(), plane_normals, plane_axes: Vec::new() };
    rules.fix_plane_axes(geometry, size);
    Meaning::Report { rules }
}

/// Width and height of the probe that looks for darkness.
const PROBE: [u32; 2] = [32, 24];
/// Display value (of 1) below which a lit surface counts as nearly black.
const DARK: f64 = 0.22;

/// Notes that a scene meant for the 2010 program is nearly black in Sunflow's meaning: its `power` is a range there.
fn note_darkness(scene: &Scene, compiled: &CompiledScene, diagnostics: &mut Diagnostics) {
    let Meaning::Sunflow { rules, camera, .. } = &compiled.meaning else { return };
    let Some(light) = scene.lights.iter().find(|light| matches!(light.kind, LightKind::Point { .. })) else { return };
    if rules.lights.is_empty() || diagnostics.has_errors() {
        return;
    }
    let mut samples = Samples::default();
    samples.resize((PROBE[0] * PROBE[1]) as usize);
    for i in 0..PROBE[0] * PROBE[1] {
        let at = |k: usize, cell: u32| (cell as f32 + 0.5) / PROBE[k] as f32 * compiled.size[k] as f32;
        let ray = camera.ray(at(0, i % PROBE[0]), at(1, i / PROBE[0]), [0.5; 2], 0.5);
        samples.set(i as usize, ray, SampleKey::new(i, 0, 0, RenderOptions::default().seed));
    }
    let mut workspace = Workspace::default();
    workspace.trace(&compiled.world, rules, &mut samples, true);
    let results = &workspace.results;
    let seen = results.seen.iter().map(|seen| seen.object != Seen::NOTHING.object);
    let mut lit: Vec<f32> =
        results.pixels.iter().zip(seen).filter(|&(_, seen)| seen).map(|([r, g, b, _], _)| r.max(*g).max(*b)).collect();
    lit.sort_by(f32::total_cmp);
    // The brightest twentieth of what is seen decides.
    let Some(bright) = lit.get(lit.len() * 19 / 20) else { return };
    if jaspe_scene::srgb_encode(f64::from(*bright)) < DARK {
        diagnostics.push(
            Diagnostic::note(light.span, "the lights are so weak that the picture will be nearly black")
                .hint("`power` is radiant power here, and light falls off with the square of the distance")
                .hint("for a scene made for the 2010 program, render with `--dialect report`, or put the line `dialect report` first"),
        );
    }
}
