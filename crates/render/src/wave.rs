//! Rendering in waves: the rays of a tile as one batch, hits sorted by material, one texture evaluation per material
//! and wave, shadow and secondary rays queued for the next wave, until the queues are empty.
//!
//! Light travels back through *nodes*. Every camera sample has one; where a dialect combines what its secondary rays
//! bring in a way that is not a plain sum, every ray has one, with a parent. Nodes are resolved last to first, which
//! visits children before their parents.

use glam::Vec3;

use crate::geometry::{Geometry, Hit, Id, Ray, Scratch};
use crate::material::{Material, TextureBatch};
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

    pub fn refracted(self) -> Depth {
        Depth { refraction: self.refraction.saturating_add(1), ..self }
    }
}

/// A ray that looks for a surface, and what its light counts where.
#[derive(Debug, Clone, Copy)]
pub(crate) struct PathRay {
    pub ray: Ray,
    pub weight: Vec3,
    pub node: u32,
    pub key: SampleKey,
    pub kind: RayKind,
    pub depth: Depth,
}

/// A ray towards a light, and what arrives if nothing is in the way.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ShadowRay {
    pub ray: Ray,
    pub contribution: Vec3,
    pub node: u32,
}

impl AsRef<Ray> for PathRay {
    fn as_ref(&self) -> &Ray {
        &self.ray
    }
}

impl AsRef<Ray> for ShadowRay {
    fn as_ref(&self) -> &Ray {
        &self.ray
    }
}

/// Where light is gathered.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    /// Light from lights, and from surfaces that shine.
    pub direct: Vec3,
    /// Light from child nodes, weighted.
    pub indirect: Vec3,
    /// The node that gets this one's light, and how much of it; itself for roots.
    pub parent: u32,
    pub weight: f32,
    /// What the sum is multiplied by; zero where the ray met nothing.
    pub gain: f32,
}

impl Node {
    /// The node of camera sample `index`.
    fn root(index: u32) -> Node {
        Node { direct: Vec3::ZERO, indirect: Vec3::ZERO, parent: index, weight: 1.0, gain: 0.0 }
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

/// Which sample of which pixel; `slot` is the pixel's place in its tile.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Target {
    pub pixel: [u32; 2],
    pub slot: u32,
    pub index: u32,
}

/// A camera sample that is to be traced.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CameraSample {
    pub origin: Vec3,
    /// Of unit length; zero where the lens sees nothing.
    pub direction: Vec3,
    pub key: SampleKey,
    /// What it counts in its pixel.
    pub weight: f32,
}

/// What comes of a camera sample.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SampleResult {
    pub color: Vec3,
    /// 1 where anything was seen, background included.
    pub coverage: f32,
    pub seen: Seen,
}

/// Everything that shading leaves behind for the rest of the wave and the next one.
#[derive(Debug, Default)]
pub(crate) struct Queues {
    pub rays: Vec<PathRay>,
    pub shadows: Vec<ShadowRay>,
    pub nodes: Vec<Node>,
    pub seen: Vec<Seen>,
    pub stats: Stats,
}

/// What rays meet.
#[derive(Debug)]
pub(crate) struct World {
    pub geometry: Geometry,
    /// By the indices that the geometry's objects carry.
    pub materials: Vec<Material>,
}

/// The hits of one wave that share a material.
pub(crate) struct Batch<'a> {
    pub geometry: &'a Geometry,
    pub material: &'a Material,
    /// Positions in `rays` and `hits`.
    pub members: &'a [u32],
    pub rays: &'a [PathRay],
    pub hits: &'a [Hit],
}

impl<'a> Batch<'a> {
    /// The batch in pieces of up to `size` members.
    pub fn chunks(&self, size: usize) -> impl Iterator<Item = Batch<'a>> + use<'a> {
        let Batch { geometry, material, members, rays, hits } = *self;
        members.chunks(size).map(move |members| Batch { geometry, material, members, rays, hits })
    }

    /// The members with their rays and hits.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = (&'a PathRay, &'a Hit)> + use<'a> {
        let (rays, hits) = (self.rays, self.hits);
        self.members.iter().map(move |&i| (&rays[i as usize], &hits[i as usize]))
    }

    /// The ray of a member.
    pub fn ray(&self, member: usize) -> &'a Ray {
        &self.rays[self.members[member] as usize].ray
    }
}

