//! Which ray-triangle intersector a cell's hits are of.

use primitives::KernelId;
use serde::{Deserialize, Serialize};
use std::fmt;

/// A ray-triangle intersector, as records name it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub enum Intersector {
    /// One of the suite's kernels.
    BuiltIn(KernelId),
    /// That of an external structure.
    External,
    /// A kernel that this program doesn't know, by the name that another version gave it.
    Unknown(String),
}

/// What records call the intersector of an external structure.
const EXTERNAL: &str = "own";

impl Intersector {
    /// Its name in records and tables.
    pub fn name(&self) -> &str {
        match self {
            Self::BuiltIn(kernel) => kernel.id(),
            Self::External => EXTERNAL,
            Self::Unknown(name) => name,
        }
    }
}

impl fmt::Display for Intersector {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

impl From<String> for Intersector {
    fn from(name: String) -> Self {
        match KernelId::from_id(&name) {
            Some(kernel) => Self::BuiltIn(kernel),
            None if name == EXTERNAL => Self::External,
            None => Self::Unknown(name),
        }
    }
}

impl From<Intersector> for String {
    fn from(intersector: Intersector) -> Self {
        intersector.name().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_come_back_as_they_were() {
        for kernel in KernelId::ALL {
            assert_eq!(Intersector::from(kernel.id().to_owned()), Intersector::BuiltIn(kernel));
        }
        for name in ["own", "moller-trumbore", "that-of-next-year"] {
            assert_eq!(String::from(Intersector::from(name.to_owned())), name);
        }
        assert_eq!(Intersector::from("own".to_owned()), Intersector::External);
    }
}
