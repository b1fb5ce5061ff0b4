//! Embree, the ray tracing kernels by Intel, through its shared library: the part of its C interface that is needed to
//! build a hierarchy over a mesh and to trace rays through it ([Embree] "API Reference", versions 3 and 4).

#![allow(unsafe_code, reason = "a library in C is called")]

use std::ffi::{CStr, c_char, c_void};
use std::path::{Path, PathBuf};
use std::ptr;
use std::sync::atomic::{AtomicI64, Ordering};

use jaspe_noise::simd::Level;
use jaspe_render::{MeshFile, RaySet};
use libloading::Library;

/// Names under which the library is found where the system keeps libraries.
const NAMES: [&str; 6] =
    ["libembree4.so", "libembree4.so.4", "libembree4.dylib", "embree4.dll", "libembree3.so", "libembree3.so.3"];

/// A device, scene or geometry of Embree.
type Handle = *mut c_void;
/// What [`Api::monitor`] calls with a number of bytes that are taken or given back.
type Monitor = unsafe extern "C" fn(*mut c_void, isize, bool) -> bool;
/// `rtcIntersect1` and `rtcOccluded1`. Version 3 takes the scene, a context and the ray, version 4 the scene, the ray and
/// arguments.
type One = unsafe extern "C" fn(Handle, *mut c_void, *mut c_void);
/// The same for packets, with a mask of valid rays first.
type Many = unsafe extern "C" fn(*const i32, Handle, *mut c_void, *mut c_void);

/// The functions, by their names without `rtc`.
struct Api {
    new_device: unsafe extern "C" fn(*const c_char) -> Handle,
    release_device: unsafe extern "C" fn(Handle),
    device_property: unsafe extern "C" fn(Handle, i32) -> isize,
    device_error: unsafe extern "C" fn(Handle) -> i32,
    monitor: unsafe extern "C" fn(Handle, Option<Monitor>, *mut c_void),
    new_scene: unsafe extern "C" fn(Handle) -> Handle,
    release_scene: unsafe extern "C" fn(Handle),
    build_quality: unsafe extern "C" fn(Handle, i32),
    commit_scene: unsafe extern "C" fn(Handle),
    new_geometry: unsafe extern "C" fn(Handle, i32) -> Handle,
    release_geometry: unsafe extern "C" fn(Handle),
    new_buffer: unsafe extern "C" fn(Handle, i32, u32, i32, usize, usize) -> *mut c_void,
    commit_geometry: unsafe extern "C" fn(Handle),
    attach: unsafe extern "C" fn(Handle, Handle) -> u32,
    intersect: (One, [Many; 3]),
    occluded: (One, [Many; 3]),
    /// Keeps the functions where they are.
    _library: Library,
}

/// Embree, ready to build.
pub struct Embree {
    api: Api,
    device: Handle,
    /// Bytes that it holds at the moment.
    held: Box<AtomicI64>,
    /// 3 or 4.
    major: isize,
    /// Its version in words.
    pub version: String,
}

/// A hierarchy that Embree has built.
pub struct Scene<'a> {
    embree: &'a Embree,
    scene: Handle,
}

/// How rays are handed to Embree.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Mode {
    /// Rays in a packet: 1, 4, 8 or 16.
    width: usize,
    /// Whether it is told that they are coherent.
    coherent: bool,
}

impl Mode {
    /// All there are.
    pub fn all() -> impl Iterator<Item = Mode> {
        [1, 4, 8, 16].into_iter().flat_map(|width| [false, true].map(|coherent| Mode { width, coherent }))
    }

    /// In words.
    pub fn name(self) -> String {
        let rays = if self.width == 1 { "single".to_owned() } else { format!("packets of {}", self.width) };
        if self.coherent { format!("{rays}, coherent") } else { rays }
    }
}

/// What is asked of rays.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Query {
    /// The closest hit.
    Closest,
    /// Whether there is any.
    Any,
}

/// Words of a ray: origin, near end, direction, time, far end, mask, number, flags.
const RAY: usize = 12;
/// Words of a hit: normal, u, v, primitive, geometry, instance, and since version 4.4 the primitive of the instance.
const HIT: usize = 9;
/// Where things lie among them.
const FAR: usize = 8;
const U: usize = 15;
const V: usize = 16;
const PRIMITIVE: usize = 17;
const GEOMETRY: usize = 18;

