//! Memory is bounded by some rows of the maps.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

use jaspe_bake::{Bake, Map, MapFormat, SetFolder, SetOptions, Settings, write_set};
use jaspe_texture::Texture;

/// Counts the bytes that are in use, and the most that ever were.
struct Counting;

static USED: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);

// SAFETY: all is left to the system's allocator.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let used = USED.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        MOST.fetch_max(used, Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }
    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        USED.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// The most bytes that a bake of this size holds while it is written.
fn peak(size: u32, format: MapFormat) -> usize {
    let here = tempfile::tempdir().unwrap();
    let texture = Texture::build("stone", &[("depth", jaspe_texture::declare::Value::Int(2))]).unwrap();
    let maps = vec![Map::Color, Map::Height, Map::Normal, Map::Roughness, Map::Emission];
    let bake = Bake::new(texture, Settings { size, maps, ..Settings::default() }).unwrap();
    let folder = SetFolder::new(&here.path().join("set")).unwrap();
    MOST.store(USED.load(Ordering::Relaxed), Ordering::Relaxed);
    let before = USED.load(Ordering::Relaxed);
    write_set(&bake, &SetOptions::new(format), folder, &()).unwrap();
    MOST.load(Ordering::Relaxed) - before
}

/// A picture four times as large takes twice the memory: that of the rows that are worked on.
#[test]
fn memory_grows_with_the_rows_and_not_with_the_picture() {
    for format in [MapFormat::Png8, MapFormat::ExrFloat] {
        let [small, large] = [512, 1024].map(|size| peak(size, format));
        assert!(large < 2 * small + (2 << 20), "{format}: {small}, then {large} bytes");
        // All maps as floats would be 11 × 4 bytes per pixel.
        assert!(large < 1024 * 1024 * 11 * 4 / 2, "{format}: {large} bytes");
    }
}
