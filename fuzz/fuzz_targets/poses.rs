//! The recorded poses of a champion: a number of frames, and their bytes in base64.
#![no_main]

use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD_NO_PAD;
use libfuzzer_sys::fuzz_target;
use snakes_core::save::parse_champion;

const SHIPPED: &str = include_str!("../../saves/first-climber.ron");

fuzz_target!(|input: (u16, u8, &[u8])| {
    let (frames, every_steps, bytes) = input;
    let (before, _) = SHIPPED.split_once("poses:").expect("the shipped champion has poses");
    let data = STANDARD_NO_PAD.encode(bytes);
    let text = format!(
        "{before}poses: Some((every_steps: {every_steps}, limbs: 5, frames: {frames}, data: \"{data}\")))"
    );
    if let Ok(loaded) = parse_champion(Path::new("x"), &text) {
        let recording = loaded.recording.expect("it has poses");
        assert_eq!(recording.frames().len(), usize::from(frames));
        let finite = |pose: &snakes_core::world::Pose| {
            pose.translation.is_finite() && pose.rotation.is_normalized()
        };
        assert!(recording.frames().flatten().all(finite));
        assert_eq!(recording.at(f32::from(frames)).len(), 5);
    }
});
