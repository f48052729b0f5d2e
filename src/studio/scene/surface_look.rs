//! Computes how a surface looks from its settings: ice, glue, mud, trampoline, rubber, stone, and mixtures of them.
//!
//! The same settings always look the same, and a small change of a setting causes a small change of the look. The
//! physics does not use the look.

use bevy::prelude::*;

use crate::studio::ui::theme::Palette;
use snakes_core::world::Surface;

/// Look of a surface. All fields are shares from 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SurfaceLook {
    /// Shares of the layers on the stone, in the order in which they cover each other:
    /// ice, pale, for little friction; glue, amber, for much friction; rubber, with flecks, for a hard surface from which
    /// limbs bounce; a woven mat, for a surface that yields deeply and springs back; mud, for a surface that yields
    /// without springing back, and damps.
    pub layers: [f32; 5],
    /// Share of resin in the colour of glue: darker, for so much friction that nothing slides.
    pub resin: f32,
    /// Softness of the surface: how far limbs sink in and leave dents.
    pub soft: f32,
    /// Share of a wet film, for a surface that creeps under load.
    pub wet: f32,
    /// Share of the grains of stone or dust, which ice, glue and mud cover.
    pub speckle: f32,
    /// Roughness of the surface's material; 0 is a mirror.
    pub roughness: f32,
    /// Reflectance of the surface's material.
    pub gloss: f32,
}

/// Number of steps of each share in [`SurfaceLook::key`]: finer than the eye can distinguish.
const LEVELS: f32 = 32.0;

impl SurfaceLook {
    /// Computes the look of a surface with these settings.
    pub fn of(surface: &Surface) -> Self {
        let friction = surface.friction.max(0.0);
        let ice = 1.0 - log_share(friction, 0.05, 0.7);
        let glue = log_share(friction, 1.3, 5.0);
        let resin = log_share(friction, 5.0, 150.0);
        let soft = log_share(surface.soft_cfm_m_s_per_n, 3.0e-5, 0.014);
        let springs_back = share(surface.soft_erp, 0.2, 0.85);
        let woven = log_share(surface.soft_cfm_m_s_per_n, 0.0014, 0.056) * springs_back;
        // Impacts slower than the bounce velocity do not bounce, and few are faster than 10 m/s.
        let bounce = surface.bounce * (1.0 - share(surface.bounce_velocity_m_s, 0.5, 10.0));
        let rubber = share(bounce, 0.0, 0.7);
        let wet = log_share(surface.slip_m_s_per_n, 3.0e-4, 0.03);
        let damped = share(surface.dampen_per_s, 0.0, 2.0).max(wet * 0.5);
        let hard_damped = share(surface.dampen_per_s, 0.0, 10.0);
        let sinks = soft * (1.0 - springs_back) * (0.3 + 0.7 * damped);
        let mud = 1.0 - (1.0 - sinks) * (1.0 - 0.7 * hard_damped);

        let layers = [ice, glue, rubber, woven, mud];
        let through = |stone: f32, own: [f32; 5]| {
            own.into_iter().zip(layers).fold(stone, |below, (own, covers)| below.lerp(own, covers))
        };
        let dry_roughness = through(0.95, [0.10, 0.22, 0.70, 0.62, 0.80]);
        Self {
            layers,
            resin,
            soft,
            wet,
            speckle: through(1.0, [0.0, 0.0, 0.2, 0.0, 0.1]),
            roughness: dry_roughness.lerp(dry_roughness.min(0.28), wet),
            gloss: through(0.2, [1.0, 0.55, 0.3, 0.4, 0.3]).max(wet * 0.6),
        }
    }

    /// Returns the colour of the surface in a theme.
    pub fn tint(&self, palette: &Palette) -> Color {
        let glue = palette.glue.mix(&palette.resin, self.resin);
        let layers = [palette.ice, glue, palette.rubber, palette.woven, palette.mud];
        let layers = layers.into_iter().zip(self.layers);
        let dry = layers.fold(palette.stair, |below, (own, covers)| below.mix(&own, covers));
        // Wetness darkens a surface, but not ice.
        let soaked = 1.0 - 0.22 * self.wet * (1.0 - self.layers[0]);
        let linear = dry.to_linear();
        Color::linear_rgb(linear.red * soaked, linear.green * soaked, linear.blue * soaked)
    }

    /// Returns a key that is equal for looks that the eye cannot distinguish.
    pub fn key(&self) -> [u8; 11] {
        let Self { layers: [ice, glue, rubber, woven, mud], resin, soft, wet, .. } = *self;
        [ice, glue, rubber, woven, mud, resin, soft, wet, self.speckle, self.roughness, self.gloss]
            .map(|share| (share * LEVELS).round() as u8)
    }
}

