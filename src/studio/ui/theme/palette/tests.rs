//! Contrast and distinctness of the colours.

use super::*;

#[test]
fn contrast_follows_the_wcag_formula() {
    assert!((contrast(Color32::WHITE, Color32::BLACK) - 21.0).abs() < 0.01);
    assert!((contrast(Color32::from_gray(0x77), Color32::WHITE) - 4.48).abs() < 0.01);
    assert_eq!(contrast(Color32::RED, Color32::RED), 1.0);
}

#[test]
fn text_is_readable_in_both_themes() {
    for (theme, of) in [("light", &LIGHT), ("dark", &DARK)] {
        for (what, text, ground) in [
            ("text on the panel", of.text, of.panel),
            ("text in a field", of.text, of.field),
            ("text in a field under the pointer", of.text, of.field_hovered),
            ("text on what is chosen", of.text, of.accent_soft),
            ("text on the accent", of.on_accent, of.accent),
            ("weak text on the panel", of.text_weak, of.panel),
            ("weak text in a field", of.text_weak, of.field),
            ("the accent as text", of.accent, of.panel),
            ("the second colour as text", of.second, of.panel),
            ("a problem", of.problem, of.panel),
        ] {
            let found = contrast(text, ground);
            assert!(found >= READABLE, "{theme}: {what} has {found:.2}");
        }
        for kind in StrategyKind::ALL {
            let found = contrast(of.strategy(kind), of.panel);
            assert!(found >= READABLE, "{theme}: {kind:?} has {found:.2}");
        }
    }
}

#[test]
fn text_is_readable_on_every_colour_of_the_ramp() {
    for step in 0..=100 {
        let ground = ramp(step as f32 / 100.0);
        let found = contrast(text_on(ground), ground);
        assert!(found >= READABLE, "at {step} %: {found:.2}");
    }
}

#[test]
fn charts_in_the_light_theme_match_their_exported_pictures() {
    for role in [Role::First, Role::Second, Role::Third, Role::Others, Role::Bend, Role::Twist] {
        let [red, green, blue] = role_color(role);
        assert_eq!(LIGHT.role(role), Color32::from_rgb(red, green, blue), "{role:?}");
        for of in [&LIGHT, &DARK] {
            let found = contrast(of.role(role), of.panel);
            // Minimum contrast of WCAG for graphics.
            assert!(found >= 3.0, "{role:?} has {found:.2}");
        }
    }
}

/// Matrices from linear red, green and blue to the colours that an eye without red cones, or without green cones,
/// perceives (Machado et al. 2009).
const COLOR_BLIND: [[[f32; 3]; 3]; 2] = [
    [[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]],
    [[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]],
];

/// Returns the distance of two colours in Oklab for the kind of eye that distinguishes them worst.
fn apart(one: Color32, other: Color32) -> f32 {
    let usual = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let seen = |color: Color32, eye: &[[f32; 3]; 3]| {
        let linear = egui::Rgba::from(color);
        let cones = [linear.r(), linear.g(), linear.b()];
        let [red, green, blue] =
            eye.map(|row| row.iter().zip(cones).map(|(a, b)| a * b).sum::<f32>());
        let seen = Color::linear_rgb(red.max(0.0), green.max(0.0), blue.max(0.0));
        let lab = bevy::color::Oklaba::from(seen);
        bevy::math::Vec3::new(lab.lightness, lab.a, lab.b)
    };
    let eyes = std::iter::once(&usual).chain(&COLOR_BLIND);
    eyes.map(|eye| seen(one, eye).distance(seen(other, eye))).fold(f32::MAX, f32::min)
}

#[test]
fn lanes_and_the_directions_of_a_torque_have_colours_that_color_blind_eyes_tell_apart() {
    for (theme, of) in [("light", &LIGHT), ("dark", &DARK)] {
        for number in 0..10 {
            let own = of.lane_color(number);
            // Minimum contrast of WCAG for graphics.
            assert!(contrast(own, of.panel) >= 3.0, "{theme}: lane {number}");
            for other in 0..number {
                let apart = apart(own, of.lane_color(other));
                assert!(apart > 0.075, "{theme}: lanes {number} and {other}: {apart}");
            }
        }
        assert_eq!(of.lane_color(13), of.lane_color(3), "{theme}");
        let apart = apart(of.torque_plus, of.torque_minus);
        assert!(apart > 0.2, "{theme}: directions of a torque: {apart}");
    }
}

#[test]
fn strategies_have_distinct_colours_in_both_themes() {
    for of in [&LIGHT, &DARK] {
        for (index, one) in StrategyKind::ALL.into_iter().enumerate() {
            for other in StrategyKind::ALL.into_iter().take(index) {
                let pairs =
                    of.strategy(one).to_array().into_iter().zip(of.strategy(other).to_array());
                let apart: u32 = pairs.map(|(a, b)| u32::from(a.abs_diff(b))).sum();
                assert!(apart > 60, "{one:?} and {other:?} are {apart} apart");
            }
        }
    }
}

#[test]
fn a_band_over_a_chart_has_the_hue_that_it_has_in_a_picture() {
    for palette in [&LIGHT, &DARK] {
        let color = palette.role(Role::Third);
        // Blends as the window's shader does: in linear light, with colours multiplied by their opacity.
        let band = palette.band(color);
        let left = 1.0 - f32::from(band.a()) / 255.0;
        let light = |color: Color32| color.to_array().map(linear_f32_from_gamma_u8);
        let channels = light(band).into_iter().zip(light(palette.field)).take(3);
        let seen = channels.map(|(band, over)| gamma_u8_from_linear_f32(band + over * left));
        let wanted = palette.field.lerp_to_gamma(color, BAND_OPACITY);
        let pairs = seen.zip(wanted.to_array());
        for (seen, wanted) in pairs {
            assert!(seen.abs_diff(wanted) <= 4, "{seen} instead of {wanted} in {palette:?}");
        }
    }
}

#[test]
fn species_have_colours_that_stay_apart_from_each_other_and_from_the_panel() {
    for of in [&LIGHT, &DARK] {
        for number in 0..10 {
            let own = of.role(Role::Species(number));
            assert!(contrast(own, of.panel) > 1.9, "{number}");
            for other in 0..number {
                let apart = apart(own, of.role(Role::Species(other)));
                assert!(apart > 0.1, "{number} and {other}: {apart}");
            }
            let next = apart(own, of.role(Role::Species(number + 1)));
            assert!(next > 0.19, "{number} and its neighbour: {next}");
            let found = contrast(text_on(own), own);
            assert!(found >= READABLE, "{number}: its number has {found:.2}");
        }
        assert_eq!(of.role(Role::Species(17)), of.role(Role::Species(7)));
    }
}
