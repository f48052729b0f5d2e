//! Messages between machines.
#![no_main]

use libfuzzer_sys::fuzz_target;
use snakes_cluster::kinds_of_message;

fuzz_target!(|bytes: &[u8]| {
    if let Err(error) = kinds_of_message(bytes) {
        assert!(!error.to_string().contains('\n'));
    }
});
