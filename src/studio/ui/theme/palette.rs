//! Colours of the light and the dark theme, for panels and scene.
//!
//! All text has the contrast that WCAG requires, 4.5 to 1, on each background on which it is drawn. The tests check this.

use bevy::prelude::{Color, Vec3};
use bevy_egui::egui::ecolor::{
    gamma_u8_from_linear_f32, linear_f32_from_gamma_u8, linear_u8_from_linear_f32,
};
use bevy_egui::egui::{self, Color32, CornerRadius, Frame, Margin, Stroke};

use snakes_core::evolve::StrategyKind;
use snakes_lab::plot::{self, BAND_OPACITY, Role, role_color};

/// Declares the palette: in each row a field, its type, and its value in the light and in the dark theme.
macro_rules! palette {
    ($($(#[$about:meta])* $name:ident: $kind:ty = $light:expr, $dark:expr;)*) => {
        /// Colours and light intensities of a theme.
        #[derive(Debug)]
        pub struct Palette {
            $($(#[$about])* pub $name: $kind,)*
        }

        /// Light theme.
        pub const LIGHT: Palette = Palette { $($name: $light,)* };
        /// Dark theme.
        pub const DARK: Palette = Palette { $($name: $dark,)* };
    };
}

palette! {
    /// Background of panels.
    panel: Color32 = rgb(0xf6f7fa), rgb(0x1d212b);
    /// Background of a card or field.
    field: Color32 = rgb(0xe5e9f0), rgb(0x282e3b);
    /// Background of a hovered field.
    field_hovered: Color32 = rgb(0xd3dae6), rgb(0x363e4f);
    /// Colour of text.
    text: Color32 = rgb(0x1b2230), rgb(0xeceff4);
    /// Colour of explanatory text.
    text_weak: Color32 = rgb(0x525c6e), rgb(0xa3acbd);
    /// Accent colour: buttons, news, the best individual.
    accent: Color32 = rgb(0x1a66d9), rgb(0x4f9df7);
    /// Colour of text on the accent colour.
    on_accent: Color32 = rgb(0xffffff), rgb(0x0d131e);
    /// Soft accent colour for selection and progress. Text on it remains readable.
    accent_soft: Color32 = rgb(0xb8d3fa), rgb(0x315d94);
    /// Colour of the second series in charts, such as the mean.
    second: Color32 = rgb(0x965800), rgb(0xf2b14b);
    /// Colour of problems.
    problem: Color32 = rgb(0xbd261d), rgb(0xf06a5f);
    /// Colour of an empty cell in the archive map.
    empty_cell: Color32 = rgb(0xdadfe8), rgb(0x12151c);
    /// Red of the report, for the first, third and fifth limb.
    red_limb: Color = Color::srgb(0.86, 0.13, 0.12), Color::srgb(0.88, 0.14, 0.14);
    /// Blue of the report, for the second and fourth limb.
    blue_limb: Color = Color::srgb(0.10, 0.27, 0.84), Color::srgb(0.14, 0.32, 0.95);
    /// Pale colours of the other snakes of a generation, for the limbs that are red and blue in the best.
    ghosts: [Color; 2] =
        [Color::srgb(0.95, 0.80, 0.78), Color::srgb(0.78, 0.84, 0.96)],
        [Color::srgb(0.46, 0.35, 0.35), Color::srgb(0.32, 0.37, 0.49)];
    /// Colour of contact forces.
    force: Color = Color::srgb(0.02, 0.45, 0.30), Color::srgb(0.45, 0.95, 0.70);
    /// Colour of bend torques.
    bend: Color32 = rgb(0x1a66d9), rgb(0x6cb0ff);
    /// Colour of twist torques.
    twist: Color32 = rgb(0xb35c00), rgb(0xffb85c);
    /// Colour of torques in the positive direction, in the scene.
    torque_plus: Color32 = rgb(0xe07b00), rgb(0xffb03b);
    /// Colour of torques in the negative direction, in the scene.
    torque_minus: Color32 = rgb(0x007dd6), rgb(0x62c0ff);
    /// Colours of the lanes, in their order: two hexadecimal digits each of red, green and blue. Colour-blind viewers can
    /// tell them apart. See [`Palette::lane_color`].
    lanes: [u32; 10] =
        [0xd1781b, 0x1094e3, 0x311a56, 0x434be3, 0xe64e96,
         0x666c37, 0x652019, 0x1f5073, 0x0e0dad, 0xd80f00],
        [0xcaa419, 0x95c6ff, 0xffffff, 0x505aea, 0xfacaa7,
         0x1daea5, 0x8c5a91, 0x8092ff, 0xffff45, 0xd0471d];
    /// Colour of the trail.
    trail: Color = Color::srgb(0.55, 0.20, 0.65), Color::srgb(0.88, 0.62, 0.98);
    /// Colour of the spring by which the mouse pulls a limb.
    pull: Color = Color::srgb(0.80, 0.30, 0.05), Color::srgb(1.0, 0.72, 0.35);
    /// Colour of the sky at the horizon, and of the fog.
    horizon: Color = Color::srgb(0.97, 0.93, 0.87), Color::srgb(0.24, 0.27, 0.37);
    /// Colour of the sky at the zenith.
    zenith: Color = Color::srgb(0.42, 0.66, 0.92), Color::srgb(0.05, 0.07, 0.15);
    /// Colour of clouds.
    cloud: Color = Color::srgb(1.0, 0.98, 0.95), Color::srgb(0.24, 0.27, 0.37);
    /// Colour of the hills behind the haze of the horizon.
    hills: Color = Color::srgb(0.58, 0.68, 0.72), Color::srgb(0.10, 0.13, 0.20);
    /// Colour of the disc of the sun or the moon. Channels above 1 glow.
    sun_disc: Color = Color::linear_rgb(2.4, 2.1, 1.5), Color::linear_rgb(1.2, 1.25, 1.35);
    /// Number of stars.
    stars: u32 = 0, 240;
    /// Colour of the ground.
    ground: Color = Color::srgb(0.70, 0.77, 0.63), Color::srgb(0.20, 0.26, 0.28);
    /// Colour of leaves and grass.
    leaves: Color = Color::srgb(0.40, 0.58, 0.30), Color::srgb(0.14, 0.28, 0.20);
    /// Colour of the light from the door at the end of the landing. Channels above 1 glow.
    lamp: Color = Color::linear_rgb(1.9, 1.25, 0.55), Color::linear_rgb(1.9, 1.15, 0.45);
    /// Colour of the grid on the ground.
    grid: Color = Color::srgba(0.0, 0.06, 0.10, 0.10), Color::srgba(0.75, 0.85, 1.0, 0.08);
    /// Colour of stone: a hard surface with usual friction.
    stair: Color = Color::srgb(0.81, 0.80, 0.78), Color::srgb(0.47, 0.49, 0.53);
    /// Colour of ice: a surface with little friction.
    ice: Color = Color::srgb(0.72, 0.90, 1.0), Color::srgb(0.55, 0.73, 0.86);
    /// Colour of glue: a surface with much friction.
    glue: Color = Color::srgb(0.93, 0.60, 0.08), Color::srgb(0.72, 0.46, 0.10);
    /// Colour of resin: a surface with so much friction that nothing slides.
    resin: Color = Color::srgb(0.66, 0.33, 0.08), Color::srgb(0.45, 0.22, 0.06);
    /// Colour of rubber: a hard surface from which limbs bounce.
    rubber: Color = Color::srgb(0.52, 0.54, 0.53), Color::srgb(0.30, 0.32, 0.32);
    /// Colour of a trampoline's mat: a soft surface that springs back.
    woven: Color = Color::srgb(0.12, 0.72, 0.66), Color::srgb(0.06, 0.50, 0.47);
    /// Colour of mud: a soft surface that does not spring back.
    mud: Color = Color::srgb(0.42, 0.29, 0.18), Color::srgb(0.27, 0.185, 0.12);
    /// Shade of dents in a soft surface.
    dent: Color = Color::srgba(0.05, 0.04, 0.05, 0.62), Color::srgba(0.0, 0.0, 0.0, 0.70);
    /// Colour of the railing and of the door at the end of the landing.
    wood: Color = Color::srgb(0.62, 0.45, 0.29), Color::srgb(0.44, 0.33, 0.23);
    /// Colour of the wall at the end of the landing, and of the posts of the finish.
    wall: Color = Color::srgb(0.90, 0.88, 0.84), Color::srgb(0.50, 0.52, 0.56);
    /// Colour of a step's edge.
    step_edge: Color = Color::srgb(0.60, 0.57, 0.52), Color::srgb(0.30, 0.33, 0.38);
    /// Colour of a step's edge below the snake: the accent's hue, but too bright to be mistaken for a limb.
    step_edge_lit: Color = Color::srgb(0.05, 0.72, 1.0), Color::srgb(0.40, 0.80, 1.0);
    /// Translucent colour of numbers on ground and risers.
    paint: Color = Color::srgba(0.06, 0.12, 0.18, 0.62), Color::srgba(0.85, 0.92, 1.0, 0.60);
    /// Colour of the stripes along limbs, and of the eyes.
    white: Color = Color::srgb(0.97, 0.96, 0.93), Color::srgb(0.93, 0.94, 0.96);
    /// Colour of joints, pupils and the flag's post.
    metal: Color = Color::srgb(0.16, 0.17, 0.20), Color::srgb(0.10, 0.11, 0.13);
    /// Colour of the flag at the best distance.
    flag: Color = Color::srgb(1.0, 0.79, 0.28), Color::srgb(1.0, 0.75, 0.28);
    /// Colour of text on the flag.
    flag_text: Color = Color::srgb(0.16, 0.13, 0.08), Color::srgb(0.13, 0.11, 0.07);
    /// Colour of sunlight.
    sun: Color = Color::srgb(1.0, 0.97, 0.92), Color::srgb(1.0, 0.96, 0.90);
    /// Intensity of sunlight, in lux.
    sun_lux: f32 = 3_600.0, 2_900.0;
    /// Colour of ambient light.
    ambient: Color = Color::srgb(0.90, 0.95, 1.0), Color::srgb(0.72, 0.82, 1.0);
    /// Intensity of ambient light, in cd/m²: bright enough to see shadowed sides.
    ambient_cd_m2: f32 = 320.0, 260.0;
}

/// Returns the colour with this code: two hexadecimal digits each of red, green and blue.
const fn rgb(code: u32) -> Color32 {
    let [_, red, green, blue] = code.to_be_bytes();
    Color32::from_rgb(red, green, blue)
}

/// Colour of a snake's belly, as a factor of [`Palette::white`] for red, green and blue.
pub const BELLY_TONE: Vec3 = Vec3::new(0.95, 0.80, 0.55);
/// Colour of a snake's tongue, as a factor of [`Palette::white`] for red, green and blue.
pub const TONGUE_TONE: Vec3 = Vec3::new(0.80, 0.09, 0.18);
/// Colour of a trunk, as a factor of [`Palette::leaves`] for red, green and blue.
pub const TRUNK_TONE: Vec3 = Vec3::new(1.5, 0.5, 0.9);
/// Colour of a joint's axis, as a factor of [`Palette::metal`] for red, green and blue.
pub const AXIS_TONE: Vec3 = Vec3::new(26.0, 20.0, 9.0);

/// Minimum contrast ratio of text (WCAG 2, level AA).
const READABLE: f32 = 4.5;

impl Palette {
    /// Returns the colour of a strategy in all curves, shifted towards the text colour until it is readable on the panel.
    pub fn strategy(&self, kind: StrategyKind) -> Color32 {
        self.readable(kind.info().color)
    }

    /// Returns the translucent colour of a band in a chart. Over the chart's background it looks as in an exported chart. The window
    /// blends linear light instead of colour values, which would change the hue of a simple translucent colour.
    pub fn band(&self, color: Color32) -> Color32 {
        let seen = self.field.lerp_to_gamma(color, BAND_OPACITY);
        let light = |color: Color32| color.to_array().map(linear_f32_from_gamma_u8);
        let ([r, g, b, _], over) = (light(seen), light(self.field));
        let channels = [(r, over[0]), (g, over[1]), (b, over[2])];
        let shares = channels.map(|(seen, over)| seen / over.max(1.0e-6));
        // Share of the background's light that passes through the band: so low that no channel has to be darkened further.
        let left = shares.into_iter().fold(1.0 - BAND_OPACITY, f32::min);
        let added = |(seen, over): (f32, f32)| gamma_u8_from_linear_f32(seen - over * left);
        let [r, g, b] = channels.map(added);
        // egui expects red, green and blue already multiplied by the opacity.
        Color32::from_rgba_premultiplied(r, g, b, linear_u8_from_linear_f32(1.0 - left))
    }

    /// Returns the colour of a chart series by its role.
    pub fn role(&self, role: Role) -> Color32 {
        match role {
            Role::First => self.accent,
            Role::Second => self.second,
            Role::Third => self.readable(role_color(role)),
            Role::Others => self.text_weak,
            Role::Bend => self.bend,
            Role::Twist => self.twist,
            Role::Strategy(kind) => self.strategy(kind),
            Role::Share(share) => ramp(share),
            Role::Species(_) | Role::Red | Role::Blue => {
                let [red, green, blue] = role_color(role);
                Color32::from_rgb(red, green, blue)
            }
        }
    }

    /// Returns the colour of a lane, used on the snake's collar, beside its lane, in lists and in charts. The first
    /// lane is 0; after ten lanes the colours repeat.
    pub fn lane_color(&self, number: usize) -> Color32 {
        rgb(self.lanes[number % self.lanes.len()])
    }

    /// Shifts a colour towards the text colour until it is readable on the panel.
    fn readable(&self, [red, green, blue]: [u8; 3]) -> Color32 {
        let own = Color32::from_rgb(red, green, blue);
        let mixed = (0..=20).map(|step| own.lerp_to_gamma(self.text, step as f32 / 20.0));
        let mut readable = mixed.filter(|color| contrast(*color, self.panel) >= READABLE);
        readable.next().unwrap_or(self.text)
    }

    /// Returns the frame of a card with a coloured edge.
    pub fn card(&self, edge: Color32) -> Frame {
        Frame::new()
            .fill(self.panel.gamma_multiply(0.94))
            .stroke(Stroke::new(1.0, edge))
            .corner_radius(CORNER)
            .inner_margin(Margin::symmetric(12, 8))
    }

    /// Returns the frame of a dialog, which hides the content below it.
    pub fn dialog(&self) -> Frame {
        self.card(self.accent).fill(self.panel).inner_margin(Margin::symmetric(16, 12))
    }

    /// Sets the palette's colours in egui's style.
    pub(super) fn dress(&self, visuals: &mut egui::Visuals) {
        // Both themes use the same text options. Otherwise a change of the theme would rasterize all glyphs again, and
        // text would be missing for a frame.
        visuals.text_options = egui::Visuals::dark().text_options;
        // Subpixel positioning would need four images per glyph, and not all of them could be rasterized in advance.
        visuals.text_options.subpixel_binning = false;
        visuals.panel_fill = self.panel;
        visuals.window_fill = self.panel;
        visuals.window_stroke = Stroke::new(1.0, self.field_hovered);
        visuals.extreme_bg_color = self.field;
        visuals.override_text_color = Some(self.text);
        visuals.weak_text_color = Some(self.text_weak);
        visuals.selection.bg_fill = self.accent_soft;
        visuals.selection.stroke = Stroke::new(1.0, self.text);
        visuals.widgets.inactive.weak_bg_fill = self.field;
        visuals.widgets.inactive.bg_fill = self.field;
        // A visible edge for empty check boxes.
        visuals.widgets.inactive.bg_stroke = Stroke::new(1.0, self.field_hovered);
        visuals.widgets.hovered.weak_bg_fill = self.field_hovered;
        visuals.widgets.active.weak_bg_fill = self.accent_soft;
        visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, self.field_hovered);
    }
}

/// Returns the WCAG contrast ratio of two colours, from 1 (equal) to 21 (black and white).
fn contrast(one: Color32, other: Color32) -> f32 {
    let luminance = |color: Color32| {
        let linear = egui::Rgba::from(color);
        0.2126 * linear.r() + 0.7152 * linear.g() + 0.0722 * linear.b() + 0.05
    };
    let (one, other) = (luminance(one), luminance(other));
    one.max(other) / one.min(other)
}

/// Corner radius of cards and buttons, in points.
pub(super) const CORNER: CornerRadius = CornerRadius::same(6);

/// Returns the colour of a value between 0, the minimum, and 1, the maximum: see [`plot::ramp`].
pub fn ramp(share: f32) -> Color32 {
    let [red, green, blue] = plot::ramp(share);
    Color32::from_rgb(red, green, blue)
}

/// Returns black or white, whichever is easier to read on this colour.
pub fn text_on(ground: Color32) -> Color32 {
    let texts = [Color32::BLACK, Color32::WHITE];
    if contrast(texts[0], ground) > contrast(texts[1], ground) { texts[0] } else { texts[1] }
}

#[cfg(test)]
mod tests;
