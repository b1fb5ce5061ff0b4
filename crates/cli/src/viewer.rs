//! `--tev`: shows the picture in the viewer tev while it is rendered.
//!
//! tev listens on a TCP port for packets: their length in bytes (with itself), a type, and what belongs to it, all in
//! little-endian order, texts ended by a zero byte ([Müller, tev], `include/tev/Ipc.h`). A thread of its own sends them, so
//! that a slow viewer holds nobody up: tiles that it is too slow for are left out, and the finished picture is sent
//! whole.

use std::io::{self, Write as _};
use std::net::{SocketAddr, TcpStream, ToSocketAddrs as _};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;
use std::time::Duration;

use jaspe_edge::plain;
use jaspe_render::{Film, Pixel};

/// Where tev listens unless told otherwise.
pub const DEFAULT: &str = "127.0.0.1:14158";
/// Tiles that may wait to be sent.
const QUEUE: usize = 256;
/// How long a viewer may take to answer, and to read on.
const PATIENCE: [Duration; 2] = [Duration::from_secs(2), Duration::from_secs(5)];
/// Pixels of a packet of the finished picture, about.
const BAND: usize = 1 << 16;

/// A viewer that is being sent tiles.
#[derive(Debug)]
pub struct Viewer {
    address: String,
    queue: SyncSender<Part>,
    sender: JoinHandle<io::Result<()>>,
    /// It has been told that the viewer is gone.
    told: AtomicBool,
}

/// A part of the picture and its top left corner.
type Part = ([u32; 2], Film);

impl Viewer {
    /// Opens an image of that name and size in the viewer at `HOST:PORT`; or says why it cannot.
    pub fn open(address: &str, name: &str, [width, height]: [u32; 2]) -> Result<Viewer, String> {
        let failure = |error: &io::Error| format!("no viewer at {address}: {}", plain(error));
        let mut stream = connect(address).map_err(|error| failure(&error))?;
        stream.write_all(&create(name, [width, height])).map_err(|error| failure(&error))?;
        let (queue, parts) = sync_channel(QUEUE);
        let name = name.to_owned();
        let sender = std::thread::spawn(move || send(&mut stream, &name, &parts));
        Ok(Viewer { address: address.to_owned(), queue, sender, told: AtomicBool::new(false) })
    }

    /// Sends a tile, unless too many are waiting. Returns what to tell when the viewer has gone, once.
    pub fn show(&self, corner: [u32; 2], part: &Film) -> Option<String> {
        match self.queue.try_send((corner, part.clone())) {
            Err(TrySendError::Disconnected(_)) if !self.told.swap(true, Ordering::Relaxed) => {
                Some(format!("the viewer at {} has gone", self.address))
            }
            _ => None,
        }
    }

    /// Sends the finished picture, and waits until it is sent. Returns what to tell as [`Viewer::show`] does.
    pub fn finish(self, film: &Film) -> Option<String> {
        let rows = (BAND / film.width as usize).max(1);
        for (band, y) in film.pixels.chunks(rows * film.width as usize).zip((0..).step_by(rows)) {
            let height = (band.len() / film.width as usize) as u32;
            if self.queue.send(([0, y], Film { height, pixels: band.to_vec(), ..*film })).is_err() {
                break;
            }
        }
        let Viewer { address, queue, sender, told } = self;
        drop(queue);
        match sender.join() {
            Ok(Err(error)) if !told.into_inner() => {
                Some(format!("the viewer at {address} has gone: {}", plain(&error)))
            }
            _ => None,
        }
    }
}

fn connect(address: &str) -> io::Result<TcpStream> {
    let mut last = io::Error::new(io::ErrorKind::NotFound, "no such host");
    for address in address.to_socket_addrs()? {
        match open(address) {
            Ok(stream) => return Ok(stream),
            Err(error) => last = error,
        }
    }
    Err(last)
}

fn open(address: SocketAddr) -> io::Result<TcpStream> {
    let [answer, read] = PATIENCE;
    let stream = TcpStream::connect_timeout(&address, answer)?;
    stream.set_write_timeout(Some(read))?;
    Ok(stream)
}

/// Sends what comes until nothing more does.
fn send(stream: &mut TcpStream, name: &str, parts: &Receiver<Part>) -> io::Result<()> {
    parts.iter().try_for_each(|(corner, film)| stream.write_all(&update(name, corner, &film)))
}

/// The types of packets, as tev numbers them.
const CREATE_IMAGE: u8 = 4;
const UPDATE_IMAGE: u8 = 6;
const CHANNELS: [&str; 4] = ["R", "G", "B", "A"];

