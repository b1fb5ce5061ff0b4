//! Reads transforms (format reference, §1.8).

use super::loose::Loose;
use super::value::unknown_word;
use super::{Context, Failed, Parsed, Parser};
use crate::description::{Matrix, Op, Transform, TransformKind};
use crate::diagnostic::Diagnostic;
use crate::lexer::Token;
use crate::source::Spanned;

struct Operation {
    name: &'static str,
    example: &'static str,
    read: fn(&mut Parser<'_>) -> Parsed<Op>,
}

const fn operation(name: &'static str, example: &'static str, read: fn(&mut Parser<'_>) -> Parsed<Op>) -> Operation {
    Operation { name, example, read }
}

const OPERATIONS: &[Operation] = &[
    operation("translate", "translate 0 0 1", |p| Ok(Op::Translate(p.numbers()?))),
    operation("scale", "scale 1 1 2", |p| Ok(Op::Scale(p.numbers()?))),
    operation("scaleu", "scaleu 2", |p| Ok(Op::ScaleU(p.number()?))),
    operation("rotatex", "rotatex 90", |p| Ok(Op::RotateX(p.number()?))),
    operation("rotatey", "rotatey 90", |p| Ok(Op::RotateY(p.number()?))),
    operation("rotatez", "rotatez 90", |p| Ok(Op::RotateZ(p.number()?))),
    operation("rotate", "rotate 0 0 1 90", rotate),
    operation("scalex", "scalex 2", |p| Ok(Op::ScaleX(p.number()?))),
    operation("scaley", "scaley 2", |p| Ok(Op::ScaleY(p.number()?))),
    operation("scalez", "scalez 2", |p| Ok(Op::ScaleZ(p.number()?))),
];

fn rotate(parser: &mut Parser<'_>) -> Parsed<Op> {
    let axis = parser.spanned(Parser::numbers::<f64, 3>)?;
    if axis.value == [0.0; 3] {
        parser.failed_at = axis.span.start;
        let diagnostic = Diagnostic::error(axis.span, "`rotate` expects an axis other than `0 0 0`");
        parser.diagnostics.push(diagnostic.hint("for example `rotate 0 0 1 90`"));
        return Err(Failed);
    }
    Ok(Op::Rotate { axis: axis.value, angle: parser.number()? })
}

impl Parser<'_> {
    /// The value of the keyword `transform`.
    pub(super) fn transform(&mut self) -> Parsed<Transform> {
        let kind = self.spanned(|parser| match parser.take("steps") {
            Some(_) => parser.steps(Self::still_transform),
            None => parser.still_transform(),
        })?;
        Ok(Transform { kind: kind.value, span: kind.span })
    }

    /// `N times t0 t1` and N things that `read` turns into transforms.
    pub(super) fn steps(&mut self, read: fn(&mut Self) -> Parsed<TransformKind>) -> Parsed<TransformKind> {
        let context = self.context;
        let before = self.peek();
        let count = self.int()?;
        if count < 1 {
            return Err(self.expected("at least one step", before));
        }
        if self.take("times").is_none() {
            let found = self.peek();
            return Err(self.expected("`times` after the number of steps", found));
        }
        let times = self.numbers()?;
        let mut steps = Vec::new();
        for _ in 0..count {
            self.context = context;
            steps.push(read(self)?);
        }
        Ok(TransformKind::Steps { times, steps })
    }

    /// A transform that does not move.
    pub(super) fn still_transform(&mut self) -> Parsed<TransformKind> {
        match self.next() {
            Some(token) if self.is(token, "row") => self.matrix(|m, row, column| m[4 * row + column]),
            Some(token) if self.is(token, "col") => self.matrix(|m, row, column| m[4 * column + row]),
            Some(token) if self.is(token, "{") => self.operations().map(TransformKind::Ops),
            found => Err(self.expected("`{`, `row`, `col` or `steps`", found)),
        }
    }

    fn matrix(&mut self, entry: fn(&[f64; 16], usize, usize) -> f64) -> Parsed<TransformKind> {
        let Spanned { value: numbers, span } = self.spanned(Parser::numbers::<f64, 16>)?;
        let matrix: Matrix = std::array::from_fn(|row| std::array::from_fn(|column| entry(&numbers, row, column)));
        if matrix[3] != [0.0, 0.0, 0.0, 1.0] {
            let message = "the last row of a transform must be 0 0 0 1";
            let hint = "`row` lists the matrix row by row, `col` column by column";
            self.failed_at = span.end;
            self.diagnostics.push(Diagnostic::error(span, message).hint(hint));
            return Err(Failed);
        }
        Ok(TransformKind::Matrix(matrix))
    }

    fn operations(&mut self) -> Parsed<Vec<Op>> {
        let context = self.context;
        let mut operations = Vec::new();
        loop {
            self.context = context;
            match self.next() {
                Some(token) if self.is(token, "}") => return Ok(operations),
                Some(token) => operations.push(self.operation(token)?),
                None => return Err(self.expected("`}` after its operations", None)),
            }
        }
    }

    fn operation(&mut self, token: Token) -> Parsed<Op> {
        let span = self.span(token);
        let Some(operation) = OPERATIONS.iter().find(|operation| self.is(token, operation.name)) else {
            let word = Spanned::new(self.text(token), span);
            let names = OPERATIONS.iter().map(|operation| operation.name);
            let diagnostic = unknown_word("transform operation", &word, names);
            return Err(self.fail(Some(token), diagnostic));
        };
        self.context = Context { name: operation.name, example: operation.example };
        let op = (operation.read)(self)?;
        if matches!(op, Op::ScaleX(_) | Op::ScaleY(_) | Op::ScaleZ(_)) {
            self.loose(Loose::AxisScale, span);
        }
        Ok(op)
    }
}
