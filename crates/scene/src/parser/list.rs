//! Reads lists of numbers.
//!
//! They are read as far as the numbers go and compared with what was announced afterwards: a wrong count is one
//! message instead of hundreds, and a count of two thousand million reserves no more than the file can hold.

use super::{Failed, Parsed, Parser};
use crate::diagnostic::Diagnostic;
use crate::lexer::{Lexer, Token};
use crate::number;
use crate::source::Span;

/// Numbers and where they were written.
#[derive(Debug)]
pub(super) struct List<T> {
    pub values: Vec<T>,
    /// Numbers that are left over at the end.
    pub rest: usize,
    /// The cursor before the first number.
    pub start: Lexer,
    /// The keyword.
    pub key: Span,
}

/// What the numbers of a list are read with, and what they must be.
pub(super) trait Number: Copy + Default {
    const WHAT: &'static str;
    fn is_usable(self) -> bool;
}

impl Number for f32 {
    const WHAT: &'static str = "finite numbers";

    fn is_usable(self) -> bool {
        self.is_finite()
    }
}

impl Number for u32 {
    const WHAT: &'static str = "indices from 0";

    fn is_usable(self) -> bool {
        true
    }
}

impl Parser<'_> {
    /// `count` points, as many as were announced.
    pub(super) fn point_list(&mut self, key: Span, count: usize) -> Parsed<Vec<[f32; 3]>> {
        let list = self.list(key, count, number::float::<f32>)?;
        self.check_count(&list, count)?;
        Ok(list.values)
    }

    /// As many points as there are.
    pub(super) fn any_points(&mut self, key: Span) -> Parsed<Vec<[f32; 3]>> {
        let list = self.list::<f32, 3>(key, 16, number::float::<f32>)?;
        let whole = 3 * list.values.len();
        if list.rest > 0 { Err(self.wrong_count(&list, whole, whole + list.rest)) } else { Ok(list.values) }
    }

    /// `count` numbers, three of which make a point.
    pub(super) fn flat_point_list(&mut self, key: Span, count: usize) -> Parsed<Vec<[f32; 3]>> {
        let list = self.list::<f32, 3>(key, count / 3, number::float::<f32>)?;
        let found = list.values.len() * 3 + list.rest;
        if found != count {
            return Err(self.wrong_count(&list, count, found));
        }
        Ok(list.values)
    }

    /// The announced length of a list.
    pub(super) fn count(&mut self) -> Parsed<usize> {
        let before = self.peek();
        match usize::try_from(self.int()?) {
            Ok(count) => Ok(count),
            Err(_) => Err(self.expected("the length of the list", before)),
        }
    }

    /// As many numbers as there are; room is made for as many tuples as are expected.
    pub(super) fn list<T: Number, const N: usize>(
        &mut self,
        key: Span,
        expected: usize,
        read: fn(&[u8]) -> Option<T>,
    ) -> Parsed<List<[T; N]>> {
        let bytes = self.bytes.clone();
        let start = self.lexer;
        // Each number takes two bytes at least.
        let mut values: Vec<[T; N]> = Vec::with_capacity(expected.min(start.remaining(&bytes) / (2 * N) + 1));
        let mut lexer = start;
        let mut unusable = 0_usize;
        let (end, rest) = 'tuples: loop {
            let mut tuple = [T::default(); N];
            for (i, slot) in tuple.iter_mut().enumerate() {
                let before = lexer;
                match lexer.next(&bytes).and_then(|token| read(token.bytes(&bytes))) {
                    Some(value) => *slot = value,
                    None => break 'tuples (before, i),
                }
                unusable += usize::from(!slot.is_usable());
            }
            values.push(tuple);
        };
        self.lexer = end;
        values.shrink_to_fit();
        self.check_list_end::<T>()?;
        if unusable > 0 {
            return Err(self.unusable(start, unusable));
        }
        Ok(List { values, rest, start, key })
    }

    /// A list ends at a keyword or a brace; anything that looks like a number is one gone wrong.
    fn check_list_end<T: Number>(&mut self) -> Parsed<()> {
        let end = self.peek();
        let bytes = end.map(|token| token.bytes(&self.bytes)).unwrap_or_default();
        let numeric = matches!(bytes, [b'0'..=b'9' | b'+' | b'.', ..] | [b'-', b'0'..=b'9' | b'.', ..]);
        if numeric || self.holds_glued(end) {
            return Err(self.expected(T::WHAT, end));
        }
        Ok(())
    }

    fn holds_glued(&self, token: Option<Token>) -> bool {
        token.is_some_and(|token| self.holds_glued_brace(token))
    }

    /// Reports the first of `count` numbers from `start` that are not finite.
    fn unusable(&mut self, start: Lexer, count: usize) -> Failed {
        let mut lexer = start;
        let bytes = self.bytes.clone();
        let infinite = |token: &Token| number::float::<f32>(token.bytes(&bytes)).is_some_and(|v| !v.is_finite());
        let first = std::iter::from_fn(|| lexer.next(&bytes)).find(infinite);
        let shown = first.map(|token| self.shown(token)).unwrap_or_default();
        let more = if count > 1 { format!(" (and {} more)", count - 1) } else { String::new() };
        let message = format!("`{}` expects finite numbers, found `{shown}`{more}", self.context.name);
        self.failed_at = self.lexer.position() as u32;
        let span = first.map(|token| self.span(token));
        self.diagnostics.push(Diagnostic::error(span, message));
        Failed
    }

    /// Compares a list with the number of tuples that was announced.
    pub(super) fn check_count<T: Number, const N: usize>(&mut self, list: &List<[T; N]>, count: usize) -> Parsed<()> {
        match (list.values.len() == count, list.rest) {
            (true, 0) => Ok(()),
            _ => Err(self.wrong_count(list, count.saturating_mul(N), list.values.len() * N + list.rest)),
        }
    }

    fn wrong_count<T>(&mut self, list: &List<T>, expected: usize, found: usize) -> Failed {
        let name = self.context.name;
        let message = format!("`{name}` needs {expected} numbers, found {found}");
        let mut diagnostic = Diagnostic::error(list.key, message);
        if found > expected {
            let surplus = self.nth_number(list.start, expected);
            diagnostic = match surplus {
                Some(span) => diagnostic.label(span, "one too many"),
                None => diagnostic,
            };
        } else if let Some(end) = self.peek() {
            diagnostic = diagnostic.label(self.span(end), "the list ends here");
        }
        self.failed_at = self.lexer.position() as u32;
        self.diagnostics.push(diagnostic);
        Failed
    }

    /// Where the number of that index stands in a list; other words in between are passed.
    pub(super) fn nth_number(&self, mut lexer: Lexer, index: usize) -> Option<Span> {
        let is_number = |token: &Token| number::float::<f32>(token.bytes(&self.bytes)).is_some();
        let token = std::iter::from_fn(|| lexer.next(&self.bytes)).filter(is_number).nth(index)?;
        Some(self.span(token))
    }
}
