//! Recorded poses as compact text: base64 of small numbers.
//!
//! Each pose is a position, then a rotation. A coordinate of the position is in whole millimetres, as the difference from the same limb in
//! the previous frame, in zigzag and LEB128 encoding (the variable-length integers of DWARF and Protocol Buffers). A rotation has the three
//! smaller components of its unit quaternion with ten bits each, and two bits for the index of the largest component ("smallest three"): 32
//! bits, little-endian, accurate to 0.27°.

use base64::Engine;
use base64::engine::general_purpose::STANDARD_NO_PAD as BASE64;
use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};
use crate::score::Recording;
use crate::world::{Pose, Rotation, Vector};

/// A recording, as files have it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PosesV5 {
    pub every_steps: u32,
    pub limbs: u32,
    pub frames: u32,
    pub data: String,
}

const MM_PER_M: f32 = 1000.0;
/// Greatest coordinate, in mm, beyond the reach of any limb: ten minutes at the highest speed that a trial allows are 600 km.
const LARGEST_MM: i64 = 10_000_000_000;
/// Minimum size of a pose, in bytes: one byte per coordinate, four bytes for the rotation.
const MIN_POSE_BYTES: usize = 7;
/// Greatest number of quantisation steps on either side of zero that fits into ten bits.
const TURN_STEPS: f32 = 511.0;
const TURN_MASK: u32 = 0x3ff;

impl From<&Recording> for PosesV5 {
    #[expect(clippy::cast_possible_truncation, reason = "rounded to whole millimetres on purpose")]
    fn from(recording: &Recording) -> Self {
        let mut bytes = Vec::new();
        let mut before = vec![[0_i64; 3]; recording.parts()];
        for frame in recording.frames() {
            for (pose, before) in frame.iter().zip(&mut before) {
                for (metres, before) in pose.translation.to_array().into_iter().zip(before) {
                    let mm = (metres * MM_PER_M).round() as i64;
                    write_number(mm - *before, &mut bytes);
                    *before = mm;
                }
                bytes.extend_from_slice(&packed(pose.rotation).to_le_bytes());
            }
        }
        Self {
            every_steps: recording.every_steps(),
            limbs: recording.parts() as u32,
            frames: recording.frames().len() as u32,
            data: BASE64.encode(bytes),
        }
    }
}

impl PosesV5 {
    /// Decodes the recording of a snake with `limbs` limbs.
    ///
    /// # Errors
    /// Fails if the counts do not match, if the data are too short or too long, or if a limb is impossibly far away.
    pub fn recording(&self, limbs: u32) -> Result<Recording, Invalid> {
        within("every_steps", self.every_steps, 1..=1_000_000)?;
        within("limbs", self.limbs, limbs..=limbs)?;
        let limbs = limbs as usize;
        let most = Recording::MOST_POSES / limbs.max(1);
        within("frames", self.frames as usize, 1..=most)?;
        let poses = limbs * self.frames as usize;
        let wrong = |value: &str| Invalid::new("data", value, format!("{poses} poses in base64"));
        let bytes = BASE64.decode(&self.data).map_err(|_| wrong("not base64"))?;
        if bytes.len() < poses * MIN_POSE_BYTES {
            return Err(wrong("too short"));
        }
        let mut rest = bytes.as_slice();
        let mut before = vec![[0_i64; 3]; limbs];
        let mut read = Vec::with_capacity(poses);
        for index in 0..poses {
            let at = &mut before[index % limbs];
            for mm in at.iter_mut() {
                let change = read_number(&mut rest).ok_or_else(|| wrong("damaged"))?;
                *mm = mm.saturating_add(change);
                if !(-LARGEST_MM..=LARGEST_MM).contains(mm) {
                    return Err(wrong("a place more than 10 000 km away"));
                }
            }
            let turn;
            (turn, rest) = rest.split_first_chunk().ok_or_else(|| wrong("too short"))?;
            let turn = unpacked(u32::from_le_bytes(*turn)).ok_or_else(|| wrong("damaged"))?;
            let [x, y, z] = at.map(|mm| mm as f32 / MM_PER_M);
            read.push(Pose::from_parts(Vector::new(x, y, z), turn));
        }
        if !rest.is_empty() {
            return Err(wrong("too long"));
        }
        Recording::new(self.every_steps, limbs, read).ok_or_else(|| wrong("incomplete"))
    }
}

fn write_number(number: i64, bytes: &mut Vec<u8>) {
    // In zigzag encoding, small numbers of either sign have small codes.
    let mut rest = (number.wrapping_shl(1) ^ (number >> 63)).cast_unsigned();
    loop {
        let [low, ..] = (rest & 0x7f).to_le_bytes();
        rest >>= 7;
        bytes.push(if rest == 0 { low } else { low | 0x80 });
        if rest == 0 {
            break;
        }
    }
}

