//! rays, hits
