//! A structure for rays of any kind.

use accel::{Accel, AnyRays};
use std::ops::Deref;

/// A scene that any ray can be traced through, by the functions of [`AnyRays`].
///
/// The mesh stays in the caller's buffers, which are borrowed.
#[derive(Debug)]
pub struct Bmssm<'s>(AnyRays<'s>);

impl<'s> Bmssm<'s> {
    pub(super) fn new(built: Box<dyn Accel + 's>) -> Self {
        Self(AnyRays::new(built))
    }
}

impl<'s> Deref for Bmssm<'s> {
    type Target = AnyRays<'s>;

    fn deref(&self) -> &AnyRays<'s> {
        &self.0
    }
}
