//! Quality of the stage's picture: the effects of each step, and the choice of a step by the device and by the measured time of frames.
//!
//! Without a graphics card, the CPU cores that run evolution also compute every sample of every pixel. Smooth edges and sharp shadows
//! are then too expensive.

use std::time::Duration;

use bevy::anti_alias::smaa::{Smaa, SmaaPreset};
use bevy::camera::Hdr;
use bevy::core_pipeline::prepass::{DepthPrepass, NormalPrepass};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::image::ImageSampler;
use bevy::light::DirectionalLightShadowMap;
use bevy::pbr::{ContactShadows, ScreenSpaceAmbientOcclusion};
use bevy::post_process::bloom::Bloom;
use bevy::prelude::*;
use bevy::render::renderer::RenderAdapterInfo;
use bevy::render::view::ColorGrading;
use wgpu_types::DeviceType;

use crate::studio::commands::quality::Quality;
use crate::studio::schedule::FrameSet;

/// Step of quality of the stage's picture.
#[derive(Resource, Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct StageQuality {
    /// Step that the user chose; `None` for the automatic one.
    pub chosen: Option<Quality>,
    /// Step that suits the device.
    automatic: Quality,
    /// Lowest allowed step.
    least: Quality,
    /// Highest step that is offered.
    most: Quality,
    /// Maximum width and height of the map of shadows, in pixels.
    most_shadow: usize,
}

/// Width and height of the map of shadows in [`Quality::Fast`] and in all other steps, in pixels.
const SHADOW_MAPS: [usize; 2] = [1024, 2048];

impl Default for StageQuality {
    fn default() -> Self {
        let (least, most) = (Quality::Fast, Quality::Beautiful);
        let most_shadow = SHADOW_MAPS[1];
        Self { chosen: None, automatic: Quality::Smooth, least, most, most_shadow }
    }
}

impl StageQuality {
    /// Returns the quality for pictures and films without a window, which have at least smooth edges. A picture of `width` pixels shows no
    /// more of a map of shadows that is wider than twice its width.
    pub fn for_films(width: u32) -> Self {
        let most_shadow = (2 * width as usize).next_power_of_two().min(SHADOW_MAPS[1]);
        Self { least: Quality::Smooth, most_shadow, ..Self::default() }
    }

    /// Returns the steps that are offered on this device. A driver without a graphics card compiles the programs of the highest step for
    /// minutes, while the window stands still, and needs gigabytes for them.
    pub fn offered(&self) -> &'static [Quality] {
        &Quality::ALL[..=self.most as usize]
    }

    /// Suits a type of device.
    fn suit(&mut self, device: DeviceType) {
        self.automatic = for_device(device);
        self.most = if device == DeviceType::Cpu { Quality::Smooth } else { Quality::Beautiful };
    }

    /// Chooses the next of the offered steps. The last one is followed by the first.
    pub fn choose_next(&mut self) {
        let offered = self.offered();
        self.chosen = Some(offered[(self.now() as usize + 1) % offered.len()]);
    }

    /// Returns the step of the stage's picture.
    pub fn now(&self) -> Quality {
        self.chosen.unwrap_or(self.automatic).max(self.least)
    }
}

/// Components of a camera that only [`Quality::Beautiful`] has.
type Effects =
    (Hdr, Smaa, ScreenSpaceAmbientOcclusion, ContactShadows, Bloom, DepthPrepass, NormalPrepass);

/// Exposure, in stops, and saturation that make up for what tone mapping takes.
const EXPOSURE_STOPS: f32 = 0.85;
const SATURATION: f32 = 1.15;
/// Duration over which frames are averaged.
const WATCHED: Duration = Duration::from_secs(2);
/// Duration of a frame from which the automatic step becomes lower: slower than 30 frames per second, with a margin.
const TOO_SLOW: Duration = Duration::from_millis(37);
/// Duration of a frame that is not counted: the window was hidden, or the program was stopped.
const PAUSE: Duration = Duration::from_millis(500);
/// Number of averages in a row that are too slow before the automatic step becomes lower. The first frames of a step compile pipelines.
const TIMES: u32 = 3;

/// Sum of the durations of frames since the last average.
#[derive(Debug, Default)]
struct FrameWatch {
    frames: u32,
    sum: Duration,
    slow: u32,
}

impl FrameWatch {
    /// Counts a frame, and returns whether frames have been too slow for long.
    fn is_slow_after(&mut self, frame: Duration) -> bool {
        if frame > PAUSE {
            return false;
        }
        (self.frames, self.sum) = (self.frames + 1, self.sum + frame);
        if self.sum < WATCHED {
            return false;
        }
        let is_slow = self.sum > TOO_SLOW * self.frames;
        *self = Self { slow: if is_slow { self.slow + 1 } else { 0 }, ..Self::default() };
        self.slow >= TIMES
    }
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<StageQuality>()
        .add_systems(PreStartup, suit_device)
        .add_systems(Update, equip_cameras.in_set(FrameSet::Draw))
        .add_systems(Last, filter_plainly);
}

/// Adds the choice of a lower step for a window whose frames take too long.
pub(super) fn watch_frames(app: &mut App) {
    app.add_systems(Update, lower.in_set(FrameSet::Draw).before(equip_cameras));
}

/// Returns the step that suits a type of device. A small integrated graphics card draws smooth edges at full speed, but not every effect.
fn for_device(device: DeviceType) -> Quality {
    match device {
        DeviceType::Cpu => Quality::Fast,
        DeviceType::DiscreteGpu => Quality::Beautiful,
        _ => Quality::Smooth,
    }
}

