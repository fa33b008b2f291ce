//! Ending work that is no longer wanted.

use std::fmt;

/// Who is asked, now and then and by any thread, whether work is to end.
#[derive(Clone, Copy)]
pub struct Cancel<'c>(&'c (dyn Fn() -> bool + Sync));

impl<'c> Cancel<'c> {
    /// Nobody: the work goes on to its end.
    pub const NEVER: Cancel<'static> = Cancel(&|| false);

    /// When this says so. It is called often and must be quick.
    pub const fn when(asked: &'c (dyn Fn() -> bool + Sync)) -> Self {
        Self(asked)
    }

    /// Whether to end.
    pub fn is_asked(&self) -> bool {
        (self.0)()
    }
}

impl fmt::Debug for Cancel<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Cancel")
    }
}