/// A packet that opens a black image and brings it to the front.
fn create(name: &str, size: [u32; 2]) -> Vec<u8> {
    let mut packet = Packet::new(CREATE_IMAGE, true, name);
    size.iter().for_each(|&side| packet.word(side));
    packet.word(CHANNELS.len() as u32);
    CHANNELS.iter().for_each(|channel| packet.text(channel));
    packet.finish()
}

/// A packet that replaces a part of an image: the third form of it, in which channels have offsets and strides.
fn update(name: &str, corner: [u32; 2], film: &Film) -> Vec<u8> {
    let mut packet = Packet::new(UPDATE_IMAGE, false, name);
    packet.word(CHANNELS.len() as u32);
    CHANNELS.iter().for_each(|channel| packet.text(channel));
    [corner[0], corner[1], film.width, film.height].iter().for_each(|&number| packet.word(number));
    (0..CHANNELS.len() as u64).for_each(|offset| packet.long(offset));
    CHANNELS.iter().for_each(|_| packet.long(CHANNELS.len() as u64));
    let values = film.pixels.iter().flat_map(|pixel: &Pixel| film.linear(pixel));
    values.for_each(|value| packet.word(value.to_bits()));
    packet.finish()
}

struct Packet(Vec<u8>);

impl Packet {
    fn new(kind: u8, to_front: bool, name: &str) -> Packet {
        let mut packet = Packet(vec![0, 0, 0, 0, kind, u8::from(to_front)]);
        packet.text(name);
        packet
    }

    fn word(&mut self, value: u32) {
        self.0.extend(value.to_le_bytes());
    }

    fn long(&mut self, value: u64) {
        self.0.extend(value.to_le_bytes());
    }

    /// No name of a file holds a zero byte.
    fn text(&mut self, text: &str) {
        self.0.extend(text.as_bytes());
        self.0.push(0);
    }

    fn finish(mut self) -> Vec<u8> {
        let length = self.0.len() as u32;
        self.0[..4].copy_from_slice(&length.to_le_bytes());
        self.0
    }
}

/// `HOST:PORT`.
pub fn address(text: &str) -> Result<String, String> {
    let port = text.rsplit_once(':').filter(|(host, _)| !host.is_empty()).map(|(_, port)| port.parse::<u16>());
    match port {
        Some(Ok(1..)) => Ok(text.to_owned()),
        _ => Err(format!("expected HOST:PORT, such as {DEFAULT}; --tev alone, after the scene, means that one")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use jaspe_render::Encoding;

    #[test]
    fn packets_are_laid_out_as_the_viewer_reads_them() {
        let packet = create("a.png", [640, 480]);
        let mut expected = vec![38, 0, 0, 0, 4, 1];
        expected.extend(b"a.png\0");
        expected.extend([0x80, 2, 0, 0, 0xe0, 1, 0, 0, 4, 0, 0, 0]);
        expected.extend(b"R\0G\0B\0A\0");
        expected[0] = expected.len() as u8;
        assert_eq!(packet, expected);

        let film = Film { width: 1, height: 1, pixels: vec![[1.0, -2.0, 0.5, 1.0]], encoding: Encoding::Linear };
        let packet = update("a", [3, 4], &film);
        let mut expected = vec![0, 0, 0, 0, 6, 0, b'a', 0, 4, 0, 0, 0];
        expected.extend(b"R\0G\0B\0A\0");
        for word in [3u32, 4, 1, 1] {
            expected.extend(word.to_le_bytes());
        }
        for long in [0i64, 1, 2, 3, 4, 4, 4, 4] {
            expected.extend(long.to_le_bytes());
        }
        expected.extend([0, 0, 0x80, 0x3f, 0, 0, 0, 0xc0, 0, 0, 0, 0x3f, 0, 0, 0x80, 0x3f]);
        expected[0] = expected.len() as u8;
        assert_eq!(packet, expected);
    }

    #[test]
    fn addresses_have_a_host_and_a_port() {
        for right in [DEFAULT, "localhost:1", "[::1]:14158", "far.example.org:80"] {
            assert_eq!(address(right), Ok(right.to_owned()));
        }
        for wrong in ["scene.sc", "localhost", ":14158", "localhost:", "localhost:0", "localhost:70000", ""] {
            assert!(address(wrong).is_err_and(|message| message.contains("HOST:PORT")), "{wrong}");
        }
    }
}