/// Returns the position of a value in a range: 0 up to `from`, 1 from `to` on.
fn share(value: f32, from: f32, to: f32) -> f32 {
    ((value - from) / (to - from)).clamp(0.0, 1.0)
}

/// As [`share`], but on a logarithmic scale, which the sliders of these settings also have.
fn log_share(value: f32, from: f32, to: f32) -> f32 {
    share(libm::logf(value.max(1.0e-9)), libm::logf(from), libm::logf(to))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::ui::theme::Theme;
    use snakes_core::save::load_preset;

    fn shipped(name: &str) -> Surface {
        load_preset(name).expect("shipped").settings.trial.surface
    }

    /// Returns the surfaces that a picture must make distinguishable without labels.
    fn surfaces() -> [(&'static str, Surface); 6] {
        [
            ("stone", Surface::default()),
            ("ice", shipped("ice")),
            ("glue", Surface { friction: 5.0, ..Surface::default() }),
            ("mud", shipped("mud")),
            ("trampoline", shipped("trampoline")),
            ("rubber", shipped("rubber")),
        ]
    }

    #[test]
    fn each_shipped_surface_has_the_look_of_its_name() {
        let look = |of: &str| {
            let (_, surface) =
                surfaces().into_iter().find(|(name, _)| *name == of).expect("in the list");
            SurfaceLook::of(&surface)
        };
        let of = |name: &str| look(name).layers;
        let [ice, glue, rubber, woven, mud] = [0, 1, 2, 3, 4];
        assert!(of("ice")[ice] > 0.95 && look("ice").roughness < 0.15 && look("ice").gloss > 0.95);
        assert!(of("glue")[glue] > 0.95 && look("glue").roughness < 0.3);
        assert!(of("mud")[mud] > 0.8 && look("mud").wet > 0.3 && look("mud").soft > 0.95);
        assert!(of("trampoline")[woven] > 0.95 && of("trampoline")[mud] < 0.05);
        assert!(of("rubber")[rubber] > 0.7 && of("rubber")[woven] < 0.1);
        let stone = look("stone");
        assert!(stone.speckle > 0.95 && stone.roughness > 0.9 && stone.soft == 0.0, "{stone:?}");
    }

    #[test]
    fn surfaces_have_distinct_colours_in_both_themes() {
        for theme in [Theme::Light, Theme::Dark] {
            let tints = surfaces().map(|(name, surface)| {
                let tint: Oklaba = SurfaceLook::of(&surface).tint(theme.palette()).into();
                (name, tint)
            });
            for (index, (one, a)) in tints.iter().enumerate() {
                for (other, b) in &tints[..index] {
                    let apart = Vec3::new(a.lightness - b.lightness, a.a - b.a, a.b - b.b).length();
                    assert!(apart > 0.08, "{one} and {other} are {apart} apart, {theme:?}");
                }
            }
        }
    }

    #[test]
    fn the_look_follows_every_slider_without_jumps() {
        type Slider = (&'static str, f32, f32, fn(&mut Surface, f32));
        let sliders: [Slider; 6] = [
            ("friction", 0.03, 150.0, |surface, value| surface.friction = value),
            ("softness", 1.0e-4, 0.5, |surface, value| surface.soft_cfm_m_s_per_n = value),
            ("springiness", 0.05, 1.0, |surface, value| {
                (surface.soft_cfm_m_s_per_n, surface.soft_erp) = (0.05, value);
            }),
            ("creep", 1.0e-3, 0.1, |surface, value| surface.slip_m_s_per_n = value),
            ("damping", 0.05, 10.0, |surface, value| surface.dampen_per_s = value),
            ("bounce", 0.01, 0.7, |surface, value| surface.bounce = value),
        ];
        const PARTS: i32 = 200;
        for (name, least, most, set) in sliders {
            let looks: Vec<SurfaceLook> = (0..=PARTS)
                .map(|part| {
                    let mut surface = Surface::default();
                    let share = part as f32 / PARTS as f32;
                    set(&mut surface, least * libm::powf(most / least, share));
                    SurfaceLook::of(&surface)
                })
                .collect();
            for pair in looks.windows(2) {
                let steps = pair[0].key().into_iter().zip(pair[1].key());
                let most = steps.map(|(a, b)| a.abs_diff(b)).max().unwrap_or(0);
                assert!(most <= 3, "{name} jumps: {:?} and {:?}", pair[0], pair[1]);
            }
            assert_ne!(looks[0].key(), looks[PARTS as usize].key(), "{name} is not seen");
        }
    }
}
