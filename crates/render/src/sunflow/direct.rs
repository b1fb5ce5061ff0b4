//! Light that comes straight from the lights.

use std::iter::repeat_n;

use glam::Vec3;

use super::coat::Bsdf;
use super::point::{Point, Which};
use super::{Queues, Room, Sunflow};
use crate::clock::Stage;
use crate::geometry::simd::{self, Simd};
use crate::geometry::{Geometry, Ids, Rays, Rows, Scratch};
use crate::light::{Arrival, FAN, Fan, Light, Receiver, Single, Spot};

/// Rays towards lights, and what arrives if nothing is in the way.
#[derive(Default)]
pub(super) struct Shadows {
    rays: Rays,
    light: Rows,
    nodes: Vec<u32>,
    blocked: Vec<bool>,
    sorted: Sorted,
}

impl Shadows {
    /// Shadow rays that are traced together at most, give or take those of one point.
    const FULL: usize = 4096;

    /// Queues what is kept of a fan from one point, by whose path it goes on.
    pub fn push_fan(&mut self, fan: &Fan, kept: &Kept, point: &Point<'_>) {
        self.push_arrivals(fan, kept);
        let (count, Vec3 { x, y, z }) = (kept.count, point.front);
        let Rays { origin, skip, time, .. } = &mut self.rays;
        origin.x.extend(repeat_n(x, count));
        origin.y.extend(repeat_n(y, count));
        origin.z.extend(repeat_n(z, count));
        skip.object.extend(repeat_n(point.skip.object, count));
        skip.index.extend(repeat_n(point.skip.index, count));
        time.extend(point.hit.time.into_iter().flat_map(|time| repeat_n(time, count)));
        self.nodes.extend(repeat_n(point.path.node, count));
    }

    /// Queues what is kept of a fan from surfaces that wait, of which those from `first` on belong to it.
    fn push_sheaf(&mut self, fan: &Fan, kept: &Kept, waiting: &Waiting, first: usize) {
        self.push_arrivals(fan, kept);
        let of = |row: &mut Vec<f32>, from: &[f32]| row.extend(kept.of(&from[first..]));
        let Rays { origin, skip, time, .. } = &mut self.rays;
        of(&mut origin.x, &waiting.front.x);
        of(&mut origin.y, &waiting.front.y);
        of(&mut origin.z, &waiting.front.z);
        skip.object.extend(kept.of(&waiting.skip.object[first..]));
        skip.index.extend(kept.of(&waiting.skip.index[first..]));
        if !waiting.time.is_empty() {
            of(time, &waiting.time);
        }
        self.nodes.extend(kept.of(&waiting.node[first..]));
    }

    fn push_arrivals(&mut self, fan: &Fan, kept: &Kept) {
        let of = |row: &mut Vec<f32>, from: &[f32; FAN]| match kept.count == fan.size {
            true => row.extend_from_slice(&from[..fan.size]),
            false => row.extend(kept.of(from)),
        };
        let ([x, y, z], [red, green, blue]) = (&fan.direction, &fan.irradiance);
        of(&mut self.rays.direction.x, x);
        of(&mut self.rays.direction.y, y);
        of(&mut self.rays.direction.z, z);
        of(&mut self.rays.t_max, &fan.distance);
        of(&mut self.light.x, red);
        of(&mut self.light.y, green);
        of(&mut self.light.z, blue);
    }

    /// Traces what is queued if it is much.
    pub fn flush(&mut self, geometry: &Geometry, queues: &mut Queues<Vec<Vec3>>, scratch: &mut Scratch) {
        if self.nodes.len() >= Shadows::FULL {
            self.trace(geometry, queues, scratch);
        }
    }

    /// Traces what is queued and hands out what arrives.
    pub fn trace(&mut self, geometry: &Geometry, queues: &mut Queues<Vec<Vec3>>, scratch: &mut Scratch) {
        queues.stats.shadow_rays += self.nodes.len() as u64;
        queues.clock.lap(Stage::Shade);
        let Shadows { rays, light, nodes, blocked, sorted } = self;
        if sorted.sort(rays) {
            geometry.occluded(sorted.rays.view(0.0), &mut sorted.blocked, scratch);
            blocked.resize(nodes.len(), false);
            for (&i, &is_blocked) in sorted.order.iter().zip(&sorted.blocked) {
                blocked[i as usize] = is_blocked;
            }
        } else {
            geometry.occluded(rays.view(0.0), blocked, scratch);
        }
        queues.clock.lap(Stage::Trace);
        // In the order in which they were asked for: sums must not depend on what else is in the queue.
        for (i, (&node, &blocked)) in nodes.iter().zip(&*blocked).enumerate() {
            if !blocked {
                queues.nodes[node as usize] += light.get(i);
            }
        }
        rays.clear();
        light.clear();
        nodes.clear();
    }
}

