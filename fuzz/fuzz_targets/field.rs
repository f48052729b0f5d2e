//! A setting by name and value, as in `--set`.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use snakes_core::evolve::{Settings, with_field};

static SETTINGS: LazyLock<Settings> = LazyLock::new(Settings::default);

fuzz_target!(|text: &str| {
    let (field, value) = text.split_once('=').unwrap_or((text, ""));
    if let Ok(settings) = with_field(&SETTINGS, field, value) {
        assert_eq!(settings.check(), Ok(()));
    }
});
