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

/// Number of successive frames without compilation after which the picture is complete. The first frames have not asked for pipelines yet.
const COMPLETE: u32 = 5;

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

/// Returns the number of frames for which the stage stays covered after one for which `frames` are left.
fn left_after(frames: u32, is_compiling: bool) -> u32 {
    if is_compiling && frames > 0 { COMPLETE } else { frames.saturating_sub(1) }
}

fn cover(
    mut contexts: EguiContexts,
    (quality, compiling, area): (Res<StageQuality>, Res<Compiling>, Res<StageArea>),
    mut left: Local<u32>,
) -> Result {
    if quality.is_changed() {
        *left = if quality.now() == Quality::Beautiful { COMPLETE } else { 0 };
    }
    if *left > 0 {
        let context = contexts.ctx_mut()?;
        let layer = egui::LayerId::new(egui::Order::Background, egui::Id::new("plain sky"));
        let sky = theme::flat(theme::of_context(context).horizon);
        context.layer_painter(layer).rect_filled(area.rect, 0.0, sky);
    }
    *left = left_after(*left, compiling.0.load(Ordering::Relaxed));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sky_is_plain_until_nothing_was_compiled_for_some_frames_and_stays_away() {
        let frames = [(false, 3), (true, 50), (false, 2), (true, 1), (false, 9), (true, 9)];
        let mut left = COMPLETE;
        let covered = frames.map(|(is_compiling, count)| {
            let mut frame = || (left > 0, left = left_after(left, is_compiling)).0;
            (0..count).filter(|_| frame()).count()
        });
        assert_eq!(covered, [3, 50, 2, 1, 5, 0], "a later pipeline is that of a detail");
    }
}