/// Rays once more, by where they go: packets of them need directions of the same signs, and of the same dominant axis.
#[derive(Default)]
struct Sorted {
    rays: Rays,
    /// What each of them is among all.
    order: Vec<u32>,
    headings: Vec<u8>,
    blocked: Vec<bool>,
}

impl Sorted {
    /// Rays that are looked at together: as many as the largest packets have.
    const GROUP: usize = 16;
    /// Eight combinations of signs for each dominant axis.
    const HEADINGS: usize = 24;

    /// Returns whether sorting was worth it: rays that already go together stay where they are.
    fn sort(&mut self, all: &Rays) -> bool {
        simd::run(Headings { rays: all, headings: &mut self.headings });
        let mixed = |group: &&[u8]| group.iter().any(|heading| heading != &group[0]);
        let groups = self.headings.chunks(Self::GROUP);
        if groups.clone().filter(mixed).count() * 4 < groups.len() {
            return false;
        }
        let mut ends = [0; Self::HEADINGS + 1];
        self.headings.iter().for_each(|&heading| ends[usize::from(heading) + 1] += 1);
        (0..Self::HEADINGS).for_each(|k| ends[k + 1] += ends[k]);
        self.order.resize(all.len(), 0);
        for (i, &heading) in (0..).zip(&self.headings) {
            let end = &mut ends[usize::from(heading)];
            self.order[*end as usize] = i;
            *end += 1;
        }
        self.rays.gather(all, &self.order);
        true
    }
}

/// Which way rays go.
struct Headings<'a> {
    rays: &'a Rays,
    headings: &'a mut Vec<u8>,
}

impl simd::Kernel for Headings<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let count = self.rays.len();
        self.headings.resize(count, 0);
        let [x, y, z] = self.rays.direction.slices(count);
        for (i, heading) in self.headings[..count].iter_mut().enumerate() {
            let (ax, ay, az) = (x[i].abs(), y[i].abs(), z[i].abs());
            let axis = if (ax >= ay) & (ax >= az) { 0 } else { 1 + u8::from(az > ay) };
            *heading = u8::from(x[i] < 0.0) | u8::from(y[i] < 0.0) << 1 | u8::from(z[i] < 0.0) << 2 | axis << 3;
        }
    }
}

/// A surface that waits for light, and is not black.
pub(super) struct Lit<'a> {
    pub point: Point<'a>,
    pub bsdf: Bsdf,
    /// Its matte colour, for virtual lights.
    pub color: Vec3,
}

impl Lit<'_> {
    /// What the surface makes of light from anywhere, if that is the same for all: else 1, and [`Lit::gloss`] the rest.
    fn even(&self) -> Vec3 {
        self.bsdf.matte_only().map_or(Vec3::ONE, |matte| self.point.path.weight * matte)
    }

    /// What it makes of the light from the direction of arrival `i`, if that is not [`Lit::even`].
    fn gloss(&self, fan: &mut Fan, i: usize) {
        if self.bsdf.matte_only().is_none() {
            let value = self.point.path.weight * self.bsdf.value(fan.direction(i));
            fan.irradiance.iter_mut().zip(value.to_array()).for_each(|(row, value)| row[i] *= value);
        }
    }
}

/// [`Lit::even`], and that nothing limits it.
fn unlimited(lit: &Lit<'_>) -> (Vec3, f32) {
    (lit.even(), f32::INFINITY)
}

/// Surfaces that wait for light, in rows.
#[derive(Default)]
pub(super) struct Waiting {
    /// What each of them is among all.
    order: Vec<u32>,
    /// Where rays towards light start.
    front: Rows,
    normal: Rows,
    geometric: Rows,
    /// What they make of light.
    value: Rows,
    limit: Vec<f32>,
    skip: Ids,
    node: Vec<u32>,
    /// Empty where nothing moves.
    time: Vec<f32>,
}

