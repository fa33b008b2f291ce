//! A device: Embree's configuration, its errors and its memory.

use std::ffi::{CStr, CString, c_char, c_void};
use std::ptr::NonNull;
use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use embree4_sys::{self as sys, RTCDeviceProperty, RTCError};

/// The widest instructions that Embree may choose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Isa {
    /// SSE2.
    Sse2,
    /// SSE4.2.
    Sse42,
    /// AVX.
    Avx,
    /// AVX2.
    Avx2,
    /// AVX-512.
    Avx512,
}

impl Isa {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Sse2, Self::Sse42, Self::Avx, Self::Avx2, Self::Avx512];

    /// Its name as a setting, and in Embree's configuration.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Sse2 => "sse2",
            Self::Sse42 => "sse4.2",
            Self::Avx => "avx",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// The one of that name.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|isa| isa.id() == id)
    }
}

/// What went wrong in Embree or on the way to it.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EmbreeError {
    /// A configuration string that C can't read.
    #[error("the configuration {0:?} holds a NUL")]
    Configuration(String),
    /// No device with this configuration.
    #[error("Embree made no device from the configuration {configuration:?} (error {code})")]
    Device {
        /// What was asked for.
        configuration: String,
        /// `RTCError`.
        code: i32,
    },
    /// A call failed.
    #[error("Embree failed while {doing} (error {code}): {message}")]
    Call {
        /// What was being done.
        doing: &'static str,
        /// `RTCError`.
        code: i32,
        /// Embree's own words.
        message: String,
    },
    /// A triangle names a position that there is not.
    #[error("triangle {triangle} names position {position} of {positions}")]
    Index {
        /// The triangle's number.
        triangle: usize,
        /// The position it names.
        position: u32,
        /// How many there are.
        positions: usize,
    },
}

/// What the memory monitor has counted, in bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryUse {
    /// Held now.
    pub now: u64,
    /// The most ever held at once.
    pub peak: u64,
}

#[derive(Default)]
struct Watch {
    now: AtomicI64,
    peak: AtomicI64,
    last_error: Mutex<String>,
}

/// An Embree device, released when dropped.
pub struct Device {
    handle: NonNull<sys::RTCDeviceTy>,
    /// Embree holds a pointer to it. Moving the device moves a reference-counted pointer, which, unlike a box, claims
    /// no sole access to what it points to.
    watch: Arc<Watch>,
}

// SAFETY: Embree's devices may be used from any thread and from several at once; the watch is made
// of atomics and a mutex.
unsafe impl Send for Device {}
// SAFETY: as above.
unsafe impl Sync for Device {}

impl Device {
    /// A device that builds with `threads` threads (0 for all there are) and the best instructions of the processor.
    ///
    /// # Errors
    /// If Embree refuses the processor.
    pub fn new(threads: usize) -> Result<Self, EmbreeError> {
        Self::with_configuration(&format!("threads={threads}"))
    }

    /// A device that builds and traces with at most these instructions.
    ///
    /// # Errors
    /// If Embree refuses the processor.
    pub fn limited(threads: usize, isa: Isa) -> Result<Self, EmbreeError> {
        // `isa=` would have Embree run them on a processor without them.
        Self::with_configuration(&format!("threads={threads},max_isa={}", isa.id()))
    }

    /// A device made from a configuration string (see the manual of `rtcNewDevice`).
    ///
    /// # Errors
    /// If the string holds a NUL, or Embree refuses it or the processor.
    pub fn with_configuration(configuration: &str) -> Result<Self, EmbreeError> {
        let text =
            CString::new(configuration).map_err(|_| EmbreeError::Configuration(configuration.to_owned()))?;
        // SAFETY: `text` is NUL-terminated and outlives the call, which copies what it needs.
        let device = unsafe { sys::rtcNewDevice(text.as_ptr()) };
        let Some(handle) = NonNull::new(device) else {
            // SAFETY: null asks for the error of this thread.
            let RTCError(code) = unsafe { sys::rtcGetDeviceError(std::ptr::null_mut()) };
            return Err(EmbreeError::Device { configuration: configuration.to_owned(), code });
        };
        let device = Self { handle, watch: Arc::default() };
        let user = Arc::as_ptr(&device.watch).cast_mut().cast::<c_void>();
        // SAFETY: the handle is live. The watch stays where it is and outlives the handle: it is dropped after the
        // device's last reference is released. The functions only read through the pointer.
        unsafe {
            sys::rtcSetDeviceErrorFunction(handle.as_ptr(), Some(on_error), user);
            sys::rtcSetDeviceMemoryMonitorFunction(handle.as_ptr(), Some(on_memory), user);
        }
        device.check("making a device")?;
        Ok(device)
    }

    /// Version of the library: major, minor, patch.
    pub fn version(&self) -> (u32, u32, u32) {
        // SAFETY: the handle is live.
        let version = unsafe { sys::rtcGetDeviceProperty(self.handle.as_ptr(), RTCDeviceProperty::VERSION) };
        let version = u32::try_from(version).unwrap_or(0);
        (version / 10_000, version / 100 % 100, version % 100)
    }

