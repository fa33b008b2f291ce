//! Memory: what a structure adds, and what it copies of the scene.

/// What a part of a structure's memory is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Group {
    /// What the method adds.
    Structure,
    /// What it duplicates of the scene for speed: reordered or preprocessed objects.
    GeometryCopy,
}

/// A named part of a structure's memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Short name, such as `maps` or `cells`.
    pub name: &'static str,
    /// Which of the two groups it belongs to.
    pub group: Group,
    /// Bytes held, spare capacity included.
    pub bytes: usize,
}

/// The memory a built structure holds. The scene's own buffers belong to nobody.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Footprint {
    /// All parts, each once.
    pub parts: Vec<Part>,
}

impl Footprint {
    /// With one more part of what the method adds.
    #[must_use]
    pub fn structure(self, name: &'static str, bytes: usize) -> Self {
        self.with(name, Group::Structure, bytes)
    }

    /// With one more part of copied geometry.
    #[must_use]
    pub fn geometry_copy(self, name: &'static str, bytes: usize) -> Self {
        self.with(name, Group::GeometryCopy, bytes)
    }

    fn with(mut self, name: &'static str, group: Group, bytes: usize) -> Self {
        self.parts.push(Part { name, group, bytes });
        self
    }

    /// Bytes of one group.
    pub fn bytes(&self, group: Group) -> usize {
        self.parts.iter().filter(|p| p.group == group).map(|p| p.bytes).sum()
    }

    /// Bytes of all parts.
    pub fn total(&self) -> usize {
        self.parts.iter().map(|p| p.bytes).sum()
    }
}

/// Bytes that a vector holds on the heap.
pub fn vec_bytes<T>(vec: &Vec<T>) -> usize {
    vec.capacity() * size_of::<T>()
}
