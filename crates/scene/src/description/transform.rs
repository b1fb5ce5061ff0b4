//! Transforms, as written: the order of the operations still matters to one dialect.

use crate::source::Span;

/// A row-major 4 × 4 matrix acting on column vectors; the last row is 0 0 0 1.
pub type Matrix = [[f64; 4]; 4];

/// A transform and where it was written.
#[derive(Debug, Clone)]
pub struct Transform {
    /// What it does.
    pub kind: TransformKind,
    /// Where it was written.
    pub span: Span,
}

/// The forms of a transform (format reference, §1.8).
#[derive(Debug, Clone, PartialEq)]
pub enum TransformKind {
    /// `{ op … }`: the first listed acts first on a point.
    Ops(Vec<Op>),
    /// `row` or `col`.
    Matrix(Matrix),
    /// `steps N times t0 t1 …`: evenly spaced over the times, blended element by element.
    Steps {
        /// First and last time.
        times: [f32; 2],
        /// At least one transform, none of them `Steps`.
        steps: Vec<TransformKind>,
    },
}

/// One operation of a transform; angles in degrees.
#[derive(Debug, Clone, Copy, PartialEq)]
#[allow(missing_docs, reason = "the names are the format's own words")]
pub enum Op {
    Translate([f64; 3]),
    Scale([f64; 3]),
    ScaleX(f64),
    ScaleY(f64),
    ScaleZ(f64),
    ScaleU(f64),
    RotateX(f64),
    RotateY(f64),
    RotateZ(f64),
    Rotate { axis: [f64; 3], angle: f64 },
}
