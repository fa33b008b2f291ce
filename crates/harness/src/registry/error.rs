//! What can be wrong with the naming of a structure.

/// Why no structure comes of a name.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RegistryError {
    /// No structure of this id.
    #[error("there is no structure `{id}`{}", suggest(.near))]
    Unknown {
        /// What was asked for.
        id: String,
        /// Known ids that look like it.
        near: Vec<String>,
    },
    /// A structure that this program was built without.
    #[error("structure `{id}` is not available: {reason}")]
    Absent {
        /// The structure.
        id: String,
        /// Why.
        reason: String,
    },
    /// Settings that are not `name=value`.
    #[error("structure `{text}`: `{pair}` is not a setting `name=value`, or is given twice")]
    Syntax {
        /// The whole text.
        text: String,
        /// The unreadable part.
        pair: String,
    },
    /// A setting that the structure doesn't take.
    #[error("structure `{structure}` has no setting `{setting}`{}; it takes {}", suggest(.near), list(.known))]
    UnknownSetting {
        /// The structure.
        structure: String,
        /// The setting.
        setting: String,
        /// Known settings that look like it.
        near: Vec<String>,
        /// All settings it takes.
        known: Vec<String>,
    },
    /// A value that makes no sense.
    #[error("structure `{structure}`: `{setting}`: {problem}")]
    Value {
        /// The structure.
        structure: String,
        /// The setting.
        setting: String,
        /// What is wrong with the value.
        problem: String,
    },
    /// A setting that the structure refused.
    #[error("structure {0}")]
    Refused(#[from] accel::BuildError),
}

impl RegistryError {
    /// Whether the structure is merely absent, so that a run goes on without it.
    pub fn is_absent(&self) -> bool {
        matches!(self, Self::Absent { .. })
    }
}

fn suggest(near: &[String]) -> String {
    if near.is_empty() { String::new() } else { format!("; near: {}", near.join(", ")) }
}

fn list(known: &[String]) -> String {
    if known.is_empty() { "none".to_owned() } else { known.join(", ") }
}
