//! Broken scenes give messages or a scene: never a panic, a hang, or more memory than the file is worth.

mod common;

use std::collections::HashSet;
use std::path::Path;
use std::time::{Duration, Instant};
use std::{fs, io};

use common::{OTHERS, REST, SKELETON, scenes};
use jaspe_scene::description::{Geometry, VertexData};
use jaspe_scene::{Diagnostics, DiskLoader, Loader, MemoryLoader, Scene, Severity, parse};

/// Far more than any of these scenes takes, far less than a hang.
const PATIENCE: Duration = Duration::from_secs(20);

/// Reads a scene and checks what must hold for every one.
fn check(what: &str, bytes: &[u8], loader: &dyn Loader) -> (Scene, Diagnostics) {
    let start = Instant::now();
    let (scene, diagnostics) = parse(Path::new("broken.sc"), bytes, loader);
    assert!(start.elapsed() < PATIENCE, "{what} took {:?}", start.elapsed());
    let read: usize = scene.sources.iter().map(|source| source.bytes.len()).sum();
    assert!(diagnostics.iter().count() <= Diagnostics::LIMIT + 1, "{what}");
    for diagnostic in &diagnostics {
        assert!(!diagnostic.message.is_empty() && diagnostic.message.len() < 1000, "{what}: {}", diagnostic.message);
        assert!(!diagnostic.message.chars().any(char::is_control), "{what}: {:?}", diagnostic.message);
        for span in diagnostic.span.iter().chain(diagnostic.labels.iter().map(|label| &label.span)) {
            let source = scene.sources.file(span.file).expect("a span is in a file");
            assert!(span.start <= span.end && span.end as usize <= source.bytes.len(), "{what}: {diagnostic:?}");
        }
    }
    for object in &scene.objects {
        if let Geometry::Mesh(mesh) = &object.geometry {
            assert!(mesh.points.capacity() * 6 <= read + 100, "{what}: room for {} points", mesh.points.capacity());
            assert!(mesh.triangles.iter().flatten().all(|&index| (index as usize) < mesh.points.len()), "{what}");
            assert!(mesh.points.iter().flatten().all(|number| number.is_finite()), "{what}");
            if let VertexData::Vertex(normals) = &mesh.normals {
                assert_eq!(normals.len(), mesh.points.len(), "{what}");
            }
        }
    }
    (scene, diagnostics)
}

fn has_errors(what: &str, text: &str) {
    let (_, diagnostics) = check(what, text.as_bytes(), &MemoryLoader::default());
    assert!(diagnostics.has_errors(), "{what} gives no error");
}

/// A small generator of repeatable numbers (Marsaglia 2003, xorshift).
struct Random(u64);

impl Random {
    fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as usize % limit.max(1)
    }
}

#[test]
fn a_scene_may_end_anywhere() {
    let mut errors = 0;
    for text in [SKELETON, OTHERS, REST] {
        for end in 0..text.len() {
            let (_, diagnostics) = check(&format!("cut at {end}"), &text.as_bytes()[..end], &MemoryLoader::default());
            errors += usize::from(diagnostics.has_errors());
        }
        assert!(!check("whole", text.as_bytes(), &MemoryLoader::default()).1.has_errors());
    }
    let all = SKELETON.len() + OTHERS.len() + REST.len();
    assert!(errors * 10 > all * 9, "only {errors} of {all} cut scenes have errors");
}