impl Waiting {
    /// Some of the surfaces, in an order, with what they make of light and what limits it.
    fn fill(&mut self, lit: &[Lit<'_>], some: impl Iterator<Item = u32>, value: impl Fn(&Lit<'_>) -> (Vec3, f32)) {
        let Waiting { order, front, normal, geometric, value: values, limit: limits, skip, node, time } = self;
        [&mut *front, normal, geometric, values].into_iter().for_each(Rows::clear);
        [&mut *order, node].into_iter().for_each(Vec::clear);
        [&mut *limits, time].into_iter().for_each(Vec::clear);
        skip.clear();
        order.extend(some);
        for lit in order.iter().map(|&i| &lit[i as usize]) {
            let (point, (value, limit)) = (&lit.point, value(lit));
            front.push(point.front);
            normal.push(point.surface.normal);
            geometric.push(point.surface.geometric);
            values.push(value);
            limits.push(limit);
            skip.push(point.skip);
            node.push(point.path.node);
            time.extend(point.hit.time);
        }
    }

    /// All surfaces, as they are.
    fn fill_all(&mut self, lit: &[Lit<'_>]) {
        self.fill(lit, 0..lit.len() as u32, unlimited);
    }
}

/// Which arrivals of a fan are worth a ray.
pub(super) struct Kept {
    indices: [u8; FAN],
    count: usize,
}

impl Kept {
    /// Those for which `is_kept` says so, of the first `size`.
    #[inline(always)]
    pub fn among(is_kept: &[bool; FAN], size: usize) -> Kept {
        let mut kept = Kept { indices: [0; FAN], count: 0 };
        for (i, &is_kept) in (0..).zip(&is_kept[..size.min(FAN)]) {
            kept.indices[kept.count] = i;
            kept.count += usize::from(is_kept);
        }
        kept
    }

    fn indices(&self) -> &[u8] {
        &self.indices[..self.count]
    }

    fn of<T: Copy>(&self, row: &[T]) -> impl ExactSizeIterator<Item = T> {
        self.indices().iter().map(|&i| row[usize::from(i)])
    }
}

/// Whether light that comes from a direction falls onto the front of a surface, and what that makes of it.
#[inline(always)]
fn fall(direction: Vec3, irradiance: Vec3, [normal, geometric, value]: [Vec3; 3]) -> (bool, Vec3) {
    let cosine = direction.dot(normal);
    let light = value * irradiance * cosine;
    let some = (light.x != 0.0) | (light.y != 0.0) | (light.z != 0.0);
    ((cosine > 0.0) & (direction.dot(geometric) > 0.0) & some, light)
}

/// What one surface makes of a fan: its normals and [`Lit::even`].
struct Fall<'a> {
    fan: &'a mut Fan,
    surface: [Vec3; 3],
}

impl simd::Kernel for Fall<'_> {
    type Output = Kept;

    #[inline(always)]
    fn run<S: Simd>(self) -> Kept {
        let Fan { size, direction: [x, y, z], irradiance: [red, green, blue], .. } = self.fan;
        let mut is_kept = [false; FAN];
        for i in 0..size.next_multiple_of(8).min(FAN) {
            let (direction, irradiance) = (Vec3::new(x[i], y[i], z[i]), Vec3::new(red[i], green[i], blue[i]));
            let light;
            (is_kept[i], light) = fall(direction, irradiance, self.surface);
            (red[i], green[i], blue[i]) = (light.x, light.y, light.z);
        }
        Kept::among(&is_kept, *size)
    }
}

/// What surfaces that wait, from `first` on, make of a light.
struct Reach<'a, L> {
    light: L,
    waiting: &'a Waiting,
    first: usize,
    fan: &'a mut Fan,
}

impl<L: Single> simd::Kernel for Reach<'_, L> {
    type Output = Kept;

    #[inline(always)]
    fn run<S: Simd>(self) -> Kept {
        let Reach { light, waiting, first, fan } = self;
        let size = (waiting.node.len() - first).min(FAN);
        let [px, py, pz] = waiting.front.part(first, size);
        let [nx, ny, nz] = waiting.normal.part(first, size);
        let [gx, gy, gz] = waiting.geometric.part(first, size);
        let [vr, vg, vb] = waiting.value.part(first, size);
        let limit = &waiting.limit[first..][..size];
        // Written aside, where the compiler sees that it is none of what is read.
        let mut arrivals = Fan { size, ..Fan::default() };
        let ([x, y, z], [red, green, blue]) = (&mut arrivals.direction, &mut arrivals.irradiance);
        let mut is_kept = [false; FAN];
        for i in 0..size {
            let (normal, geometric) = (Vec3::new(nx[i], ny[i], nz[i]), Vec3::new(gx[i], gy[i], gz[i]));
            let spot = Spot { point: Vec3::new(px[i], py[i], pz[i]), normal, limit: limit[i] };
            let Arrival { direction, distance, irradiance } = light.reach(&spot);
            let light;
            (is_kept[i], light) = fall(direction, irradiance, [normal, geometric, Vec3::new(vr[i], vg[i], vb[i])]);
            (x[i], y[i], z[i]) = (direction.x, direction.y, direction.z);
            arrivals.distance[i] = distance;
            (red[i], green[i], blue[i]) = (light.x, light.y, light.z);
        }
        *fan = arrivals;
        Kept::among(&is_kept, size)
    }
}

