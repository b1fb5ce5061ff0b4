//! Reads the blocks `object` and `instance`.

use super::block::{Grammar, Key, Outcome, Reader, Required};
use super::loose::Loose;
use super::mesh::{self, MeshDraft};
use super::shader::java;
use super::shape::{self, ShapeDraft};
use super::value::unknown_word;
use super::{Namespace, Parsed, Parser};
use crate::description::{Geometry, Instance, Name, Object, Plane, Transform};
use crate::diagnostic::Diagnostic;
use crate::lexer::Token;
use crate::source::Span;

/// The keywords of an object as far as they were written.
#[derive(Default)]
pub(super) struct Draft {
    name: Option<Name>,
    has_type: bool,
    hidden: bool,
    pub shaders: Vec<Name>,
    modifiers: Vec<Name>,
    transform: Option<Transform>,
    center: Option<[f32; 3]>,
    radius: Option<f32>,
    points: Vec<[f32; 3]>,
    normal: Option<[f32; 3]>,
    corners: Option<[[f32; 3]; 2]>,
    pub mesh: MeshDraft,
    pub shape: ShapeDraft,
}

/// A shape: its own keywords beside those of every object, and what they mean.
pub(super) struct ObjectType {
    pub name: &'static str,
    pub keys: &'static [Key<Draft>],
    pub bare: Option<Reader<Draft>>,
    pub build: fn(&mut Parser<'_>, &mut Draft, &Outcome, Span) -> Option<Geometry>,
}

const HEAD: [Key<Draft>; 9] = [
    Key::new("type", "type sphere", |p, d, _| {
        d.has_type = true;
        p.word("an object type").map(drop)
    }),
    Key::new("name", "name ball", |p, d, span| {
        if !d.has_type {
            p.loose(Loose::NameBeforeType, span);
        }
        d.name = Some(p.word("a name")?);
        Ok(())
    }),
    Key::new("noinstance", "noinstance", |_, d, _| {
        d.hidden = true;
        Ok(())
    }),
    Key::new("shader", "shader red", |p, d, span| {
        d.head(p, span);
        d.shaders = vec![p.word("the name of a shader")?];
        Ok(())
    }),
    Key::new("shaders", "shaders 2 red blue", |p, d, span| {
        d.head(p, span);
        d.shaders = p.names("the name of a shader")?;
        Ok(())
    }),
    Key::new("modifier", "modifier bumps", |p, d, span| {
        d.head(p, span);
        d.modifiers = vec![p.word("the name of a modifier")?];
        Ok(())
    }),
    Key::new("modifiers", "modifiers 2 bumps None", |p, d, span| {
        d.head(p, span);
        d.modifiers = p.names("the name of a modifier")?;
        Ok(())
    }),
    Key::new("transform", "transform { translate 0 0 1 }", |p, d, span| {
        d.head(p, span);
        d.transform = Some(p.transform()?);
        Ok(())
    }),
    Key::new("accel", "accel bih", |p, _, _| p.word("the name of an acceleration structure").map(drop)),
];

const PLAIN: &[ObjectType] = &[
    ObjectType {
        name: "sphere",
        keys: &[
            Key::new("c", "c 0 0 0", |p, d, _| {
                d.center = Some(p.numbers()?);
                Ok(())
            }),
            Key::new("r", "r 1", |p, d, _| {
                d.radius = Some(p.positive("`r`")?);
                Ok(())
            }),
        ],
        bare: None,
        build: sphere,
    },
    ObjectType {
        name: "plane",
        keys: &[
            Key::many("p", "p 0 0 0", |p, d, _| {
                d.points.push(p.numbers()?);
                Ok(())
            }),
            Key::new("n", "n 0 1 0", |p, d, _| {
                d.normal = Some(p.numbers()?);
                Ok(())
            }),
        ],
        bare: None,
        build: plane,
    },
    ObjectType {
        name: "box",
        keys: &[Key::new("points", "points 2 -1 -1 -1 1 1 1", box_corners)],
        bare: None,
        build: |_, d, _, _| Some(Geometry::Box { corners: d.corners.unwrap_or([[-0.5; 3], [0.5; 3]]) }),
    },
    ObjectType { name: "generic-mesh", keys: mesh::KEYS, bare: None, build: mesh::generic },
    ObjectType { name: "mesh", keys: &[], bare: Some(legacy_mesh), build: mesh::smooth },
    ObjectType { name: "flat-mesh", keys: &[], bare: Some(legacy_mesh), build: mesh::flat },
];

fn legacy_mesh(parser: &mut Parser<'_>, draft: &mut Draft, key: Span) -> Parsed<()> {
    parser.legacy_lists(&mut draft.mesh, key)
}

/// The object that is written in Java.
const JAVA: &str = "janino-tesselatable";

/// All types of objects.
fn types() -> impl Iterator<Item = &'static ObjectType> + Clone {
    PLAIN.iter().chain(shape::TYPES)
}

