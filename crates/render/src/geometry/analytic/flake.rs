//! Spheres on spheres (format reference, §3.13). Up to level 7, which has five million, they are stored like any others, which is
//! the fastest; deeper ones are found on the way, and need no memory.

use glam::{DVec3, Vec2, Vec3};

use super::{Analytic, LocalRay, Meeting};
use crate::geometry::SphereSet;
use crate::geometry::bvh::Aabb;
use crate::geometry::surface::sphere_uv;

/// A sphere with nine on it, a third of its size, and so on.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Flake {
    /// How many times over; the sphere alone is level 0.
    pub level: u32,
    /// Of unit length: around it the nine stand.
    pub axis: DVec3,
    pub radius: f64,
}

/// One sphere of a flake, with all that stands on it.
#[derive(Debug, Clone, Copy)]
struct Branch {
    center: DVec3,
    radius: f64,
    /// Away from the sphere that it stands on.
    direction: DVec3,
    level: u32,
}

/// Directions of the nine in the frame of their sphere: six around the equator, somewhat below it, and three above.
const SIDES: [[f64; 3]; 9] = {
    const HALF_ROOT3: f64 = 0.866_025_403_784_438_6;
    const LOW: f64 = -0.3;
    const HIGH: f64 = 0.7;
    [
        [LOW, 0.0, 1.0],
        [LOW, HALF_ROOT3, 0.5],
        [LOW, HALF_ROOT3, -0.5],
        [LOW, 0.0, -1.0],
        [LOW, -HALF_ROOT3, -0.5],
        [LOW, -HALF_ROOT3, 0.5],
        [HIGH, -0.5, HALF_ROOT3],
        [HIGH, 1.0, 0.0],
        [HIGH, -0.5, -HALF_ROOT3],
    ]
};

/// A flake of level L reaches so many of its radii far: 1 + (3^(L+1) − 3) / 3^(L+1) = 2 − 3^(−L).
fn reach(level: u32) -> f64 {
    2.0 - (0..level).fold(1.0, |power, _| power / 3.0)
}

impl Branch {
    /// What stands on it.
    fn children(&self) -> [Branch; 9] {
        let d = self.direction;
        let squares = d * d;
        let side = if squares.x < squares.y && squares.x < squares.z {
            DVec3::new(0.0, d.z, -d.y)
        } else if squares.y < squares.z {
            DVec3::new(d.z, 0.0, -d.x)
        } else {
            DVec3::new(d.y, -d.x, 0.0)
        };
        let third = d.cross(side.normalize_or(DVec3::X));
        let second = d.cross(third);
        SIDES.map(|[a, b, c]| {
            let direction = (d * a + second * b + third * c).normalize_or(d);
            let center = self.center + direction * (self.radius * 4.0 / 3.0);
            Branch { center, radius: self.radius / 3.0, direction, level: self.level - 1 }
        })
    }

    /// Where the ray enters and leaves a sphere of that radius around the centre.
    fn crossing(&self, radius: f64, ray: &LocalRay, length2: f64) -> Option<[f64; 2]> {
        let offset = self.center - ray.origin;
        let middle = offset.dot(ray.direction) / length2;
        // The point of the ray that is nearest to the centre, rather than a difference of large squares.
        let nearest = offset - ray.direction * middle;
        let rest = radius * radius - nearest.length_squared();
        let half = (rest / length2).sqrt();
        (rest > 0.0).then_some([middle - half, middle + half])
    }

    /// Improves `best` by what the ray meets here and on what stands here.
    fn meet(&self, ray: &mut LocalRay, length2: f64, best: &mut Option<Meeting>) {
        if let Some(t) =
            self.crossing(self.radius, ray, length2).and_then(|ends| ends.into_iter().find(|&t| ray.holds(t)))
        {
            let [u, v] = fold(ray.at(t) - self.center);
            *best = Some(Meeting { t, u, v });
            ray.t_max = t;
        }
        // Spheres that single precision cannot tell from points are left out.
        if self.level == 0 || self.radius < self.center.abs().max_element() * 1e-6 {
            return;
        }
        let mut waiting = [(0.0, 0); 9];
        let mut count = 0;
        let children = self.children();
        let around = children[0].radius * reach(children[0].level) * (1.0 + 1e-9);
        for (index, child) in children.iter().enumerate() {
            let Some([enter, leave]) = child.crossing(around, ray, length2) else { continue };
            if leave > ray.t_min && enter < ray.t_max {
                let at = waiting[..count].partition_point(|&(known, _)| known <= enter);
                waiting.copy_within(at..count, at + 1);
                waiting[at] = (enter, index);
                count += 1;
            }
        }
        for &(enter, index) in &waiting[..count] {
            if enter < ray.t_max {
                children[index].meet(ray, length2, best);
            }
        }
    }
}

/// The deepest level whose spheres are stored.
const STORED: u32 = 7;

impl Flake {
    /// All the spheres, unless there are too many: each level's after those of the one below.
    pub fn spheres(self) -> Option<SphereSet> {
        if self.level > STORED {
            return None;
        }
        let (mut spheres, mut branches) = (Vec::new(), vec![self.root()]);
        while !branches.is_empty() {
            spheres.extend(branches.iter().map(|branch| branch.center.as_vec3().extend(branch.radius as f32)));
            let grow = |branch: &Branch| (branch.level > 0).then(|| branch.children()).into_iter().flatten();
            branches = branches.iter().flat_map(grow).collect();
        }
        Some(SphereSet { spheres, uv: true })
    }

    fn root(&self) -> Branch {
        Branch { center: DVec3::ZERO, radius: self.radius, direction: self.axis, level: self.level }
    }
}