/// Changes a text as typing errors, bad transfers and other programs do.
fn mutate(text: &[u8], random: &mut Random) -> Vec<u8> {
    const PIECES: [&[u8]; 24] = [
        b" { ",
        b" } ",
        b" \" ",
        b" /* ",
        b" */ ",
        b" # ",
        b" -1 ",
        b" NaN ",
        b" Infinity ",
        b" 1e99 ",
        b" 2000000000 ",
        b" 99999999999999999999 ",
        b" \0\xff ",
        b" type ",
        b" name ",
        b" shader { ",
        b" points 2000000000 ",
        b"\r",
        b"0x1p3",
        b" include \"broken.sc\" ",
        b" <code> ",
        b" \"sRGB nonlinear\" ",
        b" steps 9 times 0 1 ",
        b"\xef\xbb\xbf",
    ];
    let mut bytes = text.to_vec();
    for _ in 0..=random.below(3) {
        let at = random.below(bytes.len());
        let end = (at + random.below(40)).min(bytes.len());
        match random.below(6) {
            0 => drop(bytes.drain(at..end)),
            1 => bytes.truncate(at),
            2 if at < bytes.len() => bytes[at] = random.below(256) as u8,
            3 => drop(bytes.splice(at..at, bytes[at..end].to_vec())),
            _ => drop(bytes.splice(at..at, PIECES[random.below(PIECES.len())].iter().copied())),
        }
    }
    bytes
}

#[test]
fn mutated_scenes_are_survived() {
    let mut bases: Vec<Vec<u8>> = vec![SKELETON.into(), OTHERS.into(), REST.into()];
    for folder in ["tests/diagnostics", "scenes", "../shared/scenes"] {
        bases.extend(scenes(folder).iter().filter_map(|path| fs::read(path).ok()));
    }
    assert!(bases.len() > 20);
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut cases, mut errors, mut distinct) = (0, 0, HashSet::new());
    for base in &bases {
        // The first pages of the large ones are as good as the whole.
        let base = &base[..base.len().min(4000)];
        for _ in 0..60 {
            let bytes = mutate(base, &mut random);
            let what = format!("mutation {cases}: {}", String::from_utf8_lossy(&bytes));
            let (_, diagnostics) = check(&what, &bytes, &MemoryLoader::default());
            cases += 1;
            errors += usize::from(diagnostics.has_errors());
            distinct.extend(diagnostics.iter().map(|diagnostic| diagnostic.message.clone()));
        }
    }
    assert!(cases >= 1000 && errors * 3 > cases && distinct.len() > 200, "{errors} of {cases}, {}", distinct.len());
}

#[test]
fn large_scenes_may_be_cut_and_spoilt_too() {
    for path in scenes("../shared/scenes") {
        let bytes = fs::read(&path).expect("readable");
        let mut random = Random(bytes.len() as u64 + 1);
        for _ in 0..3 {
            let what = format!("{} spoilt", path.display());
            check(&what, &mutate(&bytes, &mut random), &MemoryLoader::default());
        }
    }
}

#[test]
fn binary_junk_is_no_scene() {
    let mut random = Random(7);
    for size in [1, 10, 100, 1000, 100_000] {
        for _ in 0..10 {
            let bytes: Vec<u8> = (0..size).map(|_| random.below(256) as u8).collect();
            let (scene, diagnostics) = check("junk", &bytes, &MemoryLoader::default());
            assert!(scene.objects.is_empty());
            let says_nothing = bytes.iter().all(|b| b.is_ascii_whitespace() || matches!(b, b'"' | b'#' | b'%'));
            assert!(diagnostics.has_errors() || size == 1 || says_nothing, "{size} bytes of junk give no error");
        }
    }
    has_errors("a picture", "\u{89}PNG\r\n\u{1a}\n\0\0\0\rIHDR\0\0\u{3}\u{e8}");
    check("zeros", &[0; 10_000], &MemoryLoader::default());
    check("nothing", b"", &MemoryLoader::default());
}

