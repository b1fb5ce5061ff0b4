//! A few spheres without a tree: a group of rays looks once at all of them, and its packets meet those that are left.
//!
//! Rays of a group start near each other and go about the same way, so that most spheres lie beside all of them. What a
//! group leaves out, none of its rays could meet: what is said of all of them is said in intervals ([Boulos, Wald, Shirley
//! 2006], as for packets), with room for the roundings of the kernel.

use glam::Vec3;

use super::bvh::{Child, Kind};
use super::packet::Packet;
use super::rays::{Group, RayView, group, group_bits};
use super::simd::{Kernel, Lanes, Simd, Vec3s};
use super::stream::Outcome;
use super::traverse::{SphereBlock, Tree};
use super::{Id, PlaneShape};

/// Rays of a group: two rows of a tile with four samples each.
const GROUP: usize = 256;

/// All that there is to meet, if it is no more than some planes and a block of spheres.
pub(super) struct Few<'a> {
    planes: &'a [PlaneShape],
    spheres: Option<&'a SphereBlock>,
}

impl<'a> Few<'a> {
    /// `None` where there is more.
    pub fn of(tree: &'a Tree, planes: &'a [PlaneShape]) -> Option<Self> {
        match tree.root {
            Child::NONE => Some(Few { planes, spheres: None }),
            root if !root.is_node() && root.kind() == Kind::Spheres => {
                Some(Few { planes, spheres: Some(&tree.spheres[root.index()]) })
            }
            _ => None,
        }
    }

    /// Where the group from ray `first` on ends, and which spheres it may meet.
    #[inline(always)]
    fn look<S: Simd>(&self, rays: RayView<'_>, first: usize) -> (usize, u32) {
        let end = rays.len().min(first + GROUP);
        let slots = match self.spheres {
            Some(block) => Bundle::of::<S::Wide>(rays, first, end).candidates::<S>(block),
            None => 0,
        };
        (end, slots)
    }

    #[inline(always)]
    fn meet<O: Outcome, L: Lanes, S: Simd>(&self, packet: &mut Packet<L, S>, slots: u32) {
        packet.planes::<O>(self.planes);
        if let Some(block) = self.spheres {
            packet.spheres::<O>(block, slots, u32::MAX, L::splat(0.0));
        }
    }
}

/// What every ray meets, as a kernel.
pub(super) struct Meet<'a, O> {
    pub few: Few<'a>,
    pub rays: RayView<'a>,
    pub outcome: O,
}

impl<O: Outcome> Kernel for Meet<'_, O> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self) {
        let Meet { few, rays, mut outcome } = self;
        for first in (0..rays.len()).step_by(GROUP) {
            let (end, slots) = few.look::<S>(rays, first);
            if slots == 0 && few.planes.is_empty() {
                outcome.pass(first..end, rays.t_max);
                continue;
            }
            for start in (first..end).step_by(S::Wide::COUNT) {
                let group = Group::row(&rays, start);
                let mut packet = Packet::<S::Wide, S>::new::<O>(&group, rays.t_min);
                if !O::ANY || !packet.is_dead() {
                    few.meet::<O, _, _>(&mut packet, slots);
                }
                outcome.take_row(start, &packet);
            }
        }
    }
}

/// What all rays of a group that look for anything have in common.
struct Bundle {
    /// Least and largest coordinates of origins, and of directions.
    origin: [Vec3; 2],
    direction: [Vec3; 2],
    /// How far the farthest of them reaches.
    t_max: f32,
    /// The primitive that all of them leave, if it is one.
    skip: Id,
}

/// Least and largest numbers in each lane.
#[derive(Clone, Copy)]
struct Span<L> {
    least: L,
    most: L,
}

impl<L: Lanes> Span<L> {
    #[inline(always)]
    fn at(x: L) -> Self {
        Span { least: x, most: x }
    }

    /// Includes the lanes of a mask. What is not a number is left out.
    #[inline(always)]
    fn include(&mut self, mask: u32, x: L) {
        self.least = L::select(mask, x.min(self.least), self.least);
        self.most = L::select(mask, x.max(self.most), self.most);
    }

    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Span { least: self.least.add(o.least), most: self.most.add(o.most) }
    }

    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Span { least: self.least.sub(o.most), most: self.most.sub(o.least) }
    }

    #[inline(always)]
    fn mul(self, o: Self) -> Self {
        let (a, b) = (self.least.mul(o.least), self.least.mul(o.most));
        let (c, d) = (self.most.mul(o.least), self.most.mul(o.most));
        Span { least: a.min(b).min(c.min(d)), most: a.max(b).max(c.max(d)) }
    }

    /// The least and the largest square.
    #[inline(always)]
    fn square(self) -> Self {
        let zero = L::splat(0.0);
        let (below, above) = (zero.sub(self.least), self.most);
        let (least, most) = (zero.max(zero.sub(below)).max(zero.sub(above)), below.max(above));
        Span { least: least.mul(least), most: most.mul(most) }
    }
}

