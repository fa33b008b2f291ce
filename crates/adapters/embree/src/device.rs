//! A device: Embree's configuration, its errors and its memory.

use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ptr::NonNull;
use std::sync::atomic::{AtomicI64, Ordering};
use std::sync::{Mutex, PoisonError};

use crate::sys;

/// Environment variable whose value is added to every device's configuration, such as `isa=avx2`.
pub const CONFIG_VARIABLE: &str = "RAYSCALE_EMBREE_CONFIG";

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
    /// Boxed so that it stays where Embree was told it is.
    watch: Box<Watch>,
}

// SAFETY: Embree's devices may be used from any thread and from several at once; the watch is made
// of atomics and a mutex.
unsafe impl Send for Device {}
// SAFETY: as above.
unsafe impl Sync for Device {}

impl Device {
    /// A device that builds with `threads` threads (0 for all there are).
    ///
    /// # Errors
    /// If Embree refuses the configuration or the processor.
    pub fn new(threads: usize) -> Result<Self, EmbreeError> {
        let mut configuration = format!("threads={threads}");
        if let Ok(more) = std::env::var(CONFIG_VARIABLE)
            && !more.is_empty()
        {
            configuration.push(',');
            configuration.push_str(&more);
        }
        Self::with_configuration(&configuration)
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
            let code = unsafe { sys::rtcGetDeviceError(std::ptr::null_mut()) };
            return Err(EmbreeError::Device { configuration: configuration.to_owned(), code });
        };
        let device = Self { handle, watch: Box::default() };
        let user = std::ptr::from_ref::<Watch>(&device.watch).cast_mut().cast::<c_void>();
        // SAFETY: the handle is live, and the watch outlives it: it is boxed, and dropped after the
        // device's last reference is released.
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
        let version =
            unsafe { sys::rtcGetDeviceProperty(self.handle.as_ptr(), sys::RTC_DEVICE_PROPERTY_VERSION) };
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
        if code == sys::RTC_ERROR_NONE {
            return Ok(());
        }
        let message = self.watch.last_error.lock().unwrap_or_else(PoisonError::into_inner).clone();
        Err(EmbreeError::Call { doing, code, message })
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
unsafe extern "C" fn on_error(user: *mut c_void, _code: c_int, message: *const c_char) {
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
    fn a_configuration_with_a_nul_is_refused() {
        let error = Device::with_configuration("threads=1\0isa=avx2").err();
        assert!(matches!(error, Some(EmbreeError::Configuration(_))));
    }

    #[test]
    fn a_failed_call_is_reported_once_with_embree_s_words() {
        let device = Device::new(1).unwrap();
        // SAFETY: the handle is live; 9999 is no geometry type, which Embree reports as an error.
        let geometry = unsafe { sys::rtcNewGeometry(device.handle(), 9999) };
        assert!(geometry.is_null());
        let Err(EmbreeError::Call { doing, message, .. }) = device.check("asking for nonsense") else {
            panic!("an unknown geometry type was accepted");
        };
        assert_eq!(doing, "asking for nonsense");
        assert!(!message.is_empty());
        assert_eq!(device.check("nothing"), Ok(()));
    }
}
