//! Colours of figures in the light theme.

use plotters::style::RGBColor;

use super::figure::Role;

/// Opacity of a band between two curves, on the screen and in pictures.
pub const BAND_OPACITY: f32 = 0.2;

/// Returns the colour of a role in the light theme, as red, green and blue.
pub fn role_color(role: Role) -> [u8; 3] {
    match role {
        Role::First | Role::Bend => [0x1a, 0x66, 0xd9],
        Role::Second => [0x96, 0x58, 0x00],
        Role::Third => [0x00, 0x72, 0x5c],
        Role::Others => [0x52, 0x5c, 0x6e],
        Role::Twist => [0xb3, 0x5c, 0x00],
        Role::Strategy(kind) => kind.info().color,
        Role::Share(share) => ramp(share),
        Role::Species(number) => SPECIES[number as usize % SPECIES.len()],
        Role::Red => [0xdb, 0x21, 0x1f],
        Role::Blue => [0x1a, 0x45, 0xd6],
    }
}

/// Colours of species by the last digit of their numbers, in both themes. Colour-blind people can distinguish them, best those of
/// neighbouring numbers.
const SPECIES: [[u8; 3]; 10] = [
    [0x80, 0x3a, 0x64],
    [0x64, 0x80, 0xfe],
    [0x3a, 0x9c, 0x80],
    [0x2c, 0x48, 0xb8],
    [0xf0, 0x9c, 0x1e],
    [0x64, 0x72, 0xaa],
    [0x48, 0xc6, 0x9c],
    [0xaa, 0x3a, 0x10],
    [0x2c, 0xb8, 0xfe],
    [0xd4, 0x64, 0x10],
];

/// Colours from the least to the greatest value: viridis (van der Walt and Smith, 2015). Brightness rises evenly, so the order is
/// visible without the hues.
const RAMP: [[u8; 3]; 9] = [
    [0x44, 0x01, 0x54],
    [0x47, 0x2d, 0x7b],
    [0x3b, 0x52, 0x8b],
    [0x2c, 0x72, 0x8e],
    [0x21, 0x91, 0x8c],
    [0x28, 0xae, 0x80],
    [0x5e, 0xc9, 0x62],
    [0xad, 0xdc, 0x30],
    [0xfd, 0xe7, 0x25],
];

/// Returns the colour of a value as red, green and blue. 0 stands for the least value, 1 for the greatest.
pub fn ramp(share: f32) -> [u8; 3] {
    let last = RAMP.len() - 1;
    let place = share.clamp(0.0, 1.0) * last as f32;
    let below = (place as usize).min(last - 1);
    let part = place - below as f32;
    let mix = |channel: usize| {
        let [from, to] = [RAMP[below], RAMP[below + 1]].map(|color| f32::from(color[channel]));
        (from + (to - from) * part).round() as u8
    };
    [mix(0), mix(1), mix(2)]
}

/// Returns the colour of a role for the plotting library.
pub(super) fn color_of(role: Role) -> RGBColor {
    let [red, green, blue] = role_color(role);
    RGBColor(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ramp_reaches_from_its_first_colour_to_its_last() {
        assert_eq!((ramp(0.0), ramp(1.0)), (RAMP[0], RAMP[8]));
    }
}
