//! Colours of the light and the dark theme, for panels and scene.
//!
//! All text has the contrast that WCAG requires, 4.5 to 1, on each background on which it is drawn. The tests check this.

use bevy::prelude::{Color, Vec3};
use bevy_egui::egui;
use bevy_egui::egui::ecolor::{
    gamma_u8_from_linear_f32, linear_f32_from_gamma_u8, linear_u8_from_linear_f32,
};
use bevy_egui::egui::{Color32, CornerRadius, Frame, Margin, Stroke};

use snakes_core::evolve::StrategyKind;
use snakes_lab::plot;
use snakes_lab::plot::{BAND_OPACITY, Role, role_color};

/// Colours and light intensities of a theme.
#[derive(Debug)]
pub struct Palette {
    /// Background of panels.
    pub panel: Color32,
    /// Background of a card or field.
    pub field: Color32,
    /// Background of a hovered field.
    pub field_hovered: Color32,
    /// Colour of text.
    pub text: Color32,
    /// Colour of explanatory text.
    pub text_weak: Color32,
    /// Accent colour: buttons, news, the best individual.
    pub accent: Color32,
    /// Colour of text on the accent colour.
    pub on_accent: Color32,
    /// Soft accent colour for selection and progress. Text on it remains readable.
    pub accent_soft: Color32,
    /// Colour of the second series in charts, such as the mean.
    pub second: Color32,
    /// Colour of problems.
    pub problem: Color32,
    /// Colour of an empty cell in the archive map.
    pub empty_cell: Color32,
    /// Red of the report, for the first, third and fifth limb.
    pub red_limb: Color,
    /// Blue of the report, for the second and fourth limb.
    pub blue_limb: Color,
    /// Pale colours of the other snakes of a generation, for the limbs that are red and blue in the best.
    pub ghosts: [Color; 2],
    /// Colour of contact forces.
    pub force: Color,
    /// Colour of bend torques.
    pub bend: Color32,
    /// Colour of twist torques.
    pub twist: Color32,
    /// Colour of torques in the positive direction, in the scene.
    pub torque_plus: Color32,
    /// Colour of torques in the negative direction, in the scene.
    pub torque_minus: Color32,
    /// Colours of the lanes, in their order: two hexadecimal digits each of red, green and blue. Colour-blind viewers can
    /// tell them apart. See [`Palette::lane_color`].
    lanes: [u32; 10],
    /// Colour of the trail.
    pub trail: Color,
    /// Colour of the spring by which the mouse pulls a limb.
    pub pull: Color,
    /// Colour of the sky at the horizon, and of the fog.
    pub horizon: Color,
    /// Colour of the sky at the zenith.
    pub zenith: Color,
    /// Colour of clouds.
    pub cloud: Color,
    /// Colour of the hills behind the haze of the horizon.
    pub hills: Color,
    /// Colour of the disc of the sun or the moon. Channels above 1 glow.
    pub sun_disc: Color,
    /// Number of stars.
    pub stars: u32,
    /// Colour of the ground.
    pub ground: Color,
    /// Colour of leaves and grass.
    pub leaves: Color,
    /// Colour of the light from the door at the end of the landing. Channels above 1 glow.
    pub lamp: Color,
    /// Colour of the grid on the ground.
    pub grid: Color,
    /// Colour of stone: a hard surface with usual friction.
    pub stair: Color,
    /// Colour of ice: a surface with little friction.
    pub ice: Color,
    /// Colour of glue: a surface with much friction.
    pub glue: Color,
    /// Colour of resin: a surface with so much friction that nothing slides.
    pub resin: Color,
    /// Colour of rubber: a hard surface from which limbs bounce.
    pub rubber: Color,
    /// Colour of a trampoline's mat: a soft surface that springs back.
    pub woven: Color,
    /// Colour of mud: a soft surface that does not spring back.
    pub mud: Color,
    /// Shade of dents in a soft surface.
    pub dent: Color,
    /// Colour of the railing and of the door at the end of the landing.
    pub wood: Color,
    /// Colour of the wall at the end of the landing, and of the posts of the finish.
    pub wall: Color,
    /// Colour of a step's edge.
    pub step_edge: Color,
    /// Colour of a step's edge below the snake: the accent's hue, but too bright to be mistaken for a limb.
    pub step_edge_lit: Color,
    /// Translucent colour of numbers on ground and risers.
    pub paint: Color,
    /// Colour of the stripes along limbs, and of the eyes.
    pub white: Color,
    /// Colour of joints, pupils and the flag's post.
    pub metal: Color,
    /// Colour of the flag at the best distance.
    pub flag: Color,
    /// Colour of text on the flag.
    pub flag_text: Color,
    /// Colour of sunlight.
    pub sun: Color,
    /// Intensity of sunlight, in lux.
    pub sun_lux: f32,
    /// Colour of ambient light.
    pub ambient: Color,
    /// Intensity of ambient light, in cd/m²: bright enough to see shadowed sides.
    pub ambient_cd_m2: f32,
}

