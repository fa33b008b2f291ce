//! Stands behind `accel::Accel`.
