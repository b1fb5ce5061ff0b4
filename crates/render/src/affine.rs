//! Affine maps between spaces. `b_from_a.point(p)` takes a point of space a to space b.

use glam::{DMat3, DMat4, Vec3};
use jaspe_scene::description::{Matrix, Op, TransformKind};

/// An affine map in single precision, for the renderer's inner loops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Affine {
    /// Images of the axes.
    columns: [Vec3; 3],
    translation: Vec3,
}

impl Affine {
    #[inline(always)]
    pub fn vector(&self, v: Vec3) -> Vec3 {
        self.columns[0] * v.x + self.columns[1] * v.y + self.columns[2] * v.z
    }

    #[inline(always)]
    pub fn point(&self, p: Vec3) -> Vec3 {
        self.vector(p) + self.translation
    }

    /// How much longer it makes vectors, on average over the axes.
    pub fn scale(&self) -> f32 {
        self.columns.iter().map(|column| column.length()).sum::<f32>() * (1.0 / 3.0)
    }

    /// Applies the transpose of the linear part: takes normals back when `self` is the inverse map.
    #[inline(always)]
    pub fn transposed(&self, n: Vec3) -> Vec3 {
        Vec3::new(self.columns[0].dot(n), self.columns[1].dot(n), self.columns[2].dot(n))
    }

    /// Applies the inverse of the transpose: takes normals along with the surface.
    pub fn normal(&self, n: Vec3) -> Vec3 {
        let [x, y, z] = self.columns;
        let yz = y.cross(z);
        (yz * n.x + z.cross(x) * n.y + x.cross(y) * n.z) / x.dot(yz)
    }
}

impl From<DMat4> for Affine {
    fn from(m: DMat4) -> Self {
        let column = |i: usize| m.col(i).truncate().as_vec3();
        Affine { columns: [column(0), column(1), column(2)], translation: column(3) }
    }
}

/// The matrix of a transform as written; of a moving one, its first step ([`crate::motion`] knows the others).
pub(crate) fn matrix(kind: &TransformKind) -> DMat4 {
    match kind {
        TransformKind::Ops(ops) => ops.iter().fold(DMat4::IDENTITY, |m, op| op_matrix(op) * m),
        TransformKind::Matrix(rows) => from_rows(rows),
        TransformKind::Steps { steps, .. } => steps.first().map_or(DMat4::IDENTITY, matrix),
    }
}

/// Takes the unit sphere to a sphere.
pub(crate) fn ball(center: [f32; 3], radius: f32) -> DMat4 {
    op_matrix(&Op::Translate(center.map(f64::from))) * op_matrix(&Op::ScaleU(f64::from(radius)))
}

fn from_rows(rows: &Matrix) -> DMat4 {
    DMat4::from_cols_array_2d(rows).transpose()
}

/// The matrix of one operation. Angles are degrees, right-handed about their axis.
pub(crate) fn op_matrix(op: &Op) -> DMat4 {
    let linear = |m: DMat3| DMat4::from_mat3(m);
    let scale = |x, y, z| linear(DMat3::from_diagonal(glam::DVec3::new(x, y, z)));
    match *op {
        Op::Translate(t) => DMat4::from_translation(t.into()),
        Op::Scale([x, y, z]) => scale(x, y, z),
        Op::ScaleX(s) => scale(s, 1.0, 1.0),
        Op::ScaleY(s) => scale(1.0, s, 1.0),
        Op::ScaleZ(s) => scale(1.0, 1.0, s),
        Op::ScaleU(s) => scale(s, s, s),
        Op::RotateX(angle) => linear(rotation(glam::DVec3::X, angle)),
        Op::RotateY(angle) => linear(rotation(glam::DVec3::Y, angle)),
        Op::RotateZ(angle) => linear(rotation(glam::DVec3::Z, angle)),
        Op::Rotate { axis, angle } => linear(rotation(glam::DVec3::from(axis).normalize_or(glam::DVec3::Z), angle)),
    }
}

/// Rodrigues' formula, with this project's own sine and cosine so that every platform agrees.
fn rotation(axis: glam::DVec3, degrees: f64) -> DMat3 {
    let (sin, cos) = crate::math::sin_cos_degrees(degrees);
    let cross = DMat3::from_cols(
        glam::DVec3::new(0.0, axis.z, -axis.y),
        glam::DVec3::new(-axis.z, 0.0, axis.x),
        glam::DVec3::new(axis.y, -axis.x, 0.0),
    );
    DMat3::IDENTITY + cross * sin + cross * cross * (1.0 - cos)
}

/// The inverse, unless the linear part is (nearly) singular, as Sunflow judges it: |det| below 1e-12.
pub(crate) fn inverse(m: DMat4) -> Option<DMat4> {
    let determinant = DMat3::from_mat4(m).determinant();
    (m.is_finite() && determinant.abs() >= 1e-12).then(|| m.inverse())
}

/// The factor of a similarity (rotation, reflection and one uniform scale), `None` for every other map.
pub(crate) fn similarity_scale(m: DMat4) -> Option<f64> {
    let linear = DMat3::from_mat4(m);
    let gram = linear.transpose() * linear;
    let scale2 = gram.x_axis.x;
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-9 * scale2;
    let diagonal = close(gram.y_axis.y, scale2) && close(gram.z_axis.z, scale2);
    let off = [gram.x_axis.y, gram.x_axis.z, gram.y_axis.z].iter().all(|&v| close(v, 0.0));
    (diagonal && off && scale2 > 0.0).then(|| scale2.sqrt())
}
