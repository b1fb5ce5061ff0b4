//! `--tev`: a viewer is shown the picture, and nothing that it does harms the rendering.

mod common;

use common::{SCENE, folder, run_in, write_scene};
use std::io::Read as _;
use std::net::{TcpListener, TcpStream};
use std::path::Path;

/// The picture as the viewer has it: red, green, blue and coverage.
#[derive(Debug, Default, PartialEq)]
struct Shown {
    name: String,
    width: u32,
    height: u32,
    pixels: Vec<[f32; 4]>,
    /// How many parts of it came.
    updates: u32,
}

/// A packet, read from its front.
struct Packet<'a>(&'a [u8]);

impl Packet<'_> {
    fn take<const N: usize>(&mut self) -> [u8; N] {
        let (bytes, rest) = self.0.split_first_chunk().expect("the packet goes on");
        self.0 = rest;
        *bytes
    }

    fn word(&mut self) -> u32 {
        u32::from_le_bytes(self.take())
    }

    fn text(&mut self) -> String {
        let length = self.0.iter().position(|&byte| byte == 0).expect("texts end");
        let text = String::from_utf8(self.0[..length].to_vec()).expect("it is text");
        self.0 = &self.0[length + 1..];
        text
    }

    fn channels(&mut self) -> [String; 4] {
        assert_eq!(self.word(), 4);
        std::array::from_fn(|_| self.text())
    }
}

impl Shown {
    /// Does what a packet says.
    fn read(&mut self, packet: &[u8]) {
        let mut packet = Packet(packet);
        let ([kind, front], name) = (packet.take(), packet.text());
        match kind {
            4 => {
                let (width, height) = (packet.word(), packet.word());
                let pixels = vec![[0.0; 4]; (width * height) as usize];
                *self = Shown { name, width, height, pixels, updates: 0 };
                assert_eq!((front, packet.channels().concat().as_str()), (1, "RGBA"));
            }
            6 => {
                assert_eq!(name, self.name);
                assert_eq!((front, packet.channels().concat().as_str()), (0, "RGBA"));
                let [x, y, width, height] = std::array::from_fn(|_| packet.word());
                assert!(x + width <= self.width && y + height <= self.height && width * height > 0);
                let offsets: [u64; 4] = std::array::from_fn(|_| u64::from_le_bytes(packet.take()));
                let strides: [u64; 4] = std::array::from_fn(|_| u64::from_le_bytes(packet.take()));
                let values: Vec<f32> =
                    packet.0.chunks(4).map(|b| f32::from_le_bytes(b.try_into().expect("four"))).collect();
                packet.0 = &[];
                for i in 0..width * height {
                    let at = (y + i / width) * self.width + x + i % width;
                    let value = |c: usize| values[(offsets[c] + u64::from(i) * strides[c]) as usize];
                    self.pixels[at as usize] = std::array::from_fn(value);
                }
                self.updates += 1;
            }
            _ => panic!("packet of type {kind}"),
        }
        assert!(packet.0.is_empty(), "{} bytes too many", packet.0.len());
    }
}

/// Reads packets until the other side has nothing more to say.
fn watch(mut stream: TcpStream) -> Shown {
    let mut bytes = Vec::new();
    stream.read_to_end(&mut bytes).expect("the other side closes");
    let (mut shown, mut rest) = (Shown::default(), &bytes[..]);
    while !rest.is_empty() {
        let length = Packet(rest).word() as usize;
        shown.read(&rest[4..length]);
        rest = &rest[length..];
    }
    shown
}

/// What is in an EXR file.
fn pixels(path: &Path) -> Vec<[f32; 4]> {
    let image = image::open(path).expect("it is a picture").into_rgba32f();
    image.pixels().map(|pixel| pixel.0).collect()
}

#[test]
fn the_viewer_ends_with_the_picture_that_is_written() {
    let here = folder();
    for (dialect, options) in [
        ("sunflow", &[][..]),
        ("sunflow", &["--aa", "0", "2", "--threads", "1"]),
        ("sunflow", &["--crop", "7,3,50,41", "--samples", "4"]),
        ("report", &["--resolution", "80x80"]),
    ] {
        write_scene(here.path(), "a.sc", &format!("dialect {dialect}\n{SCENE}"));
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = listener.local_addr().expect("it is bound").to_string();
        let viewer = std::thread::spawn(move || watch(listener.accept().expect("somebody connects").0));
        let run = run_in(here.path(), &[&["render", "a.sc", "-o", "x.exr", "--tev", &address], options].concat());
        assert_eq!(run.status, 0, "{}", run.stderr);
        assert!(!run.stderr.contains("warning"), "{}", run.stderr);
        let shown = viewer.join().expect("every packet is right");
        assert_eq!(shown.name, "x.exr");
        assert!(shown.updates >= 4, "only {} parts", shown.updates);
        let written = pixels(&here.path().join("x.exr"));
        assert!(shown.pixels == written, "{dialect} {options:?}: not the same picture");
    }
}

#[test]
fn viewers_that_are_not_there_or_go_away_are_told_of_once() {
    let here = folder();
    write_scene(here.path(), "a.sc", SCENE);
    let arguments = ["render", "a.sc", "-o", "x.png", "--samples", "64", "--tev"];

    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("it is bound").to_string();
    drop(listener);
    let run = run_in(here.path(), &[&arguments[..], &[&address]].concat());
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stderr.contains(&format!("warning: no viewer at {address}: ")), "{}", run.stderr);
    assert!(here.path().join("x.png").exists());

    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("it is bound").to_string();
    let viewer = std::thread::spawn(move || {
        let (mut stream, _) = listener.accept().expect("somebody connects");
        stream.read_exact(&mut [0; 4]).expect("something comes");
    });
    let run = run_in(here.path(), &[&arguments[..], &[&address]].concat());
    viewer.join().expect("it goes away");
    assert_eq!(run.status, 0, "{}", run.stderr);
    let warnings: Vec<_> = run.stderr.lines().filter(|line| line.starts_with("warning")).collect();
    assert_eq!(warnings.len(), 1, "{}", run.stderr);
    assert!(warnings[0].contains(&format!("the viewer at {address} has gone")), "{}", run.stderr);

    let run = run_in(here.path(), &["render", "--tev", "a.sc"]);
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("expected HOST:PORT"), "{}", run.stderr);
}
