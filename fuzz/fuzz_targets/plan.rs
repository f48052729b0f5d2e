//! The plan of a run.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use snakes_core::save::{parse_plan, run_name};

fuzz_target!(|text: &str| match parse_plan(Path::new("x"), text) {
    Ok(plan) => {
        assert_eq!(plan.settings.check(), Ok(()));
        assert!(!run_name(&plan).contains(['/', '\\', '.']));
    }
    Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
});
