//! The system's allocator, counting what passes through it, and refusing what it is told to.

use crate::{grown, is_refused, shrunk};
use std::alloc::{GlobalAlloc, Layout, System};

/// Counts bytes as asked for, before the system rounds them up, and asks for huge pages where they are many: Embree's
/// own allocator does so, and what is compared with it shall have the same.
pub struct Counting;

/// Bytes from which on huge pages (2 MiB) are asked for.
const MANY: usize = 4 << 20;

/// Asks for huge pages behind an allocation, where the system has such advice.
fn advise(place: *mut u8, size: usize) {
    #[cfg(target_os = "linux")]
    if size >= MANY && !place.is_null() {
        const PAGE: usize = 4096;
        let before = place.align_offset(PAGE);
        let length = (size - before) / PAGE * PAGE;
        // SAFETY: whole pages inside an allocation that the caller owns; the advice changes no content. Refused,
        // it does no harm.
        let _ = unsafe {
            rustix::mm::madvise(place.add(before).cast(), length, rustix::mm::Advice::LinuxHugepage)
        };
    }
    #[cfg(not(target_os = "linux"))]
    let _ = (place, size);
}

/// Counts what was allocated, if it was.
fn counted(place: *mut u8, bytes: usize) -> *mut u8 {
    if !place.is_null() {
        grown(bytes);
        advise(place, bytes);
    }
    place
}

// SAFETY: every call is passed on unchanged to the system's allocator, whose answers are
// returned unchanged, or answered by no memory, which an allocator may do; counting and advising neither allocate nor panic.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if is_refused(layout.size()) {
            return std::ptr::null_mut();
        }
        // SAFETY: the caller's promises are those that `System` asks for.
        counted(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        if is_refused(layout.size()) {
            return std::ptr::null_mut();
        }
        // SAFETY: as in `alloc`.
        counted(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: as in `alloc`.
        unsafe { System.dealloc(place, layout) };
        shrunk(layout.size());
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        if size > layout.size() && is_refused(size) {
            return std::ptr::null_mut();
        }
        // SAFETY: as in `alloc`.
        let new = unsafe { System.realloc(place, layout, size) };
        if !new.is_null() {
            advise(new, size);
            match size.checked_sub(layout.size()) {
                Some(more) => grown(more),
                None => shrunk(layout.size() - size),
            }
        }
        new
    }
}