/// What a dialect does with hits, misses and gathered light.
pub(crate) trait Rules: Sync {
    /// Shades a batch: adds light to nodes, queues shadow and secondary rays.
    fn shade(&self, batch: &Batch<'_>, textures: &mut TextureBatch, colors: &mut Vec<Vec3>, queues: &mut Queues);

    /// Light along a ray that met nothing, and whether the camera takes it for a surface.
    fn miss(&self, ray: &PathRay) -> Option<Vec3>;

    /// The light of a node whose children are complete.
    fn finish(&self, node: &Node) -> Vec3;

    /// The smallest distance of a hit.
    fn t_min(&self) -> f32;
}

/// One thread's room for waves, used again and again.
#[derive(Default)]
pub(crate) struct Workspace {
    rays: Vec<PathRay>,
    hits: Vec<Hit>,
    blocked: Vec<bool>,
    /// Positions of hits, sorted by material, and where each material starts.
    sorted: Vec<u32>,
    starts: Vec<u32>,
    next: Vec<u32>,
    materials: Vec<u32>,
    textures: TextureBatch,
    colors: Vec<Vec3>,
    /// What the camera samples are covered by.
    coverage: Vec<f32>,
    scratch: Scratch,
    pub queues: Queues,
}

/// Marks a miss among the materials of a wave.
const MISS: u32 = u32::MAX;

impl Workspace {
    /// Traces camera samples to their end; `results` gets one entry each, in order.
    pub fn trace<R: Rules>(
        &mut self,
        world: &World,
        rules: &R,
        samples: &[CameraSample],
        results: &mut Vec<SampleResult>,
    ) {
        self.start(rules, samples);
        let mut first = true;
        while !self.queues.rays.is_empty() {
            std::mem::swap(&mut self.rays, &mut self.queues.rays);
            self.queues.rays.clear();
            self.count_rays();
            world.geometry.closest(&self.rays, &mut self.hits, &mut self.scratch);
            self.sort_by_material(world);
            for (i, ray) in self.rays.iter().enumerate() {
                if self.materials[i] != MISS {
                    if first {
                        self.coverage[ray.node as usize] = 1.0;
                    }
                } else if ray.ray.t_max > 0.0
                    && let Some(light) = rules.miss(ray)
                {
                    self.queues.nodes[ray.node as usize].direct += ray.weight * light;
                    if first {
                        self.coverage[ray.node as usize] = 1.0;
                    }
                }
            }
            self.shade(world, rules);
            self.light(world);
            first = false;
        }
        self.resolve(rules, results);
    }

    /// Queues the camera rays.
    fn start<R: Rules>(&mut self, rules: &R, samples: &[CameraSample]) {
        self.coverage.clear();
        self.coverage.resize(samples.len(), 0.0);
        let queues = &mut self.queues;
        queues.rays.clear();
        queues.shadows.clear();
        queues.nodes.clear();
        queues.nodes.extend((0..samples.len() as u32).map(Node::root));
        queues.seen.clear();
        queues.seen.resize(samples.len(), Seen::NOTHING);
        queues.stats.samples += samples.len() as u64;
        let t_min = rules.t_min();
        queues.rays.extend(samples.iter().zip(0..).map(|(sample, node)| {
            let CameraSample { origin, direction, key, .. } = *sample;
            // No direction: a ray that ends before it begins.
            let t_max = if direction == Vec3::ZERO { -1.0 } else { f32::INFINITY };
            let ray = Ray { origin, direction, t_min, t_max, skip: Id::NONE };
            PathRay { ray, weight: Vec3::ONE, node, key, kind: RayKind::Camera, depth: Depth::default() }
        }));
    }

    fn count_rays(&mut self) {
        let stats = &mut self.queues.stats;
        for ray in &self.rays {
            match ray.kind {
                RayKind::Camera => stats.camera_rays += 1,
                RayKind::Reflection | RayKind::Glossy => stats.reflection_rays += 1,
                RayKind::Refraction => stats.refraction_rays += 1,
            }
        }
    }

    /// Counting sort of the hits by material; misses are left out.
    fn sort_by_material(&mut self, world: &World) {
        let count = world.materials.len();
        self.starts.clear();
        self.starts.resize(count + 1, 0);
        self.materials.clear();
        for hit in &self.hits {
            let material = if hit.id == Id::NONE { MISS } else { world.geometry.material(hit) };
            self.materials.push(material);
            if material != MISS {
                self.starts[material as usize + 1] += 1;
            }
        }
        for material in 0..count {
            self.starts[material + 1] += self.starts[material];
        }
        self.next.clone_from(&self.starts);
        self.sorted.clear();
        self.sorted.resize(self.starts[count] as usize, 0);
        for (i, &material) in self.materials.iter().enumerate() {
            if material != MISS {
                let at = &mut self.next[material as usize];
                self.sorted[*at as usize] = i as u32;
                *at += 1;
            }
        }
    }

    fn shade<R: Rules>(&mut self, world: &World, rules: &R) {
        for (index, material) in world.materials.iter().enumerate() {
            let range = self.starts[index] as usize..self.starts[index + 1] as usize;
            if range.is_empty() {
                continue;
            }
            let members = &self.sorted[range];
            let (geometry, rays, hits) = (&world.geometry, &self.rays, &self.hits);
            let batch = Batch { geometry, material, members, rays, hits };
            self.colors.clear();
            rules.shade(&batch, &mut self.textures, &mut self.colors, &mut self.queues);
        }
    }

    /// Traces the shadow rays and hands out what arrives.
    fn light(&mut self, world: &World) {
        let queues = &mut self.queues;
        queues.stats.shadow_rays += queues.shadows.len() as u64;
        world.geometry.occluded(&queues.shadows, &mut self.blocked, &mut self.scratch);
        for (shadow, &blocked) in queues.shadows.iter().zip(&self.blocked) {
            if !blocked {
                queues.nodes[shadow.node as usize].direct += shadow.contribution;
            }
        }
        queues.shadows.clear();
    }

    /// Hands light from children to parents, and from roots to the results.
    fn resolve<R: Rules>(&mut self, rules: &R, results: &mut Vec<SampleResult>) {
        let (nodes, coverage) = (&mut self.queues.nodes, &self.coverage);
        for i in (coverage.len()..nodes.len()).rev() {
            let node = nodes[i];
            nodes[node.parent as usize].indirect += node.weight * rules.finish(&node);
        }
        results.clear();
        results.extend((0..coverage.len()).map(|i| SampleResult {
            color: rules.finish(&nodes[i]),
            coverage: coverage[i],
            seen: self.queues.seen[i],
        }));
    }
}