#[test]
fn counts_reserve_no_more_than_the_file_can_hold() {
    for list in [
        "points 2000000000 0 0 0",
        "points 99999999999999999999 0 0 0",
        "points -1 0 0 0",
        "points 4000000000000000000 0 0 0",
        "points 1 0 0 0 triangles 2000000000 0 0 0",
        "points 1 0 0 0 triangles 9223372036854775807 0 0 0",
        "points 1 0 0 0 triangles 1 0 0 2000000000",
        "points 1 0 0 0 triangles 1 0 0 -1",
        "points 1 0 0 0 triangles 1 0 0 4294967296",
    ] {
        has_errors(list, &format!("object {{ shader a type generic-mesh {list} normals none uvs none }}"));
    }
    for text in [
        "object { shader a type mesh 2000000000 2000000000 v 0 0 0 0 0 0 0 0 }",
        "object { shader a type mesh 9223372036854775807 9223372036854775807 }",
        "object { shaders 2000000000 a b type sphere c 0 0 0 r 1 }",
        "object { shader a transform steps 2000000000 times 0 1 { } { } type sphere }",
        "camera { type pinhole steps 2000000000 times 0 1 { eye 0 0 1 target 0 0 0 up 0 1 0 } fov 40 aspect 1 }",
        "background { color { \"spectrum 400 700\" 2000000000 1 1 } }",
        "trace-depths { diff 99999999999999999999 }",
        "image { resolution 99999999999 1 aa x 1 }",
        "object { shader a type teapot subdivs 99999 }",
        "object { shader a type gumbo subdivs 9999999999 }",
        "object { shader a type teapot subdivs 0 }",
        "object { shader a type bezier-mesh n 60000 60000 points 0 0 0 }",
        "object { shader a type bezier-mesh n 4 4 points 0 0 0 }",
        "object { shader a type bezier-mesh points 0 0 0 }",
        "object { shader a type sphereflake level 99999999999999999999 }",
        "object { shader a type julia iterations 2000000000 }",
        "object { shader a type hair segments 2000000000 width 1 points 3 0 0 0 }",
        "object { shader a type hair segments 1 width 1 points 2000000000 0 0 0 }",
        "object { shader a type hair segments 2 width 1 points 6 0 0 0 0 0 1 }",
        "object { shader a type particles points 2000000000 0 0 0 radius 1 }",
        "object { shader a type particles points 1 0 0 0 filename f radius 1 }",
        "object { shader a type particles points 1 0 0 0 num -1 radius 1 }",
        "light { type meshlight emit 1 1 1 points 2000000000 0 0 0 triangles 1 0 0 0 }",
        "light { type meshlight emit 1 1 1 points 1 0 0 0 triangles 1 0 0 1 }",
        "light { type mesh emit 1 1 1 2000000000 2000000000 v 0 0 0 0 0 0 0 0 }",
        "gi { type path samples 99999999999999999999 }",
        "shader { name a type ward diff 1 1 1 spec 1 1 1 rough 0 1 }",
        "light { type sunsky up 0 0 0 east 0 1 0 sundir 1 1 1 turbidity 4 }",
    ] {
        has_errors(text, text);
    }
}

#[test]
fn numbers_that_are_none_are_refused_everywhere() {
    for number in ["NaN", "-NaN", "Infinity", "-Infinity", "1e39", "nan", "1.0.0", "0x", "--1", "1,5"] {
        for block in [
            "camera { type pinhole eye 0 0 X target 0 0 0 up 0 1 0 fov 40 aspect 1 }",
            "camera { type pinhole eye 0 0 5 target 0 0 0 up 0 1 0 fov X aspect 1 }",
            "light { type point color 1 1 X power 10 p 0 0 0 }",
            "light { type point color 1 1 1 power X p 0 0 0 }",
            "shader { name a type constant color { \"sRGB nonlinear\" 1 X 1 } }",
            "shader { name a type phong diff 1 1 1 spec 1 1 1 X }",
            "shader { name a type glass eta X color 1 1 1 }",
            "shader { name a type marble depth X }",
            "object { shader a type sphere c X 0 0 r 1 }",
            "object { shader a type sphere c 0 0 0 r X }",
            "object { shader a transform { translate 0 0 X } type sphere }",
            "object { shader a type generic-mesh points 1 0 X 0 triangles 0 normals none uvs none }",
            "object { shader a type mesh 1 0 v 0 0 0 0 0 X 0 0 }",
            "object { shader a type torus r X 1 }",
            "object { shader a type julia q 0 0 X 0 }",
            "object { shader a type particles points 1 0 X 0 radius 1 }",
            "light { type spherical color 1 1 1 radiance X center 0 0 0 radius 1 samples 1 }",
            "light { type sunsky up 0 0 1 east 0 1 0 sundir 1 X 1 turbidity 4 }",
            "gi { type irr-cache samples 1 tolerance X spacing 1 2 }",
            "modifier { name a type bump texture b scale X }",
            "shader { name a type shiny diff 1 1 1 refl X }",
            "texture { name a type wood scale X }",
        ] {
            // Transforms are read in double precision, where 1e39 is a number like any other.
            if !(number == "1e39" && block.contains("translate")) {
                has_errors(&format!("{number} in {block}"), &block.replace('X', number));
            }
        }
    }
}

