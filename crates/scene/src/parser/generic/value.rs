//! Parameters: names with values of stated types.

use super::super::Parser;
use super::super::value::shorten;
use crate::description::{Color, Matrix, Name, TransformKind, VertexData};
use crate::diagnostic::Diagnostic;
use crate::source::Span;

/// How the elements of a list belong to a mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Interpolation {
    None,
    Vertex,
    Face,
    FaceVarying,
}

/// A value of one of the types of the format.
#[derive(Debug, Clone)]
pub(super) enum Value {
    String(Name),
    Bool(bool),
    Int(i64),
    Float(f32),
    Color(Color),
    /// A point or a vector.
    Point([f32; 3]),
    Matrix(TransformKind),
    Strings(Vec<Name>),
    Ints(Vec<i64>),
    Floats(Vec<f32>),
    Points(Interpolation, Vec<[f32; 3]>),
    TexCoords(Interpolation, Vec<[f32; 2]>),
}

/// Parameters that wait for what they are for.
#[derive(Debug, Default)]
pub(super) struct Parameters {
    list: Vec<(Name, Value)>,
}

/// Makes the method that takes a parameter of one type.
macro_rules! take {
    ($($(#[$doc:meta])* $method:ident: $variant:ident => $type:ty;)*) => {
        $(
            $(#[$doc])*
            pub fn $method(&mut self, name: &str) -> Option<$type> {
                match self.take(name, |value| matches!(value, Value::$variant(_)))? {
                    (_, Value::$variant(value)) => Some(value),
                    _ => None,
                }
            }
        )*
    };
}

impl Parameters {
    pub fn push(&mut self, name: Name, value: Value) {
        self.list.push((name, value));
    }

    /// Takes the last parameter of that name, if it has the right type.
    fn take(&mut self, name: &str, fits: impl Fn(&Value) -> bool) -> Option<(Span, Value)> {
        let at = self.list.iter().rposition(|(known, value)| known.value == name && fits(value))?;
        let (name, value) = self.list.remove(at);
        Some((name.span, value))
    }

    take! {
        string: String => Name;
        bool: Bool => bool;
        int: Int => i64;
        color: Color => Color;
        point: Point => [f32; 3];
        matrix: Matrix => TransformKind;
        strings: Strings => Vec<Name>;
        ints: Ints => Vec<i64>;
        floats: Floats => Vec<f32>;
    }

    /// A number, also where a whole one was written.
    pub fn float(&mut self, name: &str) -> Option<f32> {
        match self.take(name, |value| matches!(value, Value::Float(_) | Value::Int(_)))?.1 {
            Value::Float(value) => Some(value),
            Value::Int(value) => Some(value as f32),
            _ => None,
        }
    }

    /// A whole number within its limits.
    pub fn whole(&mut self, name: &str, min: u32, max: u32) -> Option<u32> {
        self.int(name).map(|value| value.clamp(i64::from(min), i64::from(max)) as u32)
    }

    pub fn points(&mut self, name: &str) -> Option<Vec<[f32; 3]>> {
        self.varying_points(name).map(|(_, points)| points)
    }

    pub fn varying_points(&mut self, name: &str) -> Option<(Interpolation, Vec<[f32; 3]>)> {
        match self.take(name, |value| matches!(value, Value::Points(..)))?.1 {
            Value::Points(interpolation, points) => Some((interpolation, points)),
            _ => None,
        }
    }

    pub fn varying_texcoords(&mut self, name: &str) -> Option<(Interpolation, Vec<[f32; 2]>)> {
        match self.take(name, |value| matches!(value, Value::TexCoords(..)))?.1 {
            Value::TexCoords(interpolation, values) => Some((interpolation, values)),
            _ => None,
        }
    }

    /// Whole numbers from 0, three by three.
    pub fn triangles(&mut self, name: &str) -> Option<Vec<[u32; 3]>> {
        let index = |value: i64| u32::try_from(value).unwrap_or(u32::MAX);
        Some(self.ints(name)?.as_chunks::<3>().0.iter().map(|triple| triple.map(index)).collect())
    }

    /// A transform that may move: `transform`, or `transform.steps`, `.times` and one matrix for each step.
    pub fn transform(&mut self) -> Option<TransformKind> {
        let Some(steps) = self.int("transform.steps") else { return self.matrix("transform") };
        let times = self.floats("transform.times").unwrap_or_default();
        let matrices: Vec<TransformKind> = (0..steps.clamp(0, self.list.len() as i64))
            .filter_map(|i| self.matrix(&format!("transform[{i}]")))
            .collect();
        match (matrices.is_empty(), times.as_slice()) {
            (true, _) => None,
            (false, [first, .., last]) => Some(TransformKind::Steps { times: [*first, *last], steps: matrices }),
            (false, _) => matrices.into_iter().next(),
        }
    }

    /// Names what nobody has taken.
    pub fn report(self, parser: &mut Parser<'_>) {
        for (name, _) in self.list {
            let message = format!("nothing takes the parameter `{}` here", shorten(&name.value));
            parser.diagnostics.push(Diagnostic::warning(name.span, message));
        }
    }
}

/// Data of a mesh; a list of the wrong length is none.
pub(super) fn vertex_data<T>(data: Option<(Interpolation, Vec<T>)>, points: usize, triangles: usize) -> VertexData<T> {
    match data {
        Some((Interpolation::Vertex, values)) if values.len() == points => VertexData::Vertex(values),
        Some((Interpolation::FaceVarying, values)) if values.len() == 3 * triangles => VertexData::FaceVarying(values),
        _ => VertexData::None,
    }
}

/// A matrix by its rows, if its last one is that of an affine map and all numbers are finite.
pub(super) fn affine(numbers: [f32; 16]) -> Option<TransformKind> {
    let matrix: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| f64::from(numbers[4 * row + column])));
    let fits = matrix[3] == [0.0, 0.0, 0.0, 1.0] && matrix.iter().flatten().all(|number| number.is_finite());
    fits.then_some(TransformKind::Matrix(matrix))
}
