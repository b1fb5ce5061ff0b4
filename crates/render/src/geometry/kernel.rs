//! The formulas by which rays meet boxes and primitives.
//!
//! The lanes are eight boxes or primitives and the same ray, or rays and the same box or primitive; every lane goes
//! through the same operations in either case, so that a ray's hits do not depend on how it was traced.
//!
//! Triangles are tested as in [Woop, Benthin, Wald 2013] "Watertight Ray/Triangle Intersection": all corners are moved
//! and sheared such that the ray runs along an axis from the origin, each corner by itself; what is left is whether a
//! triangle in the plane covers the origin. The signs of its edge functions are never wrong, only zero at times, where
//! the origin counts as covered: so neither an edge nor a corner lets a ray through. Spheres follow [Haines, Günther,
//! Akenine-Möller 2019] "Precision Improvements for Ray/Sphere Intersection".

use glam::Vec3;

use super::simd::{Lanes, Vec3s};

/// A ray in each lane, or one ray in all, as boxes see it.
#[derive(Clone, Copy)]
pub(crate) struct Slab<S> {
    pub origin: Vec3s<S>,
    pub inverse: Inverse<S>,
}

/// One over directions: a little less for where boxes are entered, and a little more for where they are left, which
/// keeps rays that graze a box ([Ize 2013] "Robust BVH Ray Traversal"). The slab's roundings and those of the shear are
/// less than six of 2⁻²⁴ each.
#[derive(Clone, Copy)]
pub(crate) struct Inverse<S> {
    pub enter: Vec3s<S>,
    pub leave: Vec3s<S>,
}

/// [`Inverse`] of one component.
pub(crate) struct Reciprocal<S> {
    pub enter: S,
    pub leave: S,
}

/// One over components of directions; never infinite, because 0 × ∞ would be nothing where the origin lies on a side of a
/// box.
#[inline(always)]
pub(crate) fn inverse<S: Lanes>(d: S) -> Reciprocal<S> {
    let tiny = S::splat(1e-18);
    let magnitude = d.max(S::splat(0.0).sub(d));
    let inverse = S::splat(1.0).div(magnitude.select_lt(tiny, tiny.copysign(d), d));
    let (less, more) = (S::splat(1.0 - 4.0 * f32::EPSILON), S::splat(1.0 + 4.0 * f32::EPSILON));
    Reciprocal { enter: inverse.mul(less), leave: inverse.mul(more) }
}

impl<S: Lanes> Inverse<S> {
    #[inline(always)]
    pub fn new(direction: Vec3s<S>) -> Self {
        let (x, y, z) = (inverse(direction.x), inverse(direction.y), inverse(direction.z));
        let enter = Vec3s { x: x.enter, y: y.enter, z: z.enter };
        Inverse { enter, leave: Vec3s { x: x.leave, y: y.leave, z: z.leave } }
    }
}

/// Where rays enter boxes and where they leave them. `near` and `far` are the sides that a ray of these signs crosses
/// first and last. It is monotonic, so that a box never seems to be entered before the box around it.
#[inline(always)]
pub(crate) fn slab<S: Lanes>(near: Vec3s<S>, far: Vec3s<S>, ray: &Slab<S>) -> (S, S) {
    let near = near.sub(ray.origin).mul(ray.inverse.enter);
    let far = far.sub(ray.origin).mul(ray.inverse.leave);
    let enter = near.x.max(near.y).max(near.z.max(S::splat(0.0)));
    let leave = far.x.min(far.y).min(far.z);
    (enter, leave)
}

/// The axis along which a direction is the longest, of equals the first.
#[inline(always)]
pub(crate) fn dominant(direction: Vec3) -> usize {
    let d = direction.abs();
    if d.x >= d.y && d.x >= d.z {
        0
    } else if d.y >= d.z {
        1
    } else {
        2
    }
}

/// The coordinates in the order in which [`Shear`] has them: the dominant axis comes last.
#[inline(always)]
pub(crate) fn turned(dominant: usize) -> [usize; 3] {
    [[1, 2, 0], [2, 0, 1], [0, 1, 2]][dominant]
}

/// A ray in each lane, or one ray in all, as triangles see it.
#[derive(Clone, Copy)]
pub(crate) struct Shear<S> {
    /// In turned coordinates.
    pub origin: Vec3s<S>,
    /// How far the ray goes along the first two while it goes 1 along the last.
    pub slope: (S, S),
    /// `t` per unit along the last.
    pub scale: S,
    pub t_min: S,
}

impl<S: Lanes> Shear<S> {
    #[inline(always)]
    fn shear(&self, point: Vec3s<S>) -> Vec3s<S> {
        let Vec3s { x, y, z } = point.sub(self.origin);
        Vec3s { x: x.sub(self.slope.0.mul(z)), y: y.sub(self.slope.1.mul(z)), z }
    }
}

/// Hits of some lanes. What the lanes outside of `mask` hold means nothing.
pub(crate) struct Crossing<S> {
    pub mask: u32,
    pub t: S,
    /// Weights of a triangle's second and third vertex.
    pub u: S,
    pub v: S,
}

