//! Sunflow's cameras: a raster position and a lens sample become a ray.

use glam::{DMat4, DVec3, Vec3};
use jaspe_scene::description::{Camera as Description, Lens, View};

use crate::affine::Affine;
use crate::math;
use crate::motion::{Motion, Shutter};

/// A camera ready to send rays.
#[derive(Debug, Clone)]
pub(crate) struct Camera {
    world_from_camera: Affine,
    /// Where the camera is at each time, if it moves while the shutter is open.
    moving: Option<Box<(Motion, Shutter)>>,
    lens: Lens,
    /// Half the image plane's width and height, at distance 1 or at the focal distance.
    half: [f32; 2],
    size: [f32; 2],
    /// Where the lens polygon's corners are, for lenses of three sides and more.
    corners: Vec<[f32; 2]>,
}

impl Camera {
    /// `size` in pixels.
    pub fn new(description: &Description, size: [u32; 2]) -> Camera {
        let (motion, shutter) = (view_motion(&description.view), Shutter::of(Some(description)));
        let world_from_camera = motion.at(shutter.middle()).into();
        let moving = (shutter.has_duration() && !motion.is_still()).then(|| Box::new((motion, shutter)));
        let half = |fov: f32, aspect: f32, distance: f32| {
            let width = (math::tan_degrees(f64::from(fov) * 0.5) * f64::from(distance)) as f32;
            [width, width / aspect]
        };
        let (half, corners) = match description.lens {
            Lens::Pinhole { fov, aspect, .. } => (half(fov, aspect, 1.0), Vec::new()),
            Lens::Thinlens { fov, aspect, fdist, sides, rotation, .. } => {
                let corner = |i: u32| {
                    let (sin, cos) =
                        math::sin_cos_degrees(360.0 * f64::from(i) / f64::from(sides) + f64::from(rotation));
                    [cos as f32, sin as f32]
                };
                let corners = if sides >= 3 { (0..=sides).map(corner).collect() } else { Vec::new() };
                (half(fov, aspect, fdist), corners)
            }
            Lens::Spherical | Lens::Fisheye => ([1.0; 2], Vec::new()),
        };
        let size = size.map(|s| s as f32);
        Camera { world_from_camera, moving, lens: description.lens, half, size, corners }
    }

    /// Whether rays need a lens sample.
    pub fn has_aperture(&self) -> bool {
        matches!(self.lens, Lens::Thinlens { lensr, .. } if lensr > 0.0)
    }

    /// The angle of a pixel in the middle of the picture.
    pub fn spread(&self) -> f32 {
        let [width, _] = self.size;
        match self.lens {
            Lens::Pinhole { .. } => 2.0 * self.half[0] / width,
            Lens::Thinlens { fdist, .. } => 2.0 * self.half[0] / (width * fdist),
            Lens::Spherical => std::f32::consts::TAU / width,
            Lens::Fisheye => std::f32::consts::PI / width,
        }
    }

    /// Whether rays need a time sample.
    pub fn is_moving(&self) -> bool {
        self.moving.is_some()
    }

    /// Origin and unit direction of the ray through a raster position, in pixels from the top left; `None` where the
    /// lens sees nothing (format reference, §3.2). `time` goes from 0 to 1.
    pub fn ray(&self, x: f32, y: f32, lens: [f32; 2], time: f32) -> Option<(Vec3, Vec3)> {
        let [width, height] = self.size;
        let y = height - y;
        // Sunflow: the divisors are one less than the size, which moves the axis half a pixel to the left and down.
        let plane = |shift: [f32; 2], scale: f32| {
            let axis = |k: usize, at: f32, size: f32| {
                let span = if size > 1.0 { size - 1.0 } else { 1.0 };
                shift[k] * scale - self.half[k] + 2.0 * self.half[k] * at / span
            };
            [axis(0, x, width), axis(1, y, height)]
        };
        let (origin, direction) = match self.lens {
            Lens::Pinhole { shift, .. } => {
                let [px, py] = plane(shift, 1.0);
                (Vec3::ZERO, Vec3::new(px, py, -1.0))
            }
            Lens::Thinlens { shift, fdist, lensr, .. } => {
                let [px, py] = plane(shift, fdist);
                let [ex, ey] = self.lens_point(lens);
                let eye = Vec3::new(ex * lensr, ey * lensr, 0.0);
                (eye, Vec3::new(px, py, -fdist) - eye)
            }
            Lens::Spherical => {
                let (sin_t, cos_t) = math::sin_cos_degrees(f64::from(360.0 * x / width) + 90.0);
                let (sin_p, cos_p) = math::sin_cos_degrees(f64::from(180.0 * (height - 1.0 - y) / height));
                (Vec3::ZERO, DVec3::new(cos_t * sin_p, cos_p, sin_t * sin_p).as_vec3())
            }
            Lens::Fisheye => {
                let (cx, cy) = (2.0 * x / width - 1.0, 2.0 * y / height - 1.0);
                let rest = 1.0 - cx * cx - cy * cy;
                if rest < 0.0 {
                    return None;
                }
                (Vec3::ZERO, Vec3::new(cx, cy, -rest.sqrt()))
            }
        };
        let world_from_camera = match &self.moving {
            Some(moving) => moving.0.at(moving.1.moment(f64::from(time))).into(),
            None => self.world_from_camera,
        };
        let direction = world_from_camera.vector(direction).normalize_or_zero();
        (direction != Vec3::ZERO).then(|| (world_from_camera.point(origin), direction))
    }

    /// A point of the unit lens: the concentric map of the square to the disk ([Shirley, Chiu 1997] "A Low Distortion
    /// Map Between Disk and Square"), or a point of the polygon.
    fn lens_point(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        if let [_, .., _] = self.corners[..] {
            let sides = (self.corners.len() - 1) as f32;
            let side = (v * sides).min(sides - 1.0).floor();
            let along = v * sides - side;
            let ([ax, ay], [bx, by]) = (self.corners[side as usize], self.corners[side as usize + 1]);
            let reach = u.sqrt();
            return [reach * (ax + (bx - ax) * along), reach * (ay + (by - ay) * along)];
        }
        let (a, b) = (2.0 * u - 1.0, 2.0 * v - 1.0);
        if a == 0.0 && b == 0.0 {
            return [0.0; 2];
        }
        let (radius, degrees) = if a.abs() > b.abs() { (a, 45.0 * b / a) } else { (b, 90.0 - 45.0 * a / b) };
        let (sin, cos) = math::sin_cos_degrees(f64::from(degrees));
        [radius * cos as f32, radius * sin as f32]
    }
}

/// Camera space (down −Z, +X right, +Y up) to world.
fn view_motion(view: &View) -> Motion {
    match view {
        View::Transform(transform) => Motion::new(&transform.kind),
        View::LookAt { eye, target, up } => {
            let vec = |v: &[f32; 3]| Vec3::from_array(*v).as_dvec3();
            let (eye, target, up) = (vec(eye), vec(target), vec(up));
            let w = (eye - target).normalize_or(DVec3::Z);
            // Any direction will do for an `up` along the view, as long as it is always the same.
            let fallback = if w.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
            let u = up.cross(w).try_normalize().unwrap_or_else(|| fallback.cross(w).normalize());
            let v = w.cross(u);
            Motion::still(DMat4::from_cols(u.extend(0.0), v.extend(0.0), w.extend(0.0), eye.extend(1.0)))
        }
    }
}