/// A line of the cache: packets want to be aligned.
#[derive(Debug, Clone, Copy)]
#[repr(C, align(64))]
struct Line([u32; 16]);

/// Rays in Embree's own layout for a mode.
#[derive(Debug, Clone)]
pub struct Packets {
    mode: Mode,
    count: usize,
    /// Words from one packet to the next.
    stride: usize,
    lines: Vec<Line>,
}

impl Packets {
    /// The same rays in packets.
    pub fn new(mode: Mode, rays: &RaySet) -> Packets {
        let width = mode.width;
        let stride = if width == 1 { 24 } else { ((RAY + HIT) * width).next_multiple_of(16) };
        let packets = rays.len().div_ceil(width);
        let lines = vec![Line([0; 16]); (packets * stride).div_ceil(16)];
        let mut all = Packets { mode, count: rays.len(), stride, lines };
        for i in 0..packets * width {
            // Past the end there are rays that look for nothing.
            let ([ox, oy, oz], [dx, dy, dz], far) =
                if i < rays.len() { rays.get(i) } else { ([0.0; 3], [0.0, 0.0, 1.0], -1.0) };
            for (row, value) in [ox, oy, oz, 0.0, dx, dy, dz, 0.0, far].into_iter().enumerate() {
                *all.word(row, i) = value.to_bits();
            }
            for row in [9, PRIMITIVE, GEOMETRY, GEOMETRY + 1] {
                *all.word(row, i) = u32::MAX;
            }
        }
        all
    }

    /// Where a word of ray `i` lies.
    fn at(&self, row: usize, i: usize) -> (usize, usize) {
        let word = i / self.mode.width * self.stride + row * self.mode.width + i % self.mode.width;
        (word / 16, word % 16)
    }

    fn word(&mut self, row: usize, i: usize) -> &mut u32 {
        let (line, word) = self.at(row, i);
        &mut self.lines[line].0[word]
    }

    fn get(&self, row: usize, i: usize) -> u32 {
        let (line, word) = self.at(row, i);
        self.lines[line].0[word]
    }

    /// Takes the rays of others of the same mode as they were before they were traced.
    pub fn copy_from(&mut self, others: &Packets) {
        self.lines.copy_from_slice(&others.lines);
    }

    /// What ray `i` met: distance, u, v, and which triangle.
    pub fn hit(&self, i: usize) -> Option<(f32, f32, f32, u32)> {
        let number = |row| f32::from_bits(self.get(row, i));
        (self.get(GEOMETRY, i) != u32::MAX).then(|| (number(FAR), number(U), number(V), self.get(PRIMITIVE, i)))
    }

    /// Whether ray `i` is blocked: then its far end is negative.
    pub fn is_blocked(&self, i: usize) -> bool {
        f32::from_bits(self.get(FAR, i)) < 0.0
    }
}

/// Every lane of a packet.
#[repr(align(64))]
struct Valid([i32; 16]);
static VALID: Valid = Valid([-1; 16]);

/// `RTCIntersectContext` of version 3: flags, filter, instance and what may follow.
#[repr(C, align(16))]
struct Context {
    flags: u32,
    filter: *const c_void,
    instance: u32,
    more: [u32; 8],
}

/// `RTCIntersectArguments` and `RTCOccludedArguments` of version 4.
#[repr(C, align(16))]
struct Arguments {
    flags: u32,
    features: u32,
    context: *const c_void,
    filter: *const c_void,
    function: *const c_void,
    more: [u32; 8],
}

impl Scene<'_> {
    /// Traces packets; they then hold what they met.
    pub fn trace(&self, query: Query, packets: &mut Packets) {
        let Mode { width, coherent } = packets.mode;
        let api = &self.embree.api;
        let (one, many) = if query == Query::Closest { &api.intersect } else { &api.occluded };
        let none = ptr::null();
        let mut context = Context { flags: u32::from(coherent), filter: none, instance: u32::MAX, more: [0; 8] };
        let mut arguments = Arguments {
            flags: u32::from(coherent) << 16,
            features: u32::MAX,
            context: none,
            filter: none,
            function: none,
            more: [0; 8],
        };
        let start = packets.lines.as_mut_ptr().cast::<u32>();
        for packet in 0..packets.count.div_ceil(width) {
            // SAFETY: `lines` holds all packets, each aligned as its width wants it and with room for a hit; the
            // scene is committed, and the functions have the form of this version.
            unsafe {
                let rays: *mut c_void = start.add(packet * packets.stride).cast();
                let (second, third) = match self.embree.major {
                    3 => (ptr::from_mut(&mut context).cast(), rays),
                    _ => (rays, ptr::from_mut(&mut arguments).cast()),
                };
                match width {
                    1 => one(self.scene, second, third),
                    4 => many[0](VALID.0.as_ptr(), self.scene, second, third),
                    8 => many[1](VALID.0.as_ptr(), self.scene, second, third),
                    _ => many[2](VALID.0.as_ptr(), self.scene, second, third),
                }
            }
        }
    }
}

