//! Memory in large pages, where the system gives them to who asks: rays that go here and there through a large hierarchy
//! then wait half as often for where a page is.

#![allow(unsafe_code, reason = "the system is told something about memory")]

/// Asks for large pages for a list; best before anything is written to it.
#[cfg(target_os = "linux")]
pub(super) fn enlarge<T>(list: &Vec<T>) {
    const PAGE: usize = 4096;
    let start = list.as_ptr().cast::<u8>();
    let skipped = start.align_offset(PAGE);
    let bytes = (list.capacity() * size_of::<T>()).saturating_sub(skipped) / PAGE * PAGE;
    if bytes > 0 {
        // SAFETY: these are whole pages of memory that the list owns, and what they hold stays what it is. Where the system
        // has no large pages, nothing happens.
        unsafe {
            libc::madvise(start.add(skipped).cast_mut().cast(), bytes, libc::MADV_HUGEPAGE);
        }
    }
}

/// Asks for large pages for a list, which this system has its own mind about.
#[cfg(not(target_os = "linux"))]
pub(super) fn enlarge<T>(_: &Vec<T>) {}