impl Draft {
    /// Notes a keyword that Sunflow wants before the type.
    fn head(&self, parser: &mut Parser<'_>, key: Span) {
        if self.has_type {
            parser.loose(Loose::HeadAfterType, key);
        }
    }

    pub fn is_visible(&self) -> bool {
        !self.hidden
    }
}

impl Parser<'_> {
    /// `N` and so many names.
    fn names(&mut self, what: &str) -> Parsed<Vec<Name>> {
        let before = self.peek();
        let count = self.int()?;
        if count < 0 {
            return Err(self.expected("the number of names", before));
        }
        (0..count).map(|_| self.word(what)).collect()
    }
}

pub(super) fn object(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("object")?;
    let names = || types().map(|object| object.name);
    let outline = parser.outline();
    let Some(object) = types().find(|o| outline.kind.as_ref().is_some_and(|kind| kind.value == o.name)) else {
        let remark = match outline.kind {
            Some(kind) if kind.value == JAVA => java(parser.span(head), "the object", "it is left out"),
            Some(kind) => unknown_word("object type", &kind, names()),
            None => parser.missing_type(head, "object", names()),
        };
        if let Some(name) = parser.skip_block(head, Some(remark)).name {
            parser.dropped_objects.entry(name.value).or_insert(name.span);
        }
        return Ok(());
    };
    let keys: Vec<Key<Draft>> = HEAD.iter().chain(object.keys).copied().collect();
    let mut draft = Draft::default();
    let grammar = Grammar { what: object.name, keys: &keys, bare: object.bare };
    let outcome = parser.block(head, &grammar, &mut draft);
    let place = parser.span(head);
    if draft.is_visible() {
        parser.require("object", &outcome, place, &[(&["shader", "shaders"], "shader NAME")]);
    }
    match (object.build)(parser, &mut draft, &outcome, place) {
        Some(geometry) => parser.add_object(draft, geometry, outcome.span),
        None => {
            if let Some(name) = draft.name {
                parser.dropped_objects.entry(name.value).or_insert(name.span);
            }
        }
    }
    Ok(())
}

impl Parser<'_> {
    fn add_object(&mut self, draft: Draft, geometry: Geometry, span: Span) {
        let visible = draft.is_visible();
        if let Some(name) = &draft.name {
            self.declare(Namespace::Object, name);
        }
        let Draft { name, shaders, modifiers, transform, .. } = draft;
        self.scene.objects.push(Object { name, shaders, modifiers, transform, geometry, visible, span });
    }

    /// An instance of an object that was passed over has nothing to show, and the warning has been given.
    pub(super) fn drop_instances_of_dropped_objects(&mut self) {
        let (dropped, kept) = (&self.dropped_objects, &self.names);
        self.scene.instances.retain(|Instance { geometry, .. }| {
            !dropped.contains_key(&geometry.value) || kept.contains_key(&(Namespace::Object, geometry.value.clone()))
        });
    }
}

fn sphere(parser: &mut Parser<'_>, draft: &mut Draft, outcome: &Outcome, head: Span) -> Option<Geometry> {
    let placed = outcome.has("transform") || !draft.is_visible();
    match (outcome.has("c"), outcome.has("r")) {
        (true, false) => parser.require("sphere", outcome, head, &[(&["r"], "r 1")]),
        (false, true) if !placed => parser.require("sphere", outcome, head, &[(&["c"], "c 0 0 0")]),
        (false, false) if !placed => parser.loose(Loose::PlacelessSphere, head),
        _ => {}
    }
    Some(Geometry::Sphere { center: draft.center.unwrap_or_default(), radius: draft.radius.unwrap_or(1.0) })
}

