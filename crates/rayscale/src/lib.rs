//! The harness: scenes, ray sets, structures, checks, measurements, reports.
