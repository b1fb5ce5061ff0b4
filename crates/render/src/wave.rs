//! Rendering in waves: the rays of a tile as one batch, hits sorted by material, one texture evaluation per material
//! and wave, secondary rays queued for the next wave, until the queue is empty.
//!
//! Everything that there are many of lies in rows, one number of all rays after the other, from the camera to the
//! lights. Light travels back through *nodes*: every camera sample has one, and a dialect that combines what secondary
//! rays bring in a way that is no plain sum may add more.

use std::ops::Range;

use glam::Vec3;

use crate::clock::{Clock, Stage};
use crate::geometry::{Geometry, Hit, Hits, Id, Ray, Rays, Scratch};
use crate::material::Material;
use crate::options::Stats;
use crate::sampler::SampleKey;

/// How a ray came to be; decides what it sees and how it counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum RayKind {
    Camera,
    Reflection,
    /// A ray into a glossy lobe: sees neither mirrors nor glass behind it.
    Glossy,
    Refraction,
    /// A ray that looks for light from other matte surfaces; sees what a glossy one sees.
    Gather,
}

/// How often a path has bounced.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Depth {
    pub diffuse: u8,
    pub reflection: u8,
    pub refraction: u8,
}

impl Depth {
    pub fn total(self) -> u32 {
        u32::from(self.diffuse) + u32::from(self.reflection) + u32::from(self.refraction)
    }

    pub fn reflected(self) -> Depth {
        Depth { reflection: self.reflection.saturating_add(1), ..self }
    }

    pub fn diffused(self) -> Depth {
        Depth { diffuse: self.diffuse.saturating_add(1), ..self }
    }

    pub fn refracted(self) -> Depth {
        Depth { refraction: self.refraction.saturating_add(1), ..self }
    }
}

/// The cone around a ray for which it stands ([Amanatides 1984] "Ray Tracing with Cones").
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Cone {
    /// Where the ray begins.
    pub width: f32,
    /// By how much the width grows per unit of length.
    pub spread: f32,
}

impl Cone {
    /// What becomes of it on the way.
    pub fn after(self, length: f32) -> Cone {
        Cone { width: self.width + self.spread * length, ..self }
    }
}

/// What a ray is, beside where it goes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Path {
    /// What its light counts.
    pub weight: Vec3,
    /// The node that gathers its light.
    pub node: u32,
    /// Index of the path in its pixel's sequence: see [`SampleKey::nth`].
    pub index: u32,
    pub kind: RayKind,
    pub depth: Depth,
    pub cone: Cone,
}

/// Rays that look for surfaces.
#[derive(Debug, Default)]
pub(crate) struct Paths {
    pub rays: Rays,
    pub paths: Vec<Path>,
}

impl Paths {
    pub fn push(&mut self, ray: Ray, path: Path) {
        self.rays.push(ray);
        self.paths.push(path);
    }

    fn clear(&mut self) {
        self.rays.clear();
        self.paths.clear();
    }
}

/// Which camera samples a wave takes: the same ones of several pixels, pixel by pixel.
#[derive(Debug, Clone)]
pub(crate) struct Shots<'a> {
    /// Column and row.
    pub pixels: &'a [[u32; 2]],
    pub indices: Range<u32>,
    /// How many samples these pixels have once the pass is over.
    pub of: u32,
}

impl Shots<'_> {
    /// Pixel and index of every sample.
    pub fn iter(&self) -> impl Iterator<Item = ([u32; 2], u32)> {
        self.pixels.iter().flat_map(|&pixel| self.indices.clone().map(move |index| (pixel, index)))
    }

    pub fn count(&self) -> usize {
        self.pixels.len() * self.indices.len()
    }
}

/// Camera samples that are to be traced.
#[derive(Debug, Default)]
pub(crate) struct Samples {
    /// Rays that end before they begin where the lens sees nothing.
    pub rays: Rays,
    pub keys: Vec<SampleKey>,
    /// How many each pixel has once all are traced.
    pub of: u32,
    /// That of each sample's cone.
    pub spread: f32,
}

impl Samples {
    /// Room for exactly `count` samples, for those who write them one by one.
    pub fn resize(&mut self, count: usize) {
        // Camera rays skip nothing, so what is left of the last wave will do.
        self.rays.resize(count);
        self.keys.resize(count, SampleKey { pixel: 0, index: 0 });
    }

    /// Writes sample `i`; a ray of `None` sees nothing.
    pub fn set(&mut self, i: usize, ray: Option<(Vec3, Vec3)>, key: SampleKey) {
        let (origin, direction) = ray.unwrap_or((Vec3::ZERO, Vec3::Z));
        self.rays.origin.set(i, origin);
        self.rays.direction.set(i, direction);
        self.rays.t_max[i] = if ray.is_some() { f32::INFINITY } else { -1.0 };
        self.keys[i] = key;
    }
}

