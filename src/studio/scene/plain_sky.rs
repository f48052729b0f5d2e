//! A plain sky over the stage until the graphics device can draw [`Quality::Beautiful`], which is black for seconds while it compiles.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use bevy::prelude::*;
use bevy::render::render_resource::PipelineCache;
use bevy::render::{Render, RenderApp, RenderSystems};
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

use super::quality::StageQuality;
use crate::studio::commands::quality::Quality;
use crate::studio::ui::theme;
use crate::studio::ui::viewport::StageArea;

/// Whether the graphics device compiles pipelines. The renderer, which has a world of its own, writes it.
#[derive(Resource, Debug, Clone, Default)]
struct Compiling(Arc<AtomicBool>);

/// Number of successive frames without compilation after which the picture is complete.
const COMPLETE: u32 = 5;
/// Number of frames after which the stage is shown even if a pipeline never gets ready.
const LONGEST: u32 = 3000;

pub(super) fn plugin(app: &mut App) {
    let compiling = Compiling::default();
    if let Some(renderer) = app.get_sub_app_mut(RenderApp) {
        let watch = watch.in_set(RenderSystems::Cleanup);
        renderer.insert_resource(compiling.clone()).add_systems(Render, watch);
    }
    app.insert_resource(compiling).add_systems(EguiPrimaryContextPass, cover);
}

fn watch(compiling: Res<Compiling>, pipelines: Option<Res<PipelineCache>>) {
    let waits = pipelines.is_some_and(|pipelines| pipelines.waiting_pipelines().next().is_some());
    compiling.0.store(waits, Ordering::Relaxed);
}

/// The wait for the first complete picture of a quality.
#[derive(Debug, Default)]
struct PictureWait {
    of: Option<Quality>,
    covered: u32,
    complete: u32,
}

impl PictureWait {
    /// Returns whether the stage is still to be covered in a new frame.
    fn goes_on(&mut self, quality: Quality, is_compiling: bool) -> bool {
        if self.of != Some(quality) {
            *self = Self { of: Some(quality), ..Self::default() };
        }
        let is_awaited = self.complete < COMPLETE && self.covered < LONGEST;
        let goes_on = quality == Quality::Beautiful && is_awaited;
        if goes_on {
            self.complete = if is_compiling { 0 } else { self.complete + 1 };
            self.covered += 1;
        }
        goes_on
    }
}

fn cover(
    mut contexts: EguiContexts,
    (quality, compiling, area): (Res<StageQuality>, Res<Compiling>, Res<StageArea>),
    mut wait: Local<PictureWait>,
) -> Result {
    if wait.goes_on(quality.now(), compiling.0.load(Ordering::Relaxed)) {
        let context = contexts.ctx_mut()?;
        let layer = egui::LayerId::new(egui::Order::Background, egui::Id::new("plain sky"));
        let sky = theme::flat(theme::of_context(context).horizon);
        context.layer_painter(layer).rect_filled(area.rect(), 0.0, sky);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sky_is_plain_until_a_beautiful_picture_is_complete_and_again_after_another_quality() {
        let mut wait = PictureWait::default();
        let mut covered = |quality, is_compiling: bool, frames: usize| {
            (0..frames).filter(|_| wait.goes_on(quality, is_compiling)).count()
        };
        assert_eq!(covered(Quality::Fast, true, 9), 0, "it is drawn at once");
        for _ in 0..2 {
            // The first frames have not asked for a pipeline yet.
            assert_eq!(covered(Quality::Beautiful, false, 3), 3);
            assert_eq!(covered(Quality::Beautiful, true, 50), 50);
            assert_eq!(covered(Quality::Beautiful, false, 50), 5);
            assert_eq!(covered(Quality::Beautiful, true, 9), 0, "a later pipeline is a detail");
            assert_eq!(covered(Quality::Smooth, false, 9), 0);
        }
        assert_eq!(
            covered(Quality::Beautiful, true, 9000),
            3000,
            "a pipeline that never gets ready"
        );
    }
}
