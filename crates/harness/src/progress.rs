//! What long work reports while it goes on.

use crate::units::count;
use scenes::SceneError;
use scenes::rays::RaysId;
use std::fmt;

/// Something that long work has come to.
#[derive(Debug)]
pub enum Event<'a> {
    /// Work on a scene begins.
    SceneBegun {
        /// Its name.
        id: &'a str,
        /// Its place among the scenes, from 1 on.
        place: usize,
        /// How many scenes there are.
        of: usize,
        /// How many objects it has.
        objects: usize,
        /// What kind of objects.
        kind: &'static str,
    },
    /// What a user should know of how a scene was read.
    SceneNote {
        /// The note, a sentence.
        note: &'a str,
    },
    /// A scene is not on this machine.
    SceneSkipped {
        /// Its name.
        id: &'a str,
        /// Why.
        reason: &'a SceneError,
    },
    /// A ray set of the scene was measured in a pass.
    RaySetDone {
        /// Which.
        rays: RaysId,
        /// The pass, from 1 on.
        pass: usize,
        /// How many passes there are.
        passes: usize,
    },
    /// Exact arithmetic has decided so many rays of a set.
    RaysDecided {
        /// Which.
        rays: RaysId,
        /// How many.
        done: usize,
        /// How many there are.
        of: usize,
    },
    /// All structures were checked on a scene.
    SceneChecked {
        /// Its name.
        id: &'a str,
    },
    /// Rays from inside a closed mesh are about to be traced.
    MeshBegun {
        /// Its name.
        id: &'a str,
        /// By what its coordinates are multiplied.
        scale: f32,
    },
}

impl fmt::Display for Event<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::SceneBegun { id, place, of, objects, kind } => {
                write!(f, "{id} ({place} of {of}): {} {kind}", count(*objects as u64))
            }
            Self::SceneNote { note } => f.write_str(note),
            Self::SceneSkipped { id, reason } => write!(f, "{id}: skipped: {reason}"),
            Self::RaySetDone { rays, pass: 1, .. } => write!(f, "{rays}"),
            Self::RaySetDone { rays, pass, passes } => write!(f, "{rays}, pass {pass} of {passes}"),
            Self::RaysDecided { rays, done, of } => {
                write!(f, "{rays}: {} of {} rays decided", count(*done as u64), count(*of as u64))
            }
            Self::SceneChecked { id } => f.write_str(id),
            Self::MeshBegun { id, scale } => write!(f, "{id} × {scale}"),
        }
    }
}

/// Who is told of events.
pub trait Listener {
    /// Takes note of an event.
    fn hear(&mut self, event: &Event);
}

/// Nobody.
impl Listener for () {
    fn hear(&mut self, _: &Event) {}
}

impl<L: Listener> Listener for &mut L {
    fn hear(&mut self, event: &Event) {
        (**self).hear(event);
    }
}
