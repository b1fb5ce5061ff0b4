//! Rendering in waves: the rays of a tile as one batch, hits sorted by material, one texture evaluation per material
//! and wave, secondary rays queued for the next wave, until the queue is empty.
//!
//! Everything that there are many of lies in rows, one number of all rays after the other, from the camera to the
//! lights. Light travels back through *nodes*: every camera sample has one, and a dialect that combines what secondary
//! rays bring in a way that is no plain sum may add more.

use std::ops::Range;

use glam::Vec3;

use crate::clock::{Clock, Stage};
use crate::film::Pixel;
use crate::geometry::{Geometry, Hit, Hits, Id, Met, Ray, Rays, Run, Scratch};
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
    /// None where nothing that follows is random.
    pub keys: Vec<SampleKey>,
    /// Room for those who aim them.
    pub bits: Vec<u32>,
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
    /// Colours, and whether anything was seen, background included: 1 or 0.
    pub pixels: Vec<Pixel>,
    pub seen: Vec<Seen>,
}

/// Everything that shading leaves behind for the rest of the wave and the next one.
#[derive(Debug)]
pub(crate) struct Queues<N> {
    pub next: Paths,
    pub nodes: N,
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

/// The hits of one wave that share a material, moved together.
#[derive(Clone, Copy)]
pub(crate) struct Batch<'a> {
    pub geometry: &'a Geometry,
    pub material: &'a Material,
    /// Rays and hits of the members, one after the other.
    pub met: &'a Met,
    /// Where in the wave they come from, and on which objects they are.
    pub runs: &'a [Run],
    /// Their positions in the wave, one by one.
    pub members: &'a [u32],
    /// Those of the whole wave.
    pub paths: &'a [Path],
    /// By camera sample.
    pub keys: &'a [SampleKey],
    /// How many samples each pixel has.
    pub of: u32,
}

impl Batch<'_> {
    pub fn len(&self) -> usize {
        self.members.len()
    }

    /// The ray of a member.
    #[inline]
    pub fn ray(&self, member: usize) -> Ray {
        self.met.ray(member)
    }

    /// The hit of a member.
    #[inline]
    pub fn hit(&self, member: usize) -> Hit {
        self.met.hits.get(member)
    }

    /// The path of a member.
    #[inline]
    pub fn path(&self, member: usize) -> &Path {
        &self.paths[self.members[member] as usize]
    }
}

/// Where the light of the paths is gathered.
pub(crate) trait Nodes: Default + Send {
    /// Makes one node for each of so many camera samples, which have met nothing yet.
    fn begin(&mut self, samples: usize);
}

/// For those who gather nothing.
impl Nodes for () {
    fn begin(&mut self, _: usize) {}
}

/// Plain sums.
impl Nodes for Vec<Vec3> {
    fn begin(&mut self, samples: usize) {
        self.clear();
        self.resize(samples, Vec3::ZERO);
    }
}

/// What a dialect does with hits, misses and gathered light.
pub(crate) trait Rules: Sync {
    /// Where light is gathered.
    type Nodes: Nodes;
    /// One thread's room for shading, used again and again.
    type Room: Default + Send;
    /// The smallest distance of a hit.
    const T_MIN: f32;
    /// Whether what meets nothing brings light, or leaves its pixel uncovered: if not, nobody asks.
    const OPEN: bool = true;

    /// How many camera samples go together: enough to fill texture batches, few enough that their rays fit the caches.
    fn wave(&self) -> usize {
        1024
    }