/// The least and the largest numbers of all lanes.
#[inline(always)]
fn ends<L: Lanes>([x, y, z]: [Span<L>; 3]) -> [Vec3; 2] {
    let least = Vec3::new(x.least.least(), y.least.least(), z.least.least());
    [least, Vec3::new(x.most.most(), y.most.most(), z.most.most())]
}

/// The same numbers along an axis in all lanes.
#[inline(always)]
fn span<L: Lanes>([least, most]: [Vec3; 2], axis: usize) -> Span<L> {
    Span { least: L::splat(least[axis]), most: L::splat(most[axis]) }
}

impl Bundle {
    #[inline(always)]
    fn of<L: Lanes>(rays: RayView<'_>, first: usize, end: usize) -> Bundle {
        let mut origin = [span::<L>([Vec3::INFINITY, Vec3::NEG_INFINITY], 0); 3];
        let mut direction = origin;
        let mut reach = L::splat(f32::NEG_INFINITY);
        let skip = Id { object: rays.skip.object[first], index: rays.skip.index[first] };
        let (object, index) = (L::splat(f32::from_bits(skip.object)), L::splat(f32::from_bits(skip.index)));
        let mut same = true;
        for start in (first..end).step_by(L::COUNT) {
            let t_max: L = group(rays.t_max, start, -1.0);
            let alive = L::splat(0.0).le(t_max);
            let Vec3s { x, y, z } = rays.origin.group::<L>(start);
            origin[0].include(alive, x);
            origin[1].include(alive, y);
            origin[2].include(alive, z);
            let Vec3s { x, y, z } = rays.direction.group::<L>(start);
            direction[0].include(alive, x);
            direction[1].include(alive, y);
            direction[2].include(alive, z);
            reach = t_max.max(reach);
            let objects: L = group_bits(&rays.skip.object, start, skip.object);
            let indices: L = group_bits(&rays.skip.index, start, skip.index);
            same &= (objects.same_bits(object) & indices.same_bits(index)) | !alive == u32::MAX;
        }
        let skip = if same { skip } else { Id::NONE };
        Bundle { origin: ends(origin), direction: ends(direction), t_max: reach.most(), skip }
    }

    /// The spheres of a block that a ray of the bundle might meet, as a mask.
    #[inline(always)]
    fn candidates<S: Simd>(&self, block: &SphereBlock) -> u32 {
        if self.t_max < 0.0 {
            return 0;
        }
        let centers = Vec3s::<S>::load(&block.centers);
        let radii = S::load(&block.radii);
        // From the centres to the origins.
        let x = span(self.origin, 0).sub(Span::at(centers.x));
        let y = span(self.origin, 1).sub(Span::at(centers.y));
        let z = span(self.origin, 2).sub(Span::at(centers.z));
        let (dx, dy, dz) = (span(self.direction, 0), span(self.direction, 1), span(self.direction, 2));
        let (distance2, length2) =
            (x.square().add(y.square()).add(z.square()), dx.square().add(dy.square()).add(dz.square()));
        // Distances of the centres from the rays' lines, times the lengths of the directions.
        let (cx, cy, cz) = (y.mul(dz).sub(z.mul(dy)), z.mul(dx).sub(x.mul(dz)), x.mul(dy).sub(y.mul(dx)));
        let aside2 = cx.square().add(cy.square()).add(cz.square());
        let along = x.mul(dx).add(y.mul(dy)).add(z.mul(dz));
        // The kernel's roundings are some units in the last place of what it computes with.
        let radius = radii.mul(S::splat(1.001)).add(distance2.most.sqrt().mul(S::splat(1e-4)));
        let radius2 = radius.mul(radius);
        let beside = radius2.mul(length2.most).lt(aside2.least);
        let outside = radius2.lt(distance2.least);
        let behind = outside & S::splat(0.0).lt(along.least);
        let reach = radius.add(S::splat(self.t_max).mul(length2.most.sqrt()));
        let beyond = outside & reach.mul(reach).lt(distance2.least);
        let mut slots = 0;
        for (slot, &id) in block.ids.iter().enumerate() {
            slots |= u32::from(id != Id::NONE && id != self.skip) << slot;
        }
        slots & !(beside | behind | beyond)
    }
}