/// Reads a number and removes its bytes. None if the bytes end within the number, or if the number has more than 63 bits.
fn read_number(bytes: &mut &[u8]) -> Option<i64> {
    let mut number = 0_u64;
    for shift in (0..63).step_by(7) {
        let (&byte, rest) = bytes.split_first()?;
        *bytes = rest;
        number |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some((number >> 1).cast_signed() ^ -(number & 1).cast_signed());
        }
    }
    None
}

#[expect(clippy::cast_possible_truncation, reason = "within ±511 by its construction")]
fn packed(turn: Rotation) -> u32 {
    let components = turn.to_array();
    let largest = (1..4).fold(0, |largest, index| {
        if components[index].abs() > components[largest].abs() { index } else { largest }
    });
    // A quaternion and its negative are the same rotation. The one with a positive largest component is stored.
    let sign = if components[largest] < 0.0 { -1.0 } else { 1.0 };
    let others = (0..4).filter(|&index| index != largest).map(|index| components[index] * sign);
    others.fold(largest as u32, |bits, component| {
        // None of the three smaller components is larger than 1/√2.
        let share = (component * std::f32::consts::SQRT_2).clamp(-1.0, 1.0);
        let steps = (share * TURN_STEPS).round() as i32 + TURN_STEPS as i32;
        bits << 10 | steps.cast_unsigned()
    })
}

/// Decodes a rotation. None if the three components are too large for a unit quaternion.
fn unpacked(bits: u32) -> Option<Rotation> {
    let largest = (bits >> 30) as usize;
    let mut components = [0.0; 4];
    let mut sum = 0.0;
    let places = (0..4).filter(|&index| index != largest);
    for (place, shift) in places.zip([20, 10, 0]) {
        let steps = (bits >> shift & TURN_MASK) as f32 - TURN_STEPS;
        components[place] = steps / TURN_STEPS / std::f32::consts::SQRT_2;
        sum += components[place] * components[place];
    }
    components[largest] = (1.0 - sum).max(0.0).sqrt();
    // With rounding, the squares of three equal components may add up to a little more than 1.
    (sum < 1.01).then(|| Rotation::from_array(components).normalize())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::score::Trial;

    fn recording() -> Recording {
        let trial = Trial::default();
        Recording::of(&trial.random_genome(0), &trial)
    }

    #[test]
    fn poses_are_read_back_within_a_millimetre_and_the_resolution_of_a_rotation() {
        let recording = recording();
        let file = PosesV5::from(&recording);
        assert!(file.data.len() < 16_000, "{} bytes for five seconds", file.data.len());
        let read = file.recording(5).expect("as written");
        assert_eq!(read.frames().len(), recording.frames().len());
        for (a, b) in recording.frames().flatten().zip(read.frames().flatten()) {
            assert!((a.translation - b.translation).abs().max_element() < 0.000_51);
            let angle = a.rotation.angle_between(b.rotation).to_degrees();
            // Each of the three stored components is off by up to half a step, s = √2 / 1023 / 2. With all four components equal, the
            // fourth is off by 3 s, and the angle by 2 √12 s.
            assert!(angle < 0.275, "{angle}°");
        }
    }

    #[test]
    fn numbers_of_any_size_are_read_back() {
        for number in [0, 1, -1, 63, -64, 64, 300, -100_000, i64::MAX / 2, i64::MIN / 2] {
            let mut bytes = Vec::new();
            write_number(number, &mut bytes);
            let mut rest = bytes.as_slice();
            assert_eq!((read_number(&mut rest), rest.len()), (Some(number), 0));
        }
        assert_eq!(read_number(&mut [0xff; 20].as_slice()), None, "endless");
        assert_eq!(read_number(&mut [0x80].as_slice()), None, "cut off");
    }

    #[test]
    fn damaged_poses_are_refused() {
        let good = PosesV5::from(&recording());
        let says = |edit: fn(&mut PosesV5), message: &str| {
            let mut file = good.clone();
            edit(&mut file);
            let found = file.recording(5).expect_err("refused").to_string();
            assert!(found.starts_with(message), "{found} instead of {message}");
        };
        says(|file| file.limbs = 4, "limbs is 4; allowed: 5 to 5");
        says(|file| file.frames = u32::MAX, "frames is 4294967295; allowed: 1 to 20000");
        says(|file| file.frames += 1, "data is damaged");
        says(|file| file.frames -= 1, "data is too long");
        says(|file| file.frames *= 100, "data is too short");
        says(|file| file.every_steps = 0, "every_steps is 0");
        says(|file| file.data.push('*'), "data is not base64");
        says(|file| file.data = BASE64.encode([0xff; 7000]), "data is damaged");
    }
}
