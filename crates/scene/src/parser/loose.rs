//! The looser syntax of the 2010 program: read, with one warning for each kind in each file.

use super::Parser;
use crate::diagnostic::Diagnostic;
use crate::source::Span;

/// What Sunflow's own parser would refuse.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Loose {
    NameBeforeType,
    HeadAfterType,
    MeshWithoutNormals,
    MeshWithoutUvs,
    NumberAfterAbsorption,
    PlacelessSphere,
    StrayBrace,
    AxisScale,
}

impl Loose {
    fn message(self) -> &'static str {
        match self {
            Loose::NameBeforeType => "`name` stands before `type`, where Sunflow does not look for it",
            Loose::HeadAfterType => "`shader`, `modifier` and `transform` belong before `type`",
            Loose::MeshWithoutNormals => "the mesh does not say which `normals` it has",
            Loose::MeshWithoutUvs => "the mesh does not say which `uvs` it has",
            Loose::NumberAfterAbsorption => "the number after the absorption colour is ignored",
            Loose::PlacelessSphere => "a sphere without `c`, `r` and `transform` is the unit sphere at the origin",
            Loose::StrayBrace => "this `}` closes nothing",
            Loose::AxisScale => "`scalex`, `scaley` and `scalez` are unknown to Sunflow",
        }
    }

    fn hint(self) -> &'static str {
        match self {
            Loose::NameBeforeType => "write `name` after `type` to be read by Sunflow too",
            Loose::HeadAfterType => "write them before `type` to be read by Sunflow too",
            Loose::MeshWithoutNormals => "add `normals none`",
            Loose::MeshWithoutUvs => "add `uvs none`",
            Loose::NumberAfterAbsorption | Loose::StrayBrace => "remove it",
            Loose::PlacelessSphere => "add `c 0 0 0 r 1`",
            Loose::AxisScale => "write `scale x y z`",
        }
    }
}

/// First place and number of places of each kind in the current file.
#[derive(Debug, Default)]
pub(super) struct Found(Vec<(Loose, Span, usize)>);

impl Parser<'_> {
    /// Notes that `kind` occurs at `span`.
    pub(super) fn loose(&mut self, kind: Loose, span: Span) {
        match self.loose.0.iter_mut().find(|(known, ..)| *known == kind) {
            Some((.., count)) => *count += 1,
            None => self.loose.0.push((kind, span, 1)),
        }
    }

    /// Warns of everything noted in the file that ends here.
    pub(super) fn report_loose(&mut self, found: Found) {
        for (kind, span, count) in found.0 {
            let message = match count {
                1 => kind.message().to_owned(),
                2 => format!("{} (here and in another place)", kind.message()),
                _ => format!("{} (here and in {} more places)", kind.message(), count - 1),
            };
            self.diagnostics.push(Diagnostic::warning(span, message).hint(kind.hint()));
        }
    }
}