fn suit_device(mut quality: ResMut<StageQuality>, adapter: Res<RenderAdapterInfo>) {
    quality.suit(adapter.0.device_type);
}

/// Takes anisotropic filtering from new textures without a graphics card. Mesa's software driver adds up every texel below a pixel. With
/// several samples per pixel, the pixels along the edges of large, flat surfaces cover millions of them, and a frame took minutes.
fn filter_plainly(
    adapter: Res<RenderAdapterInfo>,
    mut events: MessageReader<AssetEvent<Image>>,
    mut images: ResMut<Assets<Image>>,
) {
    for event in events.read().filter(|_| adapter.0.device_type == DeviceType::Cpu) {
        let AssetEvent::Added { id } = event else { continue };
        // The renderer takes the texture later in the same frame, so it needs no second notice.
        if let Some(ImageSampler::Descriptor(sampler)) =
            images.get_mut_untracked(*id).map(|image| &mut image.sampler)
        {
            sampler.anisotropy_clamp = 1;
        }
    }
}

/// Lowers the automatic step while frames take too long.
fn lower(mut quality: ResMut<StageQuality>, mut watch: Local<FrameWatch>, time: Res<Time<Real>>) {
    if watch.is_slow_after(time.delta()) && quality.chosen.is_none() {
        *watch = FrameWatch::default();
        quality.automatic = Quality::ALL[(quality.automatic as usize).saturating_sub(1)];
    }
}

/// Gives new cameras of the scene the effects of the step, and all of them and the light when the step changes.
fn equip_cameras(
    quality: Res<StageQuality>,
    cameras: Query<(Entity, Ref<Camera3d>)>,
    mut suns: Query<&mut DirectionalLight>,
    mut equipped: Local<Option<Quality>>,
    mut commands: Commands,
) {
    let now = quality.now();
    let has_changed = equipped.replace(now) != Some(now);
    for (camera, scene) in &cameras {
        if has_changed || scene.is_added() {
            equip(&mut commands.entity(camera), now);
        }
    }
    if has_changed {
        suns.iter_mut().for_each(|mut sun| sun.contact_shadows_enabled = now == Quality::Beautiful);
        let size = SHADOW_MAPS[usize::from(now != Quality::Fast)].min(quality.most_shadow);
        commands.insert_resource(DirectionalLightShadowMap { size });
    }
}

/// Gives a camera the effects of a step.
fn equip(camera: &mut EntityCommands, quality: Quality) {
    match quality {
        Quality::Fast | Quality::Smooth => {
            let msaa = if quality == Quality::Fast { Msaa::Off } else { Msaa::Sample4 };
            camera.remove::<Effects>().insert((msaa, Tonemapping::None, ColorGrading::default()));
        }
        Quality::Beautiful => {
            let effects: Effects = (
                Hdr,
                Smaa { preset: SmaaPreset::High },
                ScreenSpaceAmbientOcclusion::default(),
                ContactShadows::default(),
                Bloom { intensity: 0.12, ..Bloom::NATURAL },
                DepthPrepass,
                NormalPrepass,
            );
            // Ambient occlusion needs a picture with one sample per pixel.
            camera.insert((Msaa::Off, Tonemapping::TonyMcMapface, grading(), effects));
        }
    }
}

/// Returns the grading that gives a tone-mapped picture the brightness and the colours of one without tone mapping.
fn grading() -> ColorGrading {
    let mut grading = ColorGrading::default();
    (grading.global.exposure, grading.global.post_saturation) = (EXPOSURE_STOPS, SATURATION);
    grading
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn preferences_have_a_name_for_each_step() {
        assert_eq!(Quality::ALL.map(Quality::name), snakes_core::save::QUALITIES);
    }

    #[test]
    fn each_device_has_its_first_step_and_offers_beauty_only_with_a_graphics_card() {
        assert_eq!(StageQuality::default().now(), Quality::Smooth, "before the device is known");
        let [fast, smooth, beautiful] = Quality::ALL;
        for (device, steps) in [
            (DeviceType::Cpu, [fast, smooth, fast, smooth]),
            (DeviceType::DiscreteGpu, [beautiful, fast, smooth, beautiful]),
            (DeviceType::IntegratedGpu, [smooth, beautiful, fast, smooth]),
            (DeviceType::VirtualGpu, [smooth, beautiful, fast, smooth]),
            (DeviceType::Other, [smooth, beautiful, fast, smooth]),
        ] {
            let mut quality = StageQuality::default();
            quality.suit(device);
            let chosen = [(); 4].map(|()| {
                let now = quality.now();
                quality.choose_next();
                now
            });
            assert_eq!(chosen, steps, "{device:?}");
        }
    }

    #[test]
    fn frames_that_are_slow_for_long_are_noticed_and_a_pause_is_not() {
        let slow_after = |ms: u64, frames: usize| {
            let mut watch = FrameWatch::default();
            (0..frames).any(|_| watch.is_slow_after(Duration::from_millis(ms)))
        };
        assert!(!slow_after(17, 10_000), "60 frames per second");
        assert!(!slow_after(34, 10_000), "30 frames per second");
        assert!(slow_after(50, 130) && !slow_after(50, 100), "six seconds at 20 frames per second");
        assert!(!slow_after(900, 100), "a hidden window");
    }
}
