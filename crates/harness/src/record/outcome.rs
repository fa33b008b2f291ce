//! How a cell came out.

use serde::{Deserialize, Serialize};

/// How a cell came out. In a file, `outcome` is the variant and `error` its reason.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "InFile", into = "InFile")]
pub enum Outcome {
    /// Its figures are sound.
    #[default]
    Measured,
    /// The structure has no way to serve these rays or objects.
    Unsupported(String),
    /// Something went wrong; figures of the cell mean nothing.
    Failed(String),
    /// It was not tried.
    Skipped(String),
}

impl Outcome {
    /// Whether the figures are sound.
    pub fn is_measured(&self) -> bool {
        matches!(self, Self::Measured)
    }

    /// Whether something went wrong.
    pub fn is_failed(&self) -> bool {
        matches!(self, Self::Failed(_))
    }

    /// Why there are no figures, if there are none.
    pub fn reason(&self) -> Option<&str> {
        match self {
            Self::Measured => None,
            Self::Unsupported(reason) | Self::Failed(reason) | Self::Skipped(reason) => Some(reason),
        }
    }
}

/// The variant in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    Measured,
    Unsupported,
    Failed,
    Skipped,
}

/// As it is written. Records of format 1 without `outcome` have the reason alone.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct InFile {
    #[serde(default)]
    outcome: Option<Kind>,
    #[serde(default)]
    error: Option<String>,
}

impl From<Outcome> for InFile {
    fn from(outcome: Outcome) -> Self {
        let kind = match outcome {
            Outcome::Measured => Kind::Measured,
            Outcome::Unsupported(_) => Kind::Unsupported,
            Outcome::Failed(_) => Kind::Failed,
            Outcome::Skipped(_) => Kind::Skipped,
        };
        Self { outcome: Some(kind), error: outcome.reason().map(str::to_owned) }
    }
}

impl From<InFile> for Outcome {
    fn from(InFile { outcome, error }: InFile) -> Self {
        match (outcome, error) {
            (Some(Kind::Measured), _) | (None, None) => Self::Measured,
            (Some(Kind::Unsupported), reason) => Self::Unsupported(reason.unwrap_or_default()),
            (Some(Kind::Failed), reason) => Self::Failed(reason.unwrap_or_default()),
            (Some(Kind::Skipped), reason) => Self::Skipped(reason.unwrap_or_default()),
            (None, Some(reason)) => without_kind(reason),
        }
    }
}

/// The outcome of a cell that was written before outcomes were: `BuildError::Unsupported` said so in these words.
fn without_kind(reason: String) -> Outcome {
    if reason.contains(" does not serve ") { Outcome::Unsupported(reason) } else { Outcome::Failed(reason) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outcomes_come_back_as_they_were() {
        let all = [
            Outcome::Measured,
            Outcome::Unsupported("x does not serve boxes".into()),
            Outcome::Failed("no memory".into()),
            Outcome::Skipped("the time was up".into()),
        ];
        for outcome in all {
            let text = serde_json::to_string(&outcome).unwrap();
            assert_eq!(serde_json::from_str::<Outcome>(&text).unwrap(), outcome, "{text}");
        }
    }

    #[test]
    fn records_without_outcomes_are_understood() {
        let read = |text: &str| serde_json::from_str::<Outcome>(text).unwrap();
        assert_eq!(read(r#"{"error": null}"#), Outcome::Measured);
        assert!(matches!(read(r#"{"error": "embree does not serve boxes"}"#), Outcome::Unsupported(_)));
        assert!(matches!(read(r#"{"error": "the build panicked"}"#), Outcome::Failed(_)));
    }
}
