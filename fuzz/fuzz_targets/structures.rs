#![no_main]

libfuzzer_sys::fuzz_target!(init: verify::targets::work_alone(), |bytes: &[u8]| verify::targets::structures(bytes));