/// What the camera sees at one sample, for deciding where more samples are needed.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Seen {
    pub object: u32,
    pub normal: Vec3,
}

impl Seen {
    pub const NOTHING: Seen = Seen { object: Id::NONE.object, normal: Vec3::ZERO };
}

/// What comes of the camera samples.
#[derive(Debug, Default)]
pub(crate) struct Results {
    pub colors: Vec<Vec3>,
    /// Whether anything was seen, background included.
    pub covered: Vec<bool>,
    pub seen: Vec<Seen>,
}

/// Everything that shading leaves behind for the rest of the wave and the next one.
#[derive(Debug)]
pub(crate) struct Queues<N> {
    pub next: Paths,
    pub nodes: Vec<N>,
    pub stats: Stats,
    /// Whoever goes on to another stage ends the lap of the last one.
    pub clock: Clock,
}

/// What rays meet.
#[derive(Debug)]
pub(crate) struct World {
    pub geometry: Geometry,
    /// By the indices that the geometry's objects carry.
    pub materials: Vec<Material>,
}

/// The hits of one wave that share a material.
#[derive(Clone, Copy)]
pub(crate) struct Batch<'a> {
    pub geometry: &'a Geometry,
    pub material: &'a Material,
    /// Positions in `rays`, `paths` and `hits`.
    pub members: &'a [u32],
    pub rays: &'a Rays,
    pub paths: &'a [Path],
    pub hits: &'a Hits,
    /// By camera sample.
    pub keys: &'a [SampleKey],
    /// How many samples each pixel has.
    pub of: u32,
}

impl Batch<'_> {
    /// The ray of a member.
    #[inline]
    pub fn ray(&self, member: usize) -> Ray {
        self.rays.get(self.members[member] as usize)
    }

    /// The hit of a member.
    #[inline]
    pub fn hit(&self, member: usize) -> Hit {
        self.hits.get(self.members[member] as usize)
    }

    /// The path of a member.
    #[inline]
    pub fn path(&self, member: usize) -> &Path {
        &self.paths[self.members[member] as usize]
    }
}

/// What a dialect does with hits, misses and gathered light.
pub(crate) trait Rules: Sync {
    /// Where light is gathered; the default is that of a camera sample that has met nothing yet.
    type Node: Copy + Default;
    /// One thread's room for shading, used again and again.
    type Room: Default;
    /// The smallest distance of a hit.
    const T_MIN: f32;

    /// How many camera samples go together: enough to fill texture batches, few enough that their rays fit the caches.
    fn wave(&self) -> usize {
        1024
    }

    /// Shades a batch: adds light to nodes, queues secondary rays.
    fn shade(&self, batch: &Batch<'_>, room: &mut Self::Room, queues: &mut Queues<Self::Node>);

    /// Adds what a ray that met nothing brings, and says whether the camera takes that for a surface.
    fn miss(&self, path: &Path, direction: Vec3, node: &mut Self::Node) -> bool;

    /// What the camera sees at a hit: the normal.
    fn seen(&self, geometry: &Geometry, rays: &Rays, hits: &Hits, i: usize) -> Vec3;

    /// The light of the first `samples` nodes.
    fn resolve(&self, nodes: &mut [Self::Node], samples: usize, colors: &mut Vec<Vec3>);
}

/// One thread's room for waves, used again and again.
pub(crate) struct Workspace<R: Rules> {
    current: Paths,
    hits: Hits,
    /// Positions of hits, sorted by material, and where each material starts.
    sorted: Vec<u32>,
    starts: Vec<u32>,
    materials: Vec<u32>,
    /// Positions of rays that met nothing.
    misses: Vec<u32>,
    pub room: R::Room,
    scratch: Scratch,
    pub queues: Queues<R::Node>,
    pub results: Results,
}

impl<R: Rules> Default for Workspace<R> {
    fn default() -> Self {
        Workspace {
            current: Paths::default(),
            hits: Hits::default(),
            sorted: Vec::new(),
            starts: Vec::new(),
            materials: Vec::new(),
            misses: Vec::new(),
            room: R::Room::default(),
            scratch: Scratch::default(),
            queues: Queues {
                next: Paths::default(),
                nodes: Vec::new(),
                stats: Stats::default(),
                clock: Clock::start(),
            },
            results: Results::default(),
        }
    }
}

impl<R: Rules> Workspace<R> {
    /// Begins to count and to time anew.
    pub fn begin(&mut self) {
        (self.queues.stats, self.queues.clock) = (Stats::default(), Clock::start());
    }

    /// What was done since the beginning.
    pub fn end(&mut self) -> Stats {
        let Queues { clock, stats, .. } = &mut self.queues;
        clock.lap(Stage::Shade);
        Stats { spent: clock.spent, ..*stats }
    }