/// Light theme.
pub const LIGHT: Palette = Palette {
    panel: Color32::from_rgb(0xf6, 0xf7, 0xfa),
    field: Color32::from_rgb(0xe5, 0xe9, 0xf0),
    field_hovered: Color32::from_rgb(0xd3, 0xda, 0xe6),
    text: Color32::from_rgb(0x1b, 0x22, 0x30),
    text_weak: Color32::from_rgb(0x52, 0x5c, 0x6e),
    accent: Color32::from_rgb(0x1a, 0x66, 0xd9),
    on_accent: Color32::from_rgb(0xff, 0xff, 0xff),
    accent_soft: Color32::from_rgb(0xb8, 0xd3, 0xfa),
    second: Color32::from_rgb(0x96, 0x58, 0x00),
    problem: Color32::from_rgb(0xbd, 0x26, 0x1d),
    empty_cell: Color32::from_rgb(0xda, 0xdf, 0xe8),
    red_limb: Color::srgb(0.86, 0.13, 0.12),
    blue_limb: Color::srgb(0.10, 0.27, 0.84),
    ghosts: [Color::srgb(0.95, 0.80, 0.78), Color::srgb(0.78, 0.84, 0.96)],
    force: Color::srgb(0.02, 0.45, 0.30),
    bend: Color32::from_rgb(0x1a, 0x66, 0xd9),
    twist: Color32::from_rgb(0xb3, 0x5c, 0x00),
    torque_plus: Color32::from_rgb(0xe0, 0x7b, 0x00),
    torque_minus: Color32::from_rgb(0x00, 0x7d, 0xd6),
    lanes: [
        0xd1781b, 0x1094e3, 0x311a56, 0x434be3, 0xe64e96, 0x666c37, 0x652019, 0x1f5073, 0x0e0dad,
        0xd80f00,
    ],
    trail: Color::srgb(0.55, 0.20, 0.65),
    pull: Color::srgb(0.80, 0.30, 0.05),
    horizon: Color::srgb(0.97, 0.93, 0.87),
    zenith: Color::srgb(0.42, 0.66, 0.92),
    cloud: Color::srgb(1.0, 0.98, 0.95),
    hills: Color::srgb(0.58, 0.68, 0.72),
    sun_disc: Color::linear_rgb(2.4, 2.1, 1.5),
    stars: 0,
    ground: Color::srgb(0.70, 0.77, 0.63),
    leaves: Color::srgb(0.40, 0.58, 0.30),
    lamp: Color::linear_rgb(1.9, 1.25, 0.55),
    grid: Color::srgba(0.0, 0.06, 0.10, 0.10),
    stair: Color::srgb(0.81, 0.80, 0.78),
    ice: Color::srgb(0.72, 0.90, 1.0),
    glue: Color::srgb(0.93, 0.60, 0.08),
    resin: Color::srgb(0.66, 0.33, 0.08),
    rubber: Color::srgb(0.52, 0.54, 0.53),
    woven: Color::srgb(0.12, 0.72, 0.66),
    mud: Color::srgb(0.42, 0.29, 0.18),
    dent: Color::srgba(0.05, 0.04, 0.05, 0.62),
    wood: Color::srgb(0.62, 0.45, 0.29),
    wall: Color::srgb(0.90, 0.88, 0.84),
    step_edge: Color::srgb(0.60, 0.57, 0.52),
    step_edge_lit: Color::srgb(0.05, 0.72, 1.0),
    paint: Color::srgba(0.06, 0.12, 0.18, 0.62),
    white: Color::srgb(0.97, 0.96, 0.93),
    metal: Color::srgb(0.16, 0.17, 0.20),
    flag: Color::srgb(1.0, 0.79, 0.28),
    flag_text: Color::srgb(0.16, 0.13, 0.08),
    sun: Color::srgb(1.0, 0.97, 0.92),
    sun_lux: 3_600.0,
    ambient: Color::srgb(0.90, 0.95, 1.0),
    ambient_cd_m2: 320.0,
};

