//! The formulas by which rays meet boxes and primitives, eight at a time.
//!
//! The lanes are eight boxes or primitives and the same ray, or eight rays and the same box or primitive; every lane
//! goes through the same operations in either case, so that a ray's hits do not depend on how it was traced.
//!
//! Triangles are tested by the signs of their edge functions ([Davidovič et al. 2012] "3D Rasterization: A Bridge
//! between Rasterization and Ray Tracing"), which are exact negatives of each other on the two sides of a shared edge,
//! so that no ray slips between two neighbours. Spheres follow [Haines, Günther, Akenine-Möller 2019] "Precision
//! Improvements for Ray/Sphere Intersection".

use super::simd::{Simd, Vec3x8};

/// One ray in all lanes, or a ray in each.
pub(crate) struct Lanes<S> {
    pub origin: Vec3x8<S>,
    pub direction: Vec3x8<S>,
    pub t_min: S,
}

/// Hits of some lanes. What the lanes outside of `mask` hold means nothing.
pub(crate) struct Crossing<S> {
    pub mask: u32,
    pub t: S,
    /// Weights of a triangle's second and third vertex.
    pub u: S,
    pub v: S,
}

/// One over a component of directions; never infinite, because 0 × ∞ would be nothing where the origin lies on a side
/// of a box.
#[inline(always)]
pub(crate) fn inverse<S: Simd>(d: S) -> S {
    let tiny = S::splat(1e-18);
    let magnitude = d.max(S::splat(0.0).sub(d));
    S::splat(1.0).div(magnitude.select_lt(tiny, tiny.copysign(d), d))
}

/// Where rays enter boxes and where they leave them. `near` and `far` are the sides that a ray of these signs crosses
/// first and last.
///
/// A few roundings on either side keep rays that graze a box ([Ize 2013] "Robust BVH Ray Traversal"). All of it is
/// monotonic, so that a box never seems to be entered before the box around it.
#[inline(always)]
pub(crate) fn slab<S: Simd>(near: Vec3x8<S>, far: Vec3x8<S>, origin: Vec3x8<S>, inverse: Vec3x8<S>) -> (S, S) {
    let near = near.sub(origin).mul(inverse);
    let far = far.sub(origin).mul(inverse);
    let enter = near.x.max(near.y).max(near.z.max(S::splat(0.0)));
    let leave = far.x.min(far.y).min(far.z);
    (enter.mul(S::splat(0.999_999_5)), leave.mul(S::splat(1.000_000_5)))
}

/// Triangles between `t_min` and `t_max`, the end included. A hit is never closer than `enter`, where the ray enters
/// the box of the leaf: what a traversal may leave out because of its box must not be able to win.
#[inline(always)]
pub(crate) fn triangle<S: Simd>(rays: &Lanes<S>, corners: [Vec3x8<S>; 3], enter: S, t_max: S) -> Option<Crossing<S>> {
    let [a, b, c] = corners;
    let (a, b, c) = (a.sub(rays.origin), b.sub(rays.origin), c.sub(rays.origin));
    let (e0, e1, e2) = (c.sub(a), a.sub(b), b.sub(c));
    let d = rays.direction;
    // Edge functions: weights of b, c and a, up to a common factor.
    let wb = c.add(a).cross(e0).dot(d);
    let wc = a.add(b).cross(e1).dot(d);
    let wa = b.add(c).cross(e2).dot(d);
    let zero = S::splat(0.0);
    let least = wa.min(wb).min(wc);
    let most = wa.max(wb).max(wc);
    let mask = zero.le(least) | most.le(zero);
    if mask == 0 {
        return None;
    }
    let normal = e0.cross(e1);
    let t = enter.max(a.dot(normal).div(d.dot(normal)));
    let mask = mask & rays.t_min.lt(t) & t.le(t_max);
    if mask == 0 {
        return None;
    }
    let total = wa.add(wb).add(wc);
    let (u, v) = (wb.div(total), wc.div(total));
    // Triangles without area have no weights: 0 / 0.
    let mask = mask & u.le(S::splat(1.0)) & v.le(S::splat(1.0));
    Some(Crossing { mask, t, u, v })
}

/// Spheres between `t_min` and `t_max`, the end included; see [`triangle`] about `enter`.
#[inline(always)]
pub(crate) fn sphere<S: Simd>(
    rays: &Lanes<S>,
    center: Vec3x8<S>,
    radius: S,
    enter: S,
    t_max: S,
) -> Option<Crossing<S>> {
    let d = rays.direction;
    let f = rays.origin.sub(center);
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
    let t = rays.t_min.select_lt(near, near, far);
    let mask = mask & rays.t_min.lt(t);
    let t = enter.max(t);
    let mask = mask & t.le(t_max);
    Some(Crossing { mask, t, u: zero, v: zero })
}