    /// Traces camera samples to their end; `results` gets one entry each, in order. What is seen is noted only if the
    /// caller `looks`.
    pub fn trace(&mut self, world: &World, rules: &R, samples: &mut Samples, looks: bool) {
        self.start(samples);
        let mut first = true;
        while !self.queues.next.rays.is_empty() {
            std::mem::swap(&mut self.current, &mut self.queues.next);
            self.queues.next.clear();
            self.count_rays();
            self.queues.clock.lap(Stage::Shade);
            world.geometry.closest(self.current.rays.view(R::T_MIN), &mut self.hits, &mut self.scratch);
            self.queues.clock.lap(Stage::Trace);
            self.sort_by_material(world);
            if first && looks {
                self.look(world, rules);
            }
            self.miss(rules, first);
            self.shade(world, rules, samples);
            if first {
                // The rows go back to where they came from.
                std::mem::swap(&mut self.current.rays, &mut samples.rays);
                first = false;
            }
        }
        rules.resolve(&mut self.queues.nodes, samples.keys.len(), &mut self.results.colors);
    }

    /// Queues the camera rays.
    fn start(&mut self, samples: &mut Samples) {
        let count = samples.keys.len();
        let Workspace { queues: Queues { next, nodes, stats, .. }, results, .. } = self;
        next.clear();
        std::mem::swap(&mut next.rays, &mut samples.rays);
        let (kind, depth, cone) = (RayKind::Camera, Depth::default(), Cone { width: 0.0, spread: samples.spread });
        let path = Path { weight: Vec3::ONE, node: 0, index: 0, kind, depth, cone };
        next.paths.extend((0..).zip(&samples.keys).map(|(node, key)| Path { node, index: key.index, ..path }));
        nodes.clear();
        nodes.resize(count, R::Node::default());
        results.covered.clear();
        results.covered.resize(count, true);
        results.seen.clear();
        stats.samples += count as u64;
    }

    fn count_rays(&mut self) {
        let stats = &mut self.queues.stats;
        let paths = &self.current.paths;
        if let [Path { kind: RayKind::Camera, .. }, ..] = paths[..] {
            stats.camera_rays += paths.len() as u64;
            return;
        }
        for path in paths {
            match path.kind {
                RayKind::Camera => stats.camera_rays += 1,
                RayKind::Reflection | RayKind::Glossy => stats.reflection_rays += 1,
                RayKind::Refraction => stats.refraction_rays += 1,
                RayKind::Gather => stats.gather_rays += 1,
            }
        }
    }

    /// Counting sort of the hits by material; misses are set apart.
    fn sort_by_material(&mut self, world: &World) {
        let Workspace { hits, sorted, starts, materials, misses, .. } = self;
        let count = world.materials.len();
        starts.clear();
        starts.resize(count + 2, 0);
        misses.clear();
        world.geometry.materials(hits, count as u32, materials);
        // Counted two places on, so that placing them leaves every material's start one place on.
        for &material in &*materials {
            if let Some(start) = starts.get_mut(material as usize + 2) {
                *start += 1;
            }
        }
        for material in 1..=count {
            starts[material + 1] += starts[material];
        }
        sorted.resize(starts[count + 1] as usize, 0);
        for (&material, i) in materials.iter().zip(0..) {
            if material as usize == count {
                misses.push(i);
                continue;
            }
            let at = &mut starts[material as usize + 1];
            sorted[*at as usize] = i;
            *at += 1;
        }
    }

    /// Notes what the camera sees.
    fn look(&mut self, world: &World, rules: &R) {
        let Workspace { current, hits, materials, results, .. } = self;
        let miss = world.materials.len() as u32;
        results.seen.extend(materials.iter().enumerate().map(|(i, &material)| {
            if material == miss {
                return Seen::NOTHING;
            }
            let normal = rules.seen(&world.geometry, &current.rays, hits, i);
            Seen { object: hits.id.object[i], normal }
        }));
    }

    fn miss(&mut self, rules: &R, first: bool) {
        let Workspace { current: Paths { rays, paths }, misses, queues, results, .. } = self;
        for &i in &*misses {
            let (i, path) = (i as usize, &paths[i as usize]);
            let looks = rays.t_max[i] > 0.0;
            let node = path.node as usize;
            let covered = looks && rules.miss(path, rays.direction.get(i), &mut queues.nodes[node]);
            if first {
                results.covered[node] = covered;
            }
        }
    }

    fn shade(&mut self, world: &World, rules: &R, samples: &Samples) {
        let Samples { ref keys, of, .. } = *samples;
        let Workspace { current: Paths { rays, paths }, hits, sorted, starts, room, queues, .. } = self;
        let mut from = 0;
        for (material, &end) in world.materials.iter().zip(&starts[1..]) {
            let members = &sorted[from..end as usize];
            from = end as usize;
            if !members.is_empty() {
                rules.shade(
                    &Batch { geometry: &world.geometry, material, members, rays, paths, hits, keys, of },
                    room,
                    queues,
                );
            }
        }
    }
}