impl Drop for Scene<'_> {
    fn drop(&mut self) {
        // SAFETY: the scene is released once.
        unsafe { (self.embree.api.release_scene)(self.scene) }
    }
}

unsafe extern "C" fn count(held: *mut c_void, bytes: isize, _: bool) -> bool {
    // SAFETY: it is the counter of an `Embree` that outlives its device.
    let held = unsafe { &*held.cast::<AtomicI64>() };
    held.fetch_add(bytes as i64, Ordering::Relaxed);
    true
}

impl Embree {
    /// Loads the library that is named, or one that the system finds; `None` where there is none. Held to a level, it uses
    /// no instructions beyond that.
    ///
    /// # Errors
    /// Why the named library cannot be used.
    pub fn load(named: Option<&Path>, held: Option<Level>) -> Result<Option<Embree>, String> {
        let options = match held {
            None => c"",
            Some(Level::Scalar | Level::Sse) => c"max_isa=sse4.2",
            Some(Level::Avx2) => c"max_isa=avx2",
            Some(Level::Avx512) => c"max_isa=avx512",
        };
        let Some(path) = named else {
            return Ok(NAMES.iter().find_map(|name| Embree::open(&PathBuf::from(name), options).ok()));
        };
        Embree::open(path, options).map(Some)
    }

    fn open(path: &Path, options: &CStr) -> Result<Embree, String> {
        // SAFETY: whoever names a library wants its code to run; the functions have the types of its header.
        unsafe {
            let library = Library::new(path).map_err(|error| error.to_string())?;
            let api = Api::of(library).map_err(|error| error.to_string())?;
            let device = (api.new_device)(options.as_ptr());
            if device.is_null() {
                return Err(format!("it makes no device: error {}", (api.device_error)(ptr::null_mut())));
            }
            let property = |number| (api.device_property)(device, number);
            let [major, minor, patch] = [1, 2, 3].map(property);
            let version = format!("Embree {major}.{minor}.{patch}");
            let held = Box::new(AtomicI64::new(0));
            (api.monitor)(device, Some(count), ptr::from_ref(&*held).cast_mut().cast());
            let embree = Embree { api, device, held, major, version };
            if matches!(major, 3 | 4) { Ok(embree) } else { Err(format!("it is {}, not 3 or 4", embree.version)) }
        }
    }

    /// Bytes that it holds at the moment, buffers included.
    pub fn held_bytes(&self) -> i64 {
        self.held.load(Ordering::Relaxed)
    }

    /// Copies a mesh to where [`Embree::build`] finds it.
    pub fn geometry(&self, mesh: &MeshFile) -> Mesh<'_> {
        const TRIANGLES: i32 = 0;
        const INDICES: (i32, i32) = (0, 0x5003);
        const POINTS: (i32, i32) = (1, 0x9003);
        // SAFETY: buffers have room for as many items as were asked for, of three words each.
        unsafe {
            let geometry = (self.api.new_geometry)(self.device, TRIANGLES);
            let buffer = |(kind, format), count| (self.api.new_buffer)(geometry, kind, 0, format, 12, count);
            let indices = buffer(INDICES, mesh.triangles.len());
            ptr::copy_nonoverlapping(mesh.triangles.as_ptr(), indices.cast(), mesh.triangles.len());
            let points = buffer(POINTS, mesh.points.len());
            ptr::copy_nonoverlapping(mesh.points.as_ptr(), points.cast(), mesh.points.len());
            (self.api.commit_geometry)(geometry);
            Mesh { embree: self, geometry }
        }
    }

    /// Builds a hierarchy of medium quality on all threads.
    pub fn build(&self, mesh: &Mesh<'_>) -> Scene<'_> {
        const MEDIUM: i32 = 1;
        // SAFETY: handles are alive, and released by whoever holds them.
        unsafe {
            let scene = (self.api.new_scene)(self.device);
            (self.api.build_quality)(scene, MEDIUM);
            (self.api.attach)(scene, mesh.geometry);
            (self.api.commit_scene)(scene);
            Scene { embree: self, scene }
        }
    }
}