    /// What Embree holds for this device, by its own memory monitor.
    pub fn memory(&self) -> MemoryUse {
        let bytes = |counter: &AtomicI64| u64::try_from(counter.load(Ordering::Relaxed)).unwrap_or(0);
        MemoryUse { now: bytes(&self.watch.now), peak: bytes(&self.watch.peak) }
    }

    /// The handle, for calls on this device.
    pub(crate) fn handle(&self) -> *mut sys::RTCDeviceTy {
        self.handle.as_ptr()
    }

    /// Fails if a call of this thread on this device has failed since the last check.
    pub(crate) fn check(&self, doing: &'static str) -> Result<(), EmbreeError> {
        // SAFETY: the handle is live.
        let code = unsafe { sys::rtcGetDeviceError(self.handle.as_ptr()) };
        if code == RTCError::NONE {
            return Ok(());
        }
        let message = self.watch.last_error.lock().unwrap_or_else(PoisonError::into_inner).clone();
        Err(EmbreeError::Call { doing, code: code.0, message })
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: the handle is live and this is our only reference. Scenes hold a `Device` and
        // release their own handles first, so Embree lets go of the watch here.
        unsafe { sys::rtcReleaseDevice(self.handle.as_ptr()) };
    }
}

/// Version of the library that is loaded: major, minor, patch.
///
/// # Errors
/// If no device can be made on this machine.
pub fn version() -> Result<(u32, u32, u32), EmbreeError> {
    Device::new(1).map(|device| device.version())
}

/// Keeps Embree's words for the next [`Device::check`].
///
/// # Safety
/// `user` must be null or point to a live [`Watch`], `message` be null or NUL-terminated.
unsafe extern "C" fn on_error(user: *mut c_void, _code: RTCError, message: *const c_char) {
    if user.is_null() || message.is_null() {
        return;
    }
    // SAFETY: by the caller's word.
    let (watch, message) = unsafe { (&*user.cast::<Watch>(), CStr::from_ptr(message)) };
    *watch.last_error.lock().unwrap_or_else(PoisonError::into_inner) = message.to_string_lossy().into_owned();
}

/// Counts an allocation (positive) or a release (negative) and lets it happen.
///
/// # Safety
/// `user` must be null or point to a live [`Watch`].
unsafe extern "C" fn on_memory(user: *mut c_void, bytes: isize, _post: bool) -> bool {
    // SAFETY: by the caller's word.
    if let Some(watch) = unsafe { user.cast::<Watch>().as_ref() } {
        let bytes = bytes as i64;
        let now = watch.now.fetch_add(bytes, Ordering::Relaxed) + bytes;
        watch.peak.fetch_max(now, Ordering::Relaxed);
    }
    true
}

/// A call that returned nothing and told no error.
pub(crate) fn no_handle(doing: &'static str) -> EmbreeError {
    EmbreeError::Call { doing, code: 0, message: "no handle and no error".to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_library_is_an_embree_4() {
        let (major, minor, _) = version().unwrap();
        assert_eq!(major, 4);
        assert!(minor < 100);
    }

    #[test]
    fn fewer_instructions_than_the_processor_has_are_taken() {
        for isa in [Isa::Sse2, Isa::Sse42] {
            Device::limited(1, isa).unwrap();
        }
        assert!(Isa::ALL.into_iter().all(|isa| Isa::from_id(isa.id()) == Some(isa)));
        assert_eq!(Isa::from_id("avx3"), None);
    }

    #[test]
    fn a_device_counts_wherever_it_is_moved() {
        let mut devices = vec![Device::new(1).unwrap()];
        devices.reserve(100);
        let moved = Box::new(devices.remove(0));
        // SAFETY: the handle is live, and the buffer goes with its geometry.
        unsafe {
            let geometry = sys::rtcNewGeometry(moved.handle(), sys::RTCGeometryType::TRIANGLE);
            let (kind, format) = (sys::RTCBufferType::VERTEX, sys::RTCFormat::FLOAT3);
            assert!(!sys::rtcSetNewGeometryBuffer(geometry, kind, 0, format, 12, 1000).is_null());
            assert!(moved.memory().now >= 12_000);
            sys::rtcReleaseGeometry(geometry);
        }
        assert!(moved.memory().peak >= 12_000);
    }

    #[test]
    fn a_configuration_with_a_nul_is_refused() {
        let error = Device::with_configuration("threads=1\0isa=avx2").err();
        assert!(matches!(error, Some(EmbreeError::Configuration(_))));
    }

    #[test]
    fn a_failed_call_is_reported_once_with_embree_s_words() {
        let device = Device::new(1).unwrap();
        // SAFETY: the handle is live; 9999 is no geometry type, which Embree reports as an error.
        let geometry = unsafe { sys::rtcNewGeometry(device.handle(), sys::RTCGeometryType(9999)) };
        assert!(geometry.is_null());
        let Err(EmbreeError::Call { doing, message, .. }) = device.check("asking for nonsense") else {
            panic!("an unknown geometry type was accepted");
        };
        assert_eq!(doing, "asking for nonsense");
        assert!(!message.is_empty());
        assert_eq!(device.check("nothing"), Ok(()));
    }
}