    /// Shades a batch: adds light to nodes, queues secondary rays.
    fn shade(&self, batch: &Batch<'_>, room: &mut Self::Room, queues: &mut Queues<Self::Nodes>);

    /// Adds what a ray that met nothing brings, and says whether the camera takes that for a surface.
    fn miss(&self, path: &Path, direction: Vec3, nodes: &mut Self::Nodes) -> bool;

    /// What the camera sees at a hit: the normal.
    fn seen(&self, geometry: &Geometry, rays: &Rays, hits: &Hits, i: usize) -> Vec3;

    /// Writes the light of the camera samples, of which there are as many as pixels, and that they are covered.
    fn resolve(&self, nodes: &mut Self::Nodes, pixels: &mut [Pixel]);
}

/// One thread's room for waves, used again and again.
pub(crate) struct Workspace<R: Rules> {
    current: Paths,
    /// Those of the camera samples, while they wait for the next ones.
    camera: Vec<Path>,
    hits: Hits,
    /// Runs of hits, as they come, and sorted by material: misses last.
    found: Vec<Run>,
    runs: Vec<Run>,
    /// Where the runs of each material start.
    starts: Vec<u32>,
    met: Met,
    members: Vec<u32>,
    /// Camera samples that have seen nothing.
    uncovered: Vec<u32>,
    pub room: R::Room,
    scratch: Scratch,
    pub queues: Queues<R::Nodes>,
    pub results: Results,
}

impl<R: Rules> Default for Workspace<R> {
    fn default() -> Self {
        Workspace {
            current: Paths::default(),
            camera: Vec::new(),
            hits: Hits::default(),
            found: Vec::new(),
            runs: Vec::new(),
            starts: Vec::new(),
            met: Met::default(),
            members: Vec::new(),
            uncovered: Vec::new(),
            room: R::Room::default(),
            scratch: Scratch::default(),
            queues: Queues {
                next: Paths::default(),
                nodes: R::Nodes::default(),
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
            if R::OPEN {
                self.miss(world, rules, first);
            }
            self.shade(world, rules, samples);
            if first {
                // The rows go back to where they came from.
                std::mem::swap(&mut self.current.rays, &mut samples.rays);
                std::mem::swap(&mut self.current.paths, &mut self.camera);
                first = false;
            }
        }
        let pixels = &mut self.results.pixels;
        pixels.resize(samples.rays.len(), [0.0; 4]);
        rules.resolve(&mut self.queues.nodes, pixels);
        self.uncovered.iter().for_each(|&sample| pixels[sample as usize][3] = 0.0);
    }

    /// Queues the camera rays.
    fn start(&mut self, samples: &mut Samples) {
        let count = samples.rays.len();
        let Workspace { queues: Queues { next, nodes, stats, .. }, camera, uncovered, results, .. } = self;
        next.clear();
        std::mem::swap(&mut next.rays, &mut samples.rays);
        let (kind, depth, cone) = (RayKind::Camera, Depth::default(), Cone { width: 0.0, spread: samples.spread });
        let path = Path { weight: Vec3::ONE, node: 0, index: 0, kind, depth, cone };
        if samples.keys.is_empty() {
            // All that there were are what they will be.
            camera.truncate(count);
            camera.extend((camera.len() as u32..count as u32).map(|node| Path { node, ..path }));
        } else {
            camera.clear();
            camera.extend((0..).zip(&samples.keys).map(|(node, key)| Path { node, index: key.index, ..path }));
        }
        std::mem::swap(&mut next.paths, camera);
        nodes.begin(count);
        uncovered.clear();
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

    /// Counting sort of the hits by material.
    fn sort_by_material(&mut self, world: &World) {
        let Workspace { hits, found, runs, starts, .. } = self;
        let count = world.materials.len();
        world.geometry.runs(hits, count as u32, found);
        starts.clear();
        starts.resize(count + 3, 0);
        // Counted two places on, so that placing them leaves every material's start one place on.
        found.iter().for_each(|run| starts[run.material as usize + 2] += 1);
        for material in 1..=count + 1 {
            starts[material + 1] += starts[material];
        }
        runs.clone_from(found);
        for run in found {
            let at = &mut starts[run.material as usize + 1];
            runs[*at as usize] = *run;
            *at += 1;
        }
    }

    /// Notes what the camera sees.
    fn look(&mut self, world: &World, rules: &R) {
        let Workspace { current, hits, results, .. } = self;
        results.seen.extend(hits.id.object.iter().enumerate().map(|(i, &object)| {
            if object == Id::NONE.object {
                return Seen::NOTHING;
            }
            Seen { object, normal: rules.seen(&world.geometry, &current.rays, hits, i) }
        }));
    }

    fn miss(&mut self, world: &World, rules: &R, first: bool) {
        let Workspace { current: Paths { rays, paths }, runs, starts, uncovered, queues, .. } = self;
        for i in runs[starts[world.materials.len()] as usize..].iter().flat_map(Run::range) {
            let path = &paths[i];
            let looks = rays.t_max[i] > 0.0;
            let covered = looks && rules.miss(path, rays.direction.get(i), &mut queues.nodes);
            if first && !covered {
                uncovered.push(path.node);
            }
        }
    }

    fn shade(&mut self, world: &World, rules: &R, samples: &Samples) {
        let Samples { ref keys, of, .. } = *samples;
        let Workspace { current: Paths { rays, paths }, hits, runs, starts, met, members, room, queues, .. } = self;
        for (number, material) in world.materials.iter().enumerate() {
            let runs = &runs[starts[number] as usize..starts[number + 1] as usize];
            if runs.is_empty() {
                continue;
            }
            members.clear();
            runs.iter().for_each(|run| members.extend(run.first..run.first + run.count));
            met.gather(rays, hits, runs, members);
            rules.shade(
                &Batch { geometry: &world.geometry, material, met, runs, members, paths, keys, of },
                room,
                queues,
            );
        }
    }
}