impl Analytic for Flake {
    fn bounds(&self, _: usize) -> Aabb {
        let reach = Vec3::splat((self.radius * reach(self.level)) as f32 * 1.000_001);
        Aabb { min: -reach, max: reach }
    }

    fn meet(&self, _: usize, ray: &LocalRay) -> Option<Meeting> {
        let mut best = None;
        self.root().meet(&mut ray.clone(), ray.direction.length_squared(), &mut best);
        best
    }

    fn surface(&self, part: usize, ray: &LocalRay, meeting: &Meeting) -> (DVec3, DVec3) {
        // The distance was rounded to single precision: the sphere is looked for once more, near there.
        let near = LocalRay { t_min: meeting.t * (1.0 - 1e-6), t_max: meeting.t * (1.0 + 1e-6), ..*ray };
        let meeting = self.meet(part, &near).unwrap_or(*meeting);
        (ray.at(meeting.t), unfold([meeting.u, meeting.v]))
    }

    fn uv(&self, _: usize, uv: [f32; 2], _: Vec3) -> Vec2 {
        sphere_uv(unfold(uv).normalize_or(DVec3::Z).as_vec3())
    }

    fn tangent(&self, _: usize, uv: [f32; 2], _: Vec3) -> Option<Vec3> {
        let outward = unfold(uv).as_vec3();
        Some(Vec3::new(-outward.y, outward.x, 0.0))
    }
}

/// A direction as two numbers from −1 to 1: the octahedron, unfolded onto a square ([Cigolle et al. 2014] "A Survey of Efficient
/// Representations for Independent Unit Vectors").
fn fold(direction: DVec3) -> [f32; 2] {
    let scale = 1.0 / direction.abs().element_sum();
    let (x, y) = (direction.x * scale, direction.y * scale);
    let wrapped = [(1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y)];
    (if direction.z < 0.0 { wrapped } else { [x, y] }).map(|value| value as f32)
}

/// The direction, of any length.
fn unfold([x, y]: [f32; 2]) -> DVec3 {
    let (x, y) = (f64::from(x), f64::from(y));
    let z = 1.0 - x.abs() - y.abs();
    if z < 0.0 { DVec3::new((1.0 - y.abs()).copysign(x), (1.0 - x.abs()).copysign(y), z) } else { DVec3::new(x, y, z) }
}

#[cfg(test)]
mod tests {
    use super::super::tests::rays;
    use super::*;

    const FLAKE: Flake = Flake { level: 2, axis: DVec3::Z, radius: 1.0 };

    fn spheres(branch: Branch, found: &mut Vec<(DVec3, f64)>) {
        found.push((branch.center, branch.radius));
        if branch.level > 0 {
            branch.children().into_iter().for_each(|child| spheres(child, found));
        }
    }

    #[test]
    fn there_are_nine_on_each_and_they_touch_it() {
        let mut found = Vec::new();
        spheres(FLAKE.root(), &mut found);
        assert_eq!(found.len(), 1 + 9 + 81);
        for child in FLAKE.root().children() {
            assert!((child.center.length() - 4.0 / 3.0).abs() < 1e-12 && (child.radius - 1.0 / 3.0).abs() < 1e-15);
        }
        let farthest = found.iter().map(|(center, radius)| center.length() + radius).fold(0.0, f64::max);
        assert!(farthest <= reach(2) + 1e-12, "{farthest}");
        assert!((reach(1) - 5.0 / 3.0).abs() < 1e-15 && reach(0) == 1.0);
    }

    #[test]
    fn rays_meet_the_first_of_all_spheres() {
        let mut all = Vec::new();
        spheres(FLAKE.root(), &mut all);
        let mut met = 0;
        for ray in rays(3000) {
            let length2 = ray.direction.length_squared();
            let first = all
                .iter()
                .filter_map(|&(center, radius)| {
                    let branch = Branch { center, radius, direction: DVec3::Z, level: 0 };
                    let [enter, _] = branch.crossing(radius, &ray, length2)?;
                    Some((enter, center, radius))
                })
                .min_by(|a, b| a.0.total_cmp(&b.0));
            match (FLAKE.meet(0, &ray), first) {
                (Some(meeting), Some((t, center, radius))) => {
                    assert!((meeting.t - t).abs() < 1e-9);
                    let rounded = Meeting { t: f64::from(t as f32), ..meeting };
                    let (point, normal) = FLAKE.surface(0, &ray, &rounded);
                    assert!((point.distance(center) - radius).abs() < 1e-9, "{}", point.distance(center));
                    assert!(normal.normalize().distance((point - center) / radius) < 1e-6);
                    met += 1;
                }
                (None, None) => {}
                other => panic!("{other:?}"),
            }
        }
        assert!(met > 500, "{met}");
    }

    #[test]
    fn the_stored_spheres_are_the_same() {
        let set = FLAKE.spheres().expect("so few");
        let mut all = Vec::new();
        spheres(FLAKE.root(), &mut all);
        assert_eq!(set.spheres.len(), all.len());
        for (center, radius) in all {
            let wanted = center.as_vec3().extend(radius as f32);
            assert!(set.spheres.contains(&wanted), "{wanted}");
        }
        assert!(Flake { level: 8, ..FLAKE }.spheres().is_none());
    }

    #[test]
    fn the_deepest_flake_is_met_too() {
        let deep = Flake { level: 20, ..FLAKE };
        let found = rays(200).filter(|ray| deep.meet(0, ray).is_some()).count();
        assert!(found > 20, "{found}");
    }

    #[test]
    fn directions_survive_folding() {
        for ray in rays(200) {
            let direction = ray.direction.normalize();
            assert!(unfold(fold(direction)).normalize().distance(direction) < 1e-6);
        }
        assert_eq!(unfold(fold(DVec3::NEG_Z)).normalize(), DVec3::NEG_Z);
    }
}