impl Drop for Embree {
    fn drop(&mut self) {
        // SAFETY: the device is released once, after all that was made with it.
        unsafe { (self.api.release_device)(self.device) }
    }
}

/// A mesh in Embree's hands.
pub struct Mesh<'a> {
    embree: &'a Embree,
    geometry: Handle,
}

impl Drop for Mesh<'_> {
    fn drop(&mut self) {
        // SAFETY: scenes that hold it have counted it.
        unsafe { (self.embree.api.release_geometry)(self.geometry) }
    }
}

impl Api {
    /// # Safety
    /// The library must be Embree, 3 or 4.
    unsafe fn of(library: Library) -> Result<Api, libloading::Error> {
        // SAFETY: passed on.
        unsafe {
            Ok(Api {
                new_device: find(&library, c"rtcNewDevice")?,
                release_device: find(&library, c"rtcReleaseDevice")?,
                device_property: find(&library, c"rtcGetDeviceProperty")?,
                device_error: find(&library, c"rtcGetDeviceError")?,
                monitor: find(&library, c"rtcSetDeviceMemoryMonitorFunction")?,
                new_scene: find(&library, c"rtcNewScene")?,
                release_scene: find(&library, c"rtcReleaseScene")?,
                build_quality: find(&library, c"rtcSetSceneBuildQuality")?,
                commit_scene: find(&library, c"rtcCommitScene")?,
                new_geometry: find(&library, c"rtcNewGeometry")?,
                release_geometry: find(&library, c"rtcReleaseGeometry")?,
                new_buffer: find(&library, c"rtcSetNewGeometryBuffer")?,
                commit_geometry: find(&library, c"rtcCommitGeometry")?,
                attach: find(&library, c"rtcAttachGeometry")?,
                intersect: (
                    find(&library, c"rtcIntersect1")?,
                    [
                        find(&library, c"rtcIntersect4")?,
                        find(&library, c"rtcIntersect8")?,
                        find(&library, c"rtcIntersect16")?,
                    ],
                ),
                occluded: (
                    find(&library, c"rtcOccluded1")?,
                    [
                        find(&library, c"rtcOccluded4")?,
                        find(&library, c"rtcOccluded8")?,
                        find(&library, c"rtcOccluded16")?,
                    ],
                ),
                _library: library,
            })
        }
    }
}

/// A function by its name.
///
/// # Safety
/// The function must have this type.
unsafe fn find<F: Copy>(library: &Library, name: &CStr) -> Result<F, libloading::Error> {
    // SAFETY: passed on.
    unsafe { library.get::<F>(name.to_bytes_with_nul()).map(|symbol| *symbol) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packets_hold_the_rays_as_the_header_lays_them_out() {
        let mut rays = RaySet::default();
        for i in 0..5u8 {
            let x = f32::from(i);
            rays.push([x, x + 10.0, x + 20.0], [x + 30.0, x + 40.0, x + 50.0], x + 60.0);
        }
        let single = Packets::new(Mode { width: 1, coherent: false }, &rays);
        let words = |packets: &Packets| packets.lines.iter().flat_map(|line| line.0).collect::<Vec<_>>();
        let third: Vec<f32> = words(&single)[3 * 24..][..9].iter().map(|&bits| f32::from_bits(bits)).collect();
        assert_eq!(third, [3.0, 13.0, 23.0, 0.0, 33.0, 43.0, 53.0, 0.0, 63.0]);

        let fours = Packets::new(Mode { width: 4, coherent: false }, &rays);
        let second = words(&fours)[fours.stride..].iter().map(|&bits| f32::from_bits(bits)).collect::<Vec<_>>();
        assert_eq!(second[..4], [4.0, 0.0, 0.0, 0.0], "origins along x, then lanes without rays");
        assert_eq!(second[8 * 4..][..4], [64.0, -1.0, -1.0, -1.0], "ends");
        assert!((0..5).all(|i| fours.hit(i).is_none() && !fours.is_blocked(i)));
        assert_eq!(fours.stride % 16, 0, "packets begin at lines of the cache");
    }
}