#[test]
fn endless_repetition_ends() {
    let words = [
        "{ ",
        "} ",
        "shader { ",
        "shader{ ",
        "object { shader a type sphere ",
        "/* ",
        "\" ",
        "<code> ",
        "a { ",
        "camera ",
        "shader { name a type diffuse diff { ",
        "object { shader a transform { ",
        "type type ",
        "include \"x.sc\" ",
        "object { shader a type generic-mesh points 1 ",
        "image { aa ",
        "shader { type janino <code>\n",
        "}{ ",
        "x ",
        "object { } ",
        "object { type sphere } ",
        "shader { name a type mirror refl 1 1 1 } ",
        "# \" ",
        "- ",
    ];
    for word in words {
        let text = word.repeat(200_000 / word.len());
        check(&format!("repeated {word:?}"), text.as_bytes(), &MemoryLoader::default());
    }
    check("one long word", &[b'x'; 1_000_000], &MemoryLoader::default());
    check("one long name", format!("shader {{ name {} type x }}", "y".repeat(1_000_000)).as_bytes(), &DiskLoader);
}

#[test]
fn includes_neither_loop_nor_multiply() {
    let loader = MemoryLoader::default()
        .with("a.sc", *b"include \"b.sc\"")
        .with("b.sc", *b"include \"c.sc\" include \"./c.sc\"")
        .with("./c.sc", *b"include \"a.sc\"")
        .with("c.sc", *b"include \"x/../a.sc\"")
        .with("x/../a.sc", *b"image { }")
        .with("broken.sc", *b"image { }");
    let (_, diagnostics) = check("a loop", b"include \"a.sc\"", &loader);
    assert!(diagnostics.iter().any(|diagnostic| diagnostic.message == "`a.sc` includes itself"), "{diagnostics:#?}");
    let (_, diagnostics) = check("oneself", b"include \"broken.sc\"", &loader);
    assert!(diagnostics.iter().any(|diagnostic| diagnostic.message == "`broken.sc` includes itself"));

    let mut deep = MemoryLoader::default();
    for i in 0..200 {
        let text = format!("include \"{0}.sc\" include \"{0}.sc\"", i + 1);
        deep = deep.with(format!("{i}.sc"), text.into_bytes());
    }
    let (scene, diagnostics) = check("two hundred deep, each twice", b"include \"0.sc\"", &deep);
    assert!(diagnostics.has_errors());
    assert!(scene.sources.iter().count() <= 1000);
}

#[test]
fn files_that_cannot_be_read_are_named() {
    struct Denied;
    impl Loader for Denied {
        fn load(&self, _: &Path) -> io::Result<std::sync::Arc<[u8]>> {
            Err(io::Error::from(io::ErrorKind::PermissionDenied))
        }
    }
    let (_, diagnostics) = check("denied", b"include \"a.sc\"", &Denied);
    let messages: Vec<&str> = diagnostics.iter().map(|diagnostic| diagnostic.message.as_str()).collect();
    assert_eq!(messages, ["cannot read `a.sc`: permission denied"]);
    let (scene, diagnostics) = jaspe_scene::read(Path::new("no such file.sc"), &DiskLoader);
    assert_eq!(diagnostics.count(Severity::Error), 1);
    assert!(scene.sources.iter().next().is_none());
    has_errors("a NUL in a name", "include \"a\0.sc\"");
    has_errors("a folder", "include \".\"");
}
