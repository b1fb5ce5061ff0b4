//! `jaspe bench rays`.

mod embree;
mod mesh;
mod set;

use std::hint::black_box;
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use jaspe_noise::simd;
use jaspe_render::{Answers, Hierarchy, MeshFile, RaySet};

use super::stopwatch::median;
use crate::Outcome;
use crate::failure::Failure;
use embree::{Embree, Mode, Packets, Query, Scene};
use set::RayKind;

/// Print how many million rays per second the kernel traces on one thread, next to Embree.
///
/// Both trace the same rays through the same triangles and find the closest hit with its weights, or for ambient
/// occlusion and shadows whether there is any. Embree has its turn in the mode that is its fastest for each kind of ray
/// (single rays or packets, with and without the hint that they are coherent). Then come the time to build the
/// hierarchy, on all threads, and the memory of mesh and hierarchy together.
///
/// Embree is used where its shared library is: version 3 or 4, as libembree4-4 or libembree3-3 of Debian and Ubuntu,
/// or the releases of embree.org hold it.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe bench rays
  jaspe bench rays bunny.obj castle.sc
  jaspe bench rays --embree embree-4.4.0/lib/libembree4.so.4")]
pub struct Rays {
    /// Meshes or scenes, in place of those that are made here: two balls with bumps and a terrain
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,

    /// Embree's shared library, where the system does not find it by itself
    #[arg(long, value_name = "LIBRARY", env = "JASPE_EMBREE")]
    embree: Option<PathBuf>,

    /// How often each traces each batch of rays; the medians count
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u32).range(1..=1000))]
    runs: u32,
}

impl Rays {
    /// Measures, and prints a table for each mesh.
    pub fn run(self) -> Result<Outcome, Failure> {
        // What holds us to fewer instructions than there are holds the other alike.
        let held = Some(simd::level()).filter(|&level| level < simd::machine_level());
        let embree = Embree::load(self.embree.as_deref(), held).map_err(|why| {
            let named = self.embree.as_deref().unwrap_or(std::path::Path::new("")).display().to_string();
            Failure::new(format!("`{named}` cannot be used as Embree: {why}"))
                .hint("name the shared library of Embree 3 or 4 itself, such as libembree4.so.4")
        })?;
        let mut out = io::stdout().lock();
        writeln!(out, "million rays per second, one thread, {}", simd::level().name())?;
        if self.files.is_empty() {
            for subject in [mesh::blob, mesh::fine_blob, mesh::terrain] {
                self.table(&mut out, &subject(), embree.as_ref())?;
            }
        }
        for file in &self.files {
            self.table(&mut out, &mesh::read(file)?, embree.as_ref())?;
        }
        if embree.is_none() {
            eprintln!("for ratios to Embree, name its library: jaspe bench rays --embree libembree4.so.4");
        }
        Ok(Outcome::Done)
    }

    fn table(&self, out: &mut impl Write, subject: &mesh::Subject, embree: Option<&Embree>) -> Result<(), Failure> {
        let mesh::Subject { name, mesh } = subject;
        writeln!(out, "\n{name}, {} triangles", mesh.triangles.len())?;
        write!(out, "{:20}{:>9}", "", "jaspe")?;
        if let Some(embree) = embree {
            write!(out, "{:>15}   ratio", embree.version)?;
        }
        writeln!(out)?;
        let built = self.build(mesh, embree);
        // Of a mesh that the camera sees from the edge there are no others than its own rays.
        for kind in set::kinds(mesh, &built.hierarchy).iter().filter(|kind| !kind.batches.is_empty()) {
            write!(out, "{:20}", kind.name)?;
            let race = self.race(kind, &built);
            write!(out, "{:9.2}", race.rate)?;
            if let Some(Peer { rate, mode, agree }) = race.peer {
                write!(out, "{rate:15.2}{:8.2}", race.rate / rate)?;
                write!(out, "   {}, {:.3} % the same", mode.name(), agree * 100.0)?;
            }
            writeln!(out)?;
            out.flush()?;
        }
        write!(out, "{:20}{:9.1}", "build, ms", built.seconds * 1e3)?;
        if let Some(peer) = &built.peer {
            write!(out, "{:15.1}{:8.2}", peer.seconds * 1e3, built.ratio)?;
        }
        let megabytes = |bytes: f64| bytes * 1e-6;
        let bytes = built.hierarchy.bytes() as f64;
        write!(out, "\n{:20}{:9.1}", "memory, MB", megabytes(bytes))?;
        if let Some(peer) = &built.peer {
            write!(out, "{:15.1}{:8.2}", megabytes(peer.bytes), bytes / peer.bytes)?;
        }
        writeln!(out)?;
        Ok(())
    }