fn plane(parser: &mut Parser<'_>, draft: &mut Draft, outcome: &Outcome, head: Span) -> Option<Geometry> {
    match (draft.points.as_slice(), draft.normal) {
        ([point], Some(normal)) if normal != [0.0; 3] => Some(Geometry::Plane(Plane::Normal { point: *point, normal })),
        ([a, b, c], None) => Some(Geometry::Plane(Plane::Points([*a, *b, *c]))),
        _ if outcome.failed => None,
        ([_], Some(_)) => {
            let span = outcome.place("n");
            parser.diagnostics.push(Diagnostic::error(span, "the normal of a plane must not be `0 0 0`"));
            None
        }
        (points, normal) => {
            let found = match normal {
                Some(_) => format!("{} `p` and `n`", points.len()),
                None => format!("{} `p` and no `n`", points.len()),
            };
            let message = format!("`plane` takes one `p` and `n`, or three `p`; found {found}");
            let hint = "for example `p 0 0 0 n 0 1 0`";
            parser.diagnostics.push(Diagnostic::error(head, message).hint(hint));
            None
        }
    }
}

/// `points 2` and two opposite corners.
fn box_corners(parser: &mut Parser<'_>, draft: &mut Draft, _: Span) -> Parsed<()> {
    let before = parser.peek();
    if parser.int()? != 2 {
        return Err(parser.expected("`2` and two corners", before));
    }
    let [a, b]: [[f32; 3]; 2] = [parser.numbers()?, parser.numbers()?];
    let pick = |pick: fn(f32, f32) -> f32| std::array::from_fn(|axis| pick(a[axis], b[axis]));
    draft.corners = Some([pick(f32::min), pick(f32::max)]);
    Ok(())
}

/// The keywords of an instance as far as they were written.
#[derive(Debug, Default)]
struct InstanceDraft {
    name: Option<Name>,
    geometry: Option<Name>,
    shaders: Vec<Name>,
    modifiers: Vec<Name>,
    transform: Option<Transform>,
}

const INSTANCE: &[Key<InstanceDraft>] = &[
    Key::new("name", "name second", |p, d, _| {
        d.name = Some(p.word("a name")?);
        Ok(())
    }),
    Key::new("geometry", "geometry ball", |p, d, _| {
        d.geometry = Some(p.word("the name of an object")?);
        Ok(())
    }),
    Key::new("transform", "transform { translate 0 0 1 }", |p, d, _| {
        d.transform = Some(p.transform()?);
        Ok(())
    }),
    Key::new("shader", "shader red", |p, d, _| {
        d.shaders = vec![p.word("the name of a shader")?];
        Ok(())
    }),
    Key::new("shaders", "shaders 2 red blue", |p, d, _| {
        d.shaders = p.names("the name of a shader")?;
        Ok(())
    }),
    Key::new("modifier", "modifier bumps", |p, d, _| {
        d.modifiers = vec![p.word("the name of a modifier")?];
        Ok(())
    }),
    Key::new("modifiers", "modifiers 2 bumps None", |p, d, _| {
        d.modifiers = p.names("the name of a modifier")?;
        Ok(())
    }),
];

pub(super) fn instance(parser: &mut Parser<'_>, head: Token) -> Parsed<()> {
    parser.open("instance")?;
    let mut draft = InstanceDraft::default();
    let outcome = parser.block(head, &Grammar { what: "instance", keys: INSTANCE, bare: None }, &mut draft);
    let place = parser.span(head);
    let required: &[Required] =
        &[(&["geometry"], "geometry NAME"), (&["transform"], "transform { }"), (&["shader", "shaders"], "shader NAME")];
    parser.require("instance", &outcome, place, required);
    if let Some(name) = &draft.name {
        parser.declare(Namespace::Object, name);
    }
    let InstanceDraft { name, geometry, shaders, modifiers, transform } = draft;
    if let Some(geometry) = geometry {
        let span = outcome.span;
        parser.scene.instances.push(Instance { name, geometry, shaders, modifiers, transform, span });
    }
    Ok(())
}

/// All words of these blocks, for the test of the page on the format.
#[cfg(test)]
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    let keys = types().flat_map(|object| object.keys).chain(&HEAD).map(|key| key.name);
    let types = types().map(|object| object.name).chain([JAVA]);
    keys.chain(types).chain(INSTANCE.iter().map(|key| key.name))
}
