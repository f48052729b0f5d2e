//! A preset.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use snakes_core::evolve::fields;
use snakes_core::save::parse_preset;

fuzz_target!(|text: &str| match parse_preset(Path::new("x"), text) {
    Ok(preset) => {
        assert_eq!(preset.settings.check(), Ok(()));
        let _ = fields(&preset.settings);
    }
    Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
});