/// Dark theme.
pub const DARK: Palette = Palette {
    panel: Color32::from_rgb(0x1d, 0x21, 0x2b),
    field: Color32::from_rgb(0x28, 0x2e, 0x3b),
    field_hovered: Color32::from_rgb(0x36, 0x3e, 0x4f),
    text: Color32::from_rgb(0xec, 0xef, 0xf4),
    text_weak: Color32::from_rgb(0xa3, 0xac, 0xbd),
    accent: Color32::from_rgb(0x4f, 0x9d, 0xf7),
    on_accent: Color32::from_rgb(0x0d, 0x13, 0x1e),
    accent_soft: Color32::from_rgb(0x31, 0x5d, 0x94),
    second: Color32::from_rgb(0xf2, 0xb1, 0x4b),
    problem: Color32::from_rgb(0xf0, 0x6a, 0x5f),
    empty_cell: Color32::from_rgb(0x12, 0x15, 0x1c),
    red_limb: Color::srgb(0.88, 0.14, 0.14),
    blue_limb: Color::srgb(0.14, 0.32, 0.95),
    ghosts: [Color::srgb(0.46, 0.35, 0.35), Color::srgb(0.32, 0.37, 0.49)],
    force: Color::srgb(0.45, 0.95, 0.70),
    bend: Color32::from_rgb(0x6c, 0xb0, 0xff),
    twist: Color32::from_rgb(0xff, 0xb8, 0x5c),
    torque_plus: Color32::from_rgb(0xff, 0xb0, 0x3b),
    torque_minus: Color32::from_rgb(0x62, 0xc0, 0xff),
    lanes: [
        0xcaa419, 0x95c6ff, 0xffffff, 0x505aea, 0xfacaa7, 0x1daea5, 0x8c5a91, 0x8092ff, 0xffff45,
        0xd0471d,
    ],
    trail: Color::srgb(0.88, 0.62, 0.98),
    pull: Color::srgb(1.0, 0.72, 0.35),
    horizon: Color::srgb(0.24, 0.27, 0.37),
    zenith: Color::srgb(0.05, 0.07, 0.15),
    cloud: Color::srgb(0.24, 0.27, 0.37),
    hills: Color::srgb(0.10, 0.13, 0.20),
    sun_disc: Color::linear_rgb(1.2, 1.25, 1.35),
    stars: 240,
    ground: Color::srgb(0.20, 0.26, 0.28),
    leaves: Color::srgb(0.14, 0.28, 0.20),
    lamp: Color::linear_rgb(1.9, 1.15, 0.45),
    grid: Color::srgba(0.75, 0.85, 1.0, 0.08),
    stair: Color::srgb(0.47, 0.49, 0.53),
    ice: Color::srgb(0.55, 0.73, 0.86),
    glue: Color::srgb(0.72, 0.46, 0.10),
    resin: Color::srgb(0.45, 0.22, 0.06),
    rubber: Color::srgb(0.30, 0.32, 0.32),
    woven: Color::srgb(0.06, 0.50, 0.47),
    mud: Color::srgb(0.27, 0.185, 0.12),
    dent: Color::srgba(0.0, 0.0, 0.0, 0.70),
    wood: Color::srgb(0.44, 0.33, 0.23),
    wall: Color::srgb(0.50, 0.52, 0.56),
    step_edge: Color::srgb(0.30, 0.33, 0.38),
    step_edge_lit: Color::srgb(0.40, 0.80, 1.0),
    paint: Color::srgba(0.85, 0.92, 1.0, 0.60),
    white: Color::srgb(0.93, 0.94, 0.96),
    metal: Color::srgb(0.10, 0.11, 0.13),
    flag: Color::srgb(1.0, 0.75, 0.28),
    flag_text: Color::srgb(0.13, 0.11, 0.07),
    sun: Color::srgb(1.0, 0.96, 0.90),
    sun_lux: 2_900.0,
    ambient: Color::srgb(0.72, 0.82, 1.0),
    ambient_cd_m2: 260.0,
};

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
        let [_, red, green, blue] = self.lanes[number % self.lanes.len()].to_be_bytes();
        Color32::from_rgb(red, green, blue)
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
