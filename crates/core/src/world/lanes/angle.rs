//! Angles of joints and springs from relative quaternions, without trigonometric functions.

use super::wide::Wide;

/// Returns how far a joint is beyond a limit about one axis, in radians, from the imaginary part x of its rotation about the axis and the
/// real part w; 0 within the limits, and negative beyond the lower limit. `None` if no lane is beyond a limit. The angle is
/// `2 atan(x / w)`. The addition theorem subtracts half the limit from half the angle, and the sign of the result tells whether the limit
/// is exceeded, without trigonometric functions.
#[inline(always)]
pub(super) fn beyond<const N: usize>(
    x: Wide<N>,
    w: Wide<N>,
    [sin, cos]: [Wide<N>; 2],
) -> Option<Wide<N>> {
    let (over, under) = (x * cos - w * sin, -(x * cos + w * sin));
    if !over.max(under).any_greater(Wide::ZERO) {
        return None;
    }
    let two = Wide::all(2.0);
    let above = arc(over, w * cos + x * sin) * two;
    let below = arc(under, w * cos - x * sin) * two;
    Some(above - below)
}

/// Returns the angle whose sine and cosine have this ratio if the sine is positive, else 0. With a positive sine, the cosine is not
/// negative, because neither a half angle nor half a limit is more than a quarter of a turn.
#[inline(always)]
fn arc<const N: usize>(sin: Wide<N>, cos: Wide<N>) -> Wide<N> {
    let sin = sin.max(Wide::ZERO);
    let smaller = Wide::where_less(sin, cos, sin, cos);
    let greater = Wide::where_less(sin, cos, cos, sin);
    let ratio = smaller / greater.max(Wide::all(1.0e-12));
    let square = ratio * ratio;
    // Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.49: within 2e-8 of the arc tangent for arguments up to 1.
    let mut sum = Wide::all(0.002_866_225_7);
    for coefficient in [
        -0.016_165_737,
        0.042_909_614,
        -0.075_289_64,
        0.106_562_64,
        -0.142_089,
        0.199_935_51,
        -0.333_331_45,
        1.0,
    ] {
        sum = sum * square + Wide::all(coefficient);
    }
    let angle = ratio * sum;
    let angle = Wide::where_less(sin, cos, angle, Wide::all(std::f32::consts::FRAC_PI_2) - angle);
    Wide::where_less(Wide::ZERO, sin, angle, Wide::ZERO)
}

/// Returns the angle of a spring about an axis, in radians: twice the arc sine of the imaginary part of its rotation about the axis.
#[inline(always)]
pub(super) fn of_sine<const N: usize>(sine: Wide<N>) -> Wide<N> {
    let size = sine.max(-sine);
    let cos = (Wide::ONE - size * size).max(Wide::ZERO).sqrt();
    let angle = arc(size, cos) * Wide::all(2.0);
    Wide::where_less(sine, Wide::ZERO, -angle, angle)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_beyond_a_limit_is_the_angle_minus_the_limit() {
        for limit_rad in [0.0_f32, 0.3, 1.0, 2.9, 3.1] {
            let (sin, cos) = libm::sincosf(limit_rad / 2.0);
            for number in -62..=62_i16 {
                let angle_rad = f32::from(number) * 0.05;
                let (x, w) = libm::sincosf(angle_rad / 2.0);
                let found = beyond(Wide([x]), Wide([w]), [Wide([sin]), Wide([cos])]);
                let expected = if angle_rad.abs() > limit_rad {
                    angle_rad - limit_rad.copysign(angle_rad)
                } else {
                    0.0
                };
                let found = found.map_or(0.0, |found| found.0[0]);
                assert!((found - expected).abs() < 1.0e-5, "{angle_rad} {limit_rad}: {found}");
            }
        }
    }

    #[test]
    fn a_joint_without_a_limit_is_never_beyond_it() {
        for number in -62..=62_i16 {
            let (x, w) = libm::sincosf(f32::from(number) * 0.025);
            assert!(beyond(Wide([x]), Wide([w]), [Wide([1.0]), Wide([0.0])]).is_none());
        }
    }

    #[test]
    fn the_angle_of_a_sine_is_twice_its_arc_sine() {
        for number in -100..=100_i16 {
            let sine = f32::from(number) * 0.01;
            let (found, expected) = (of_sine(Wide([sine])).0[0], 2.0 * libm::asinf(sine));
            assert!((found - expected).abs() < 1.0e-6, "{sine}: {found} instead of {expected}");
        }
    }
}
