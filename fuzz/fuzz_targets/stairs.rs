//! A file of stairs.
#![no_main]

use std::path::Path;

use libfuzzer_sys::fuzz_target;
use snakes_core::save::parse_stairs;

fuzz_target!(|text: &str| match parse_stairs(Path::new("x"), text) {
    Ok(named) => {
        let stairs = named.stairs;
        assert_eq!(snakes_core::schema::check(&stairs), Ok(()));
        // Stairs from an allowed file are finite, and their surface is nowhere below the ground.
        for solid in stairs.solids() {
            assert!(solid.half_m.min_element() > 0.0 && solid.pose.translation.is_finite(), "{solid:?}");
        }
        for [y_m, z_m] in stairs.outline_m() {
            assert!(y_m.is_finite() && z_m >= 0.0 && stairs.surface_z_m(0.0, y_m) >= -1.0e-3);
        }
    }
    Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
});
