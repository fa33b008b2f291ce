//! What modelling costs: a curved scene as its true objects and tessellated at rising levels, each with its time for a ray, its
//! bytes, and its errors against the true surface, and which level an image needs ("model only what a scene requires").

#![forbid(unsafe_code)]

mod errors;
mod page;
mod record;
mod study;
mod tessellate;

pub use errors::Errors;
pub use page::{charts, conclusions, page, table};
pub use record::{Form, Model, ModelRow, SceneRows};
pub use study::{Plan, StudyError, run};
pub use tessellate::{Tessellation, segments, tessellate};
