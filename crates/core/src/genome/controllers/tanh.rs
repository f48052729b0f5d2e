//! The hyperbolic tangent of many numbers at once.
//!
//! Four modules of a network compute 24 hyperbolic tangents in a step. `libm::tanhf` branches, so the processor computes one after the
//! other, which took a tenth of the time of a step. The function in this module gives the same bits without a branch, so that the compiler
//! can turn a loop over it into vector instructions.

/// Replaces each number by its hyperbolic tangent, with the bits of `libm::tanhf`. A NaN stays a NaN.
pub fn tanh_each(values: &mut [f32]) {
    for value in values {
        *value = tanh(*value);
    }
}

/// Computes tanh x by the method of FreeBSD's `s_tanhf.c` and `s_expm1f.c`, which libm follows, too. A choice between two values replaces
/// each branch. Left out are branches for arguments that cannot occur, and branches without which the result is the same.
#[inline]
fn tanh(x: f32) -> f32 {
    // Up to the size `SMALL`, t = exp(-2x) - 1 and tanh x = -t / (t + 2). Beyond it, t = exp(2x) - 1, and tanh x is t / (t + 2) up to the
    // size `MEDIUM`, then 1 - 2 / (t + 2). The two sizes are ln(5/3)/2 and ln(3)/2.
    const SMALL: f32 = f32::from_bits(0x3e82_c578);
    const MEDIUM: f32 = f32::from_bits(0x3f0c_9f54);
    // ln 2 in two parts, followed by half of ln 2 and its inverse.
    const LN_2_HIGH: f32 = f32::from_bits(0x3f31_7180);
    const LN_2_LOW: f32 = f32::from_bits(0x3717_f7d1);
    const HALF_LN_2: f32 = f32::from_bits(0x3eb1_7218);
    const INVERSE_LN_2: f32 = f32::from_bits(0x3fb8_aa3b);
    // Coefficients for exp(x) - 1 near 0: -0.0333 and 0.00158.
    const Q1: f32 = f32::from_bits(0xbd08_8868);
    const Q2: f32 = f32::from_bits(0x3acf_3010);
    // 2²³: a sum with it has no fraction, and its lowest bits are the whole number that was added to it.
    const WHOLE: f32 = 8_388_608.0;

    // From a size of 10 on, the result is 1.
    let size = if x.abs() < 10.0 { x.abs() } else { 10.0 };
    let (is_small, is_large) = (size <= SMALL, size > MEDIUM);
    let exponent = 2.0 * if is_small { -size } else { size };

    // The exponent is k ln 2 + rest, and the rest has an error.
    let quotient = INVERSE_LN_2 * exponent + 0.5;
    let nearest = (quotient + WHOLE) - WHOLE;
    let floor = if nearest > quotient { nearest - 1.0 } else { nearest };
    let k_of_small = if exponent < -HALF_LN_2 { -1.0 } else { 0.0 };
    let k = if is_small { k_of_small } else { floor };
    let (high, low) = (exponent - k * LN_2_HIGH, k * LN_2_LOW);
    let rest = high - low;
    let error = (high - rest) - low;

    // exp(rest) - 1 = rest - over
    let half = 0.5 * rest;
    let half_square = rest * half;
    let r = 1.0 + half_square * (Q1 + half_square * Q2);
    let t = 3.0 - r * half;
    let over = half_square * ((r - t) / (6.0 - rest * t));
    let over = rest * (over - error) - error - half_square;

    // exp(exponent) - 1 = 2ᵏ (rest - over + 1) - 1
    let power = f32::from_bits(((WHOLE + 127.0) + k).to_bits() << 23);
    let inverse_power = f32::from_bits(((WHOLE + 127.0) - k).to_bits() << 23);
    let sum = if k < 23.0 {
        rest - over + (1.0 - inverse_power)
    } else {
        rest - (over + inverse_power) + 1.0
    };
    let t = sum * power;

    let above = if is_small { -t } else { t };
    let fraction = if is_large { 2.0 } else { above } / (t + 2.0);
    let result = if is_large { 1.0 - fraction } else { fraction };
    if x.is_nan() { x } else { result.copysign(x) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn expect_the_bits_of_libm(patterns: impl Iterator<Item = u32>) {
        for pattern in patterns {
            let x = f32::from_bits(pattern);
            let mut values = [x];
            tanh_each(&mut values);
            let expected = libm::tanhf(x);
            let is_same = values[0].to_bits() == expected.to_bits();
            assert!(is_same || values[0].is_nan() && x.is_nan(), "tanh {x} ({pattern:#x})");
        }
    }

    #[test]
    fn every_thousandth_number_and_those_at_the_borders_have_the_bits_of_libm() {
        expect_the_bits_of_libm((0..=u32::MAX).step_by(1009));
        let borders: [u32; 13] = [
            0,
            0x0080_0000,
            0x3300_0000,
            0x3e31_7218,
            0x3e82_c578,
            0x3f05_1592,
            0x3f0c_9f54,
            0x40f9_8f5c,
            0x4115_b844,
            0x4120_0000,
            0x7f7f_ffff,
            0x7f80_0000,
            0x7fc0_0000,
        ];
        for border in borders {
            let near = border.saturating_sub(200)..=border + 200;
            expect_the_bits_of_libm(near.flat_map(|pattern| [pattern, pattern | 1 << 31]));
        }
    }

    /// Tests all numbers, which takes a minute: `cargo test --release -p snakes-core all_numbers -- --ignored`.
    #[test]
    #[ignore = "takes a minute"]
    fn all_numbers_have_the_bits_of_libm() {
        expect_the_bits_of_libm(0..=u32::MAX);
    }

    #[test]
    fn the_length_of_the_list_changes_no_bit() {
        let all: Vec<f32> = (0..29).map(|index| index as f32 * 0.37 - 5.0).collect();
        for length in 0..all.len() {
            let mut values = all[..length].to_vec();
            tanh_each(&mut values);
            let expected: Vec<f32> =
                all[..length].iter().map(|value| libm::tanhf(*value)).collect();
            assert_eq!(values, expected);
        }
    }
}