    /// Builds in turn, and keeps the last of each.
    fn build<'a>(&self, mesh: &MeshFile, embree: Option<&'a Embree>) -> Built<'a> {
        let before = embree.map_or(0, Embree::held_bytes);
        let geometry = embree.map(|embree| (embree, embree.geometry(mesh)));
        let (mut times, mut peer_times, mut ratios) = (Vec::new(), Vec::new(), Vec::new());
        let (mut hierarchy, mut scene) = (None, None);
        for _ in 0..self.runs {
            hierarchy = None;
            scene = None;
            let copy = mesh.clone();
            let ours = timed(|| hierarchy = Some(Hierarchy::new(copy)));
            times.push(ours);
            if let Some((embree, geometry)) = &geometry {
                let theirs = timed(|| scene = Some(embree.build(geometry)));
                peer_times.push(theirs);
                ratios.push(ours / theirs);
            }
        }
        let peer = scene.zip(embree).map(|(scene, embree)| Opponent {
            bytes: (embree.held_bytes() - before) as f64,
            seconds: median(peer_times),
            scene,
        });
        let hierarchy = hierarchy.expect("there is at least one run");
        Built { hierarchy, seconds: median(times), ratio: median(ratios), peer }
    }

    /// Traces rays of one kind, batch by batch in turn.
    fn race(&self, kind: &RayKind, built: &Built<'_>) -> Race {
        let mut answers = Answers::default();
        // Both trace rays that have just been written, as those of a renderer have.
        let mut ours = |batch: usize| {
            let rays = black_box(kind.batches[batch].clone());
            timed(|| match kind.query {
                Query::Closest => built.hierarchy.closest(&rays, &mut answers),
                Query::Any => built.hierarchy.occluded(&rays, &mut answers),
            })
        };
        let count = kind.batches.iter().map(RaySet::len).sum::<usize>();
        let rate = |seconds: f64| count as f64 / seconds * 1e-6;
        let Some(Opponent { scene, .. }) = &built.peer else {
            let [seconds] = self.in_turn(kind.batches.len(), |batch| [ours(batch)]);
            return Race { rate: rate(seconds), peer: None };
        };
        let mode = best_mode(scene, kind);
        let fresh: Vec<_> = kind.batches.iter().map(|rays| Packets::new(mode, rays)).collect();
        let mut packets = fresh.clone();
        let [seconds, peer_seconds] = self.in_turn(fresh.len(), |batch| {
            let ours = ours(batch);
            packets[batch].copy_from(&fresh[batch]);
            [ours, timed(|| scene.trace(kind.query, black_box(&mut packets[batch])))]
        });
        let agree = agreement(kind, &built.hierarchy, &packets);
        Race { rate: rate(seconds), peer: Some(Peer { rate: rate(peer_seconds), mode, agree }) }
    }

    /// Sums over all batches of each one's median time.
    fn in_turn<const N: usize>(&self, batches: usize, mut times: impl FnMut(usize) -> [f64; N]) -> [f64; N] {
        let mut all = vec![[(); N].map(|()| Vec::new()); batches];
        for _ in 0..self.runs {
            for (batch, all) in all.iter_mut().enumerate() {
                all.iter_mut().zip(times(batch)).for_each(|(all, time)| all.push(time));
            }
        }
        all.into_iter().fold([0.0; N], |sums, times| {
            let mut medians = times.into_iter().map(median);
            sums.map(|sum| sum + medians.next().expect("as many as sums"))
        })
    }
}

/// What was built, by whom and how fast.
struct Built<'a> {
    hierarchy: Hierarchy,
    seconds: f64,
    /// How many times as long as the peer's.
    ratio: f64,
    peer: Option<Opponent<'a>>,
}

/// What Embree has built.
struct Opponent<'a> {
    scene: Scene<'a>,
    seconds: f64,
    bytes: f64,
}

/// Million rays per second, and those of the peer.
struct Race {
    rate: f64,
    peer: Option<Peer>,
}

struct Peer {
    rate: f64,
    mode: Mode,
    /// The share of rays with the same answer.
    agree: f64,
}

fn timed(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

/// The mode in which Embree traces rays of a kind the fastest, by the best of several rounds over all of them.
fn best_mode(scene: &Scene<'_>, kind: &RayKind) -> Mode {
    const ROUNDS: usize = 4;
    let mut trials: Vec<_> = Mode::all().map(|mode| (mode, f64::INFINITY)).collect();
    for _ in 0..ROUNDS {
        for (mode, best) in &mut trials {
            let seconds = kind.batches.iter().map(|rays| {
                let mut packets = Packets::new(*mode, rays);
                timed(|| scene.trace(kind.query, black_box(&mut packets)))
            });
            *best = best.min(seconds.sum());
        }
    }
    trials.into_iter().min_by(|a, b| a.1.total_cmp(&b.1)).expect("there are modes").0
}

/// The share of rays with the same answer: blocked or not; the same triangle, or hits that lie as good as together, since
/// where two triangles meet either may win.
fn agreement(kind: &RayKind, hierarchy: &Hierarchy, packets: &[Packets]) -> f64 {
    let mut answers = Answers::default();
    let (mut same, mut all) = (0, 0);
    for (rays, packets) in kind.batches.iter().zip(packets) {
        match kind.query {
            Query::Closest => hierarchy.closest(rays, &mut answers),
            Query::Any => hierarchy.occluded(rays, &mut answers),
        }
        all += rays.len();
        same += (0..rays.len())
            .filter(|&i| match kind.query {
                Query::Any => answers.is_blocked(i) == packets.is_blocked(i),
                Query::Closest => match (answers.hit(i), packets.hit(i)) {
                    (None, None) => true,
                    (Some(hit), Some((t, u, v, triangle))) => {
                        let near = |a: f32, b: f32, by: f32| (a - b).abs() <= by;
                        let weights = near(hit.u, u, 1e-2) && near(hit.v, v, 1e-2);
                        near(hit.t, t, 1e-3 * t) && (hit.triangle != triangle || weights)
                    }
                    _ => false,
                },
            })
            .count();
    }
    same as f64 / all.max(1) as f64
}