impl Sunflow {
    /// Direct light on surfaces, one light after the other, so that the rays towards it go together.
    pub(super) fn illuminate(
        &self,
        geometry: &Geometry,
        lit: &[Lit<'_>],
        room: &mut Room,
        queues: &mut Queues<Vec<Vec3>>,
    ) {
        let mut all_wait = false;
        for (light, number) in self.lights.iter().zip(0..) {
            if light.is_single() && !all_wait {
                room.waiting.fill_all(lit);
                all_wait = true;
            }
            match light {
                Light::Point(lamp) => shine(*lamp, geometry, lit, room, queues),
                Light::Directional(beam) => shine(*beam, geometry, lit, room, queues),
                Light::Sun(sun) => shine(*sun, geometry, lit, room, queues),
                Light::Beams(beams) => {
                    let list = |lit: &Lit<'_>| usize::from(lit.point.path.depth.diffuse > 0);
                    in_turn(beams, lit, list, unlimited, room, |beam, share, room| {
                        let beam = Arrival { irradiance: beam.irradiance * share, ..*beam };
                        shine(beam, geometry, lit, room, queues);
                    });
                    all_wait = false;
                }
                _ => {
                    let Room { fan, shadows, scratch, .. } = room;
                    for lit in lit {
                        let point = &lit.point;
                        let at = Receiver {
                            point: point.front,
                            normal: point.surface.normal,
                            indirect: point.path.depth.diffuse > 0,
                            share: point.share,
                            key: point.key,
                            dimension: point.dimension(Which::Lights),
                        };
                        let surface = [point.surface.normal, point.surface.geometric, lit.even()];
                        light.arrive(number, &at, fan, &mut |fan| {
                            let kept = simd::run(Fall { fan, surface });
                            kept.indices().iter().for_each(|&i| lit.gloss(fan, usize::from(i)));
                            shadows.push_fan(fan, &kept, point);
                        });
                        shadows.flush(geometry, queues, scratch);
                    }
                }
            }
        }
    }
}

/// Light that comes to every surface that waits from one direction. Coats are those of `coats`, or none.
pub(super) fn shine(
    light: impl Single + Copy,
    geometry: &Geometry,
    coats: &[Lit<'_>],
    room: &mut Room,
    queues: &mut Queues<Vec<Vec3>>,
) {
    let Room { waiting, fan, shadows, scratch, .. } = room;
    for first in (0..waiting.node.len()).step_by(FAN) {
        let kept = simd::run(Reach { light, waiting, first, fan });
        for &i in kept.indices() {
            if let Some(lit) = coats.get(waiting.order[first + usize::from(i)] as usize) {
                lit.gloss(fan, usize::from(i));
            }
        }
        shadows.push_sheaf(fan, &kept, waiting, first);
        shadows.flush(geometry, queues, scratch);
    }
}

/// Lights that all surfaces have in common, of which the samples of a pixel take one each in turn, and so many times as
/// much of it: `list` says which list a surface takes them from. `shine` is called with the surfaces that take a light waiting.
pub(super) fn in_turn<L>(
    lists: &[impl AsRef<[L]>],
    lit: &[Lit<'_>],
    list: impl Fn(&Lit<'_>) -> usize,
    value: impl Fn(&Lit<'_>) -> (Vec3, f32),
    room: &mut Room,
    mut shine: impl FnMut(&L, f32, &mut Room),
) {
    let group = |lit: &Lit<'_>| {
        let (list, point) = (list(lit), &lit.point);
        let share = (point.of as usize).clamp(1, lists[list].as_ref().len().max(1));
        (list, share, point.key.index as usize % share)
    };
    let mut groups: Vec<_> = (0..).zip(lit).map(|(i, lit)| (group(lit), i)).collect();
    groups.sort_unstable();
    for members in groups.chunk_by(|(a, _), (b, _)| a == b) {
        let (list, share, turn) = members[0].0;
        room.waiting.fill(lit, members.iter().map(|&(_, i)| i), &value);
        for light in lists[list].as_ref().iter().skip(turn).step_by(share) {
            shine(light, share as f32, room);
        }
    }
}