/// Triangles between `t_min` and `t_max`, the end included, their corners in turned coordinates. A hit is never closer
/// than `enter`, where the ray enters the box of the leaf: what a traversal may leave out because of its box must not be
/// able to win.
#[inline(always)]
pub(crate) fn triangle<S: Lanes, const EARLY: bool>(
    ray: &Shear<S>,
    corners: [Vec3s<S>; 3],
    enter: S,
    t_max: S,
) -> Option<Crossing<S>> {
    let (a, b, c) = (ray.shear(corners[0]), ray.shear(corners[1]), ray.shear(corners[2]));
    // Edge functions: weights of the corners, up to a common factor. On the two sides of an edge they are exact negatives.
    let wa = c.x.mul(b.y).sub(c.y.mul(b.x));
    let wb = a.x.mul(c.y).sub(a.y.mul(c.x));
    let wc = b.x.mul(a.y).sub(b.y.mul(a.x));
    let zero = S::splat(0.0);
    let (least, most) = (wa.min(wb).min(wc), wa.max(wb).max(wc));
    let mask = zero.le(least) | most.le(zero);
    if EARLY && mask == 0 {
        return None;
    }
    let total = wa.add(wb).add(wc);
    let t = wa.mul(a.z).add(wb.mul(b.z)).add(wc.mul(c.z)).div(total).mul(ray.scale);
    let flat = mask & zero.le(total) & total.le(zero);
    if flat != 0 {
        let mut crossing = Crossing { mask, t, u: wb.div(total), v: wc.div(total) };
        crossing.exact(flat, &[a.store(), b.store(), c.store()], ray.scale.store());
        crossing.t = enter.max(crossing.t);
        crossing.mask &= ray.t_min.lt(crossing.t) & crossing.t.le(t_max);
        return (crossing.mask != 0).then_some(crossing);
    }
    let t = enter.max(t);
    let mask = mask & ray.t_min.lt(t) & t.le(t_max);
    if mask == 0 {
        return None;
    }
    Some(Crossing { mask, t, u: wb.div(total), v: wc.div(total) })
}

impl<S: Lanes> Crossing<S> {
    /// Decides again in double precision, where products of single ones are exact, about lanes whose edge functions have
    /// all come out as zero. Those are slivers, seen from the side or far away; where they have no area even so, the ray
    /// does not meet them.
    #[inline(always)]
    fn exact(&mut self, lanes: u32, corners: &[[S::Floats; 3]; 3], scale: S::Floats) {
        let mut rest = lanes;
        while rest != 0 {
            let i = rest.trailing_zeros() as usize;
            rest &= rest - 1;
            let corner = |k: usize| [0, 1, 2].map(|axis: usize| f64::from(corners[k][axis].as_ref()[i]));
            match exact([corner(0), corner(1), corner(2)], f64::from(scale.as_ref()[i])) {
                Some([t, u, v]) => {
                    self.t = S::select(1 << i, S::splat(t), self.t);
                    self.u = S::select(1 << i, S::splat(u), self.u);
                    self.v = S::select(1 << i, S::splat(v), self.v);
                }
                None => self.mask &= !(1 << i),
            }
        }
    }
}

/// [`triangle`] for one sheared triangle: `t`, `u` and `v`.
#[cold]
#[inline(never)]
fn exact([a, b, c]: [[f64; 3]; 3], scale: f64) -> Option<[f32; 3]> {
    let wa = c[0] * b[1] - c[1] * b[0];
    let wb = a[0] * c[1] - a[1] * c[0];
    let wc = b[0] * a[1] - b[1] * a[0];
    let inside = (wa >= 0.0 && wb >= 0.0 && wc >= 0.0) || (wa <= 0.0 && wb <= 0.0 && wc <= 0.0);
    let total = wa + wb + wc;
    let t = (wa * a[2] + wb * b[2] + wc * c[2]) / total * scale;
    (inside && total != 0.0).then_some([t as f32, (wb / total) as f32, (wc / total) as f32])
}

/// A ray in each lane, or one ray in all, as it is.
pub(crate) struct Plain<S> {
    pub origin: Vec3s<S>,
    pub direction: Vec3s<S>,
    pub t_min: S,
}

/// Spheres between `t_min` and `t_max`, the end included; see [`triangle`] about `enter`.
#[inline(always)]
pub(crate) fn sphere<S: Lanes>(ray: &Plain<S>, center: Vec3s<S>, radius: S, enter: S, t_max: S) -> Option<Crossing<S>> {
    let d = ray.direction;
    let f = ray.origin.sub(center);
    let a = d.dot(d);
    let zero = S::splat(0.0);
    let b = zero.sub(f.dot(d));
    let nearest = f.add(d.scale(b.div(a)));
    let discriminant = radius.mul(radius).sub(nearest.dot(nearest));
    let mask = zero.le(discriminant);
    if mask == 0 {
        return None;
    }
    let q = b.add(a.mul(discriminant).sqrt().copysign(b));
    let c = f.dot(f).sub(radius.mul(radius));
    let (t0, t1) = (c.div(q), q.div(a));
    let (near, far) = (t0.min(t1), t0.max(t1));
    let t = ray.t_min.select_lt(near, near, far);
    let mask = mask & ray.t_min.lt(t);
    let t = enter.max(t);
    let mask = mask & t.le(t_max);
    Some(Crossing { mask, t, u: zero, v: zero })
}
