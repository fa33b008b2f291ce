//! What is wrong with a solid.

use crate::Vec3;

/// A field of a solid that makes no sense.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{kind}: `{field}` {reason}")]
pub struct SolidError {
    /// The kind's name.
    pub kind: &'static str,
    /// The field.
    pub field: &'static str,
    /// What is wrong with it, in words.
    pub reason: String,
}

impl SolidError {
    /// Of `field` of a `kind`.
    pub fn new(kind: &'static str, field: &'static str, reason: impl Into<String>) -> Self {
        Self { kind, field, reason: reason.into() }
    }
}

/// The fields of one kind under examination.
#[derive(Clone, Copy)]
pub(super) struct Fields(pub &'static str);

impl Fields {
    pub fn finite(self, field: &'static str, values: &[f32]) -> Result<(), SolidError> {
        match values.iter().find(|value| !value.is_finite()) {
            Some(value) => Err(SolidError::new(self.0, field, format!("is {value}, which is not finite"))),
            None => Ok(()),
        }
    }

    pub fn positive(self, field: &'static str, value: f32) -> Result<(), SolidError> {
        self.finite(field, &[value])?;
        if value > 0.0 {
            return Ok(());
        }
        Err(SolidError::new(self.0, field, format!("must be above 0, not {value}")))
    }

    pub fn direction(self, field: &'static str, value: Vec3) -> Result<(), SolidError> {
        self.finite(field, &value.to_array())?;
        if value == Vec3::ZERO {
            return Err(SolidError::new(self.0, field, "must not be zero"));
        }
        Ok(())
    }

    pub fn refuse(self, field: &'static str, reason: impl Into<String>) -> Result<(), SolidError> {
        Err(SolidError::new(self.0, field, reason))
    }
}
