//! Renders one moment of one champion, or of several side by side, without a window.

use bevy::prelude::*;

use super::offscreen::Offscreen;
use crate::studio::commands::overlay::Overlay;
use crate::studio::error::StudioError;
use crate::studio::scene::camera::view::{CameraView, FreeMargins, middle_of};
use crate::studio::stage::lane::Lane;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{StageMode, lanes};
use crate::studio::state::shares::StageLook;
use snakes_core::save::{LoadedChampion, Picture};
use snakes_lab::plot::NameTag;

/// The content and style of a picture.
#[derive(Debug, Clone)]
pub struct RenderedScene {
    /// Champions with their names, one per lane.
    pub champions: Vec<(String, LoadedChampion)>,
    /// Time that the picture shows, in simulated seconds, or `None` for the end of the rollout.
    pub at_s: Option<f64>,
    /// Size of the picture, in pixels.
    pub size: (u32, u32),
    /// Camera mode, theme and overlays.
    pub look: StageLook,
}

/// Height of a name tag's anchor point above the centre of the head, in metres.
const OVER_HEAD_M: f32 = 1.4;

/// Renders the scene. Returns the picture and, for several lanes, the name tags.
///
/// # Errors
/// No graphics driver is available, or a champion cannot be simulated.
pub fn render(scene: &RenderedScene) -> Result<(Picture, Vec<NameTag>), StudioError> {
    let mut lanes = lanes_of(&scene.champions)?;
    for lane in &mut lanes {
        if scene.look.overlays.contains(&Overlay::Trail) {
            lane.finish_lookahead();
        }
        lane.skip_to(scene.at_s.unwrap_or(f64::MAX));
    }
    let (width, height) = scene.size;
    let points = in_view(&lanes);
    let target = middle_of(points.iter().copied());
    let mut view = CameraView::of(scene.look.camera, lanes.len());
    let aspect = width as f32 / height.max(1) as f32;
    view.distance_m = view.distance_to_see(target, points, aspect, FreeMargins::default());
    let place = view.looking_at(target);
    let heads = over_heads(&lanes.iter().collect::<Vec<_>>());
    Offscreen::draw(scene.size, scene.look.theme, |studio| {
        studio.show_overlays(&scene.look.overlays);
        studio.put_on_stage(lanes);
        studio.place_camera(place);
        Ok((studio.picture()?, studio.tags_of(heads)))
    })
}

/// Builds a lane at its start for each champion.
///
/// # Errors
/// A champion cannot be simulated.
pub(super) fn lanes_of(champions: &[(String, LoadedChampion)]) -> Result<Vec<Lane>, StudioError> {
    let saved = champions.iter().enumerate();
    let champions =
        saved.map(|(index, (name, loaded))| StagedChampion::from_file(loaded, index, name));
    let (lanes, problems) = lanes(champions.collect(), &StageMode::Race, &mut []);
    match problems.into_iter().next() {
        Some(problem) => Err(StudioError::Unfit(problem.trim_end_matches('.').to_owned())),
        None => Ok(lanes),
    }
}

/// Returns the text above the head of each of several snakes, with its point in the scene, in metres. A single snake has none.
pub(super) fn over_heads(lanes: &[&Lane]) -> Vec<(Vec3, String)> {
    let text = |lane: &&Lane| {
        let head = lane.drawn_poses().next()?.translation + lane.offset();
        let text = format!("{}  {}", lane.staged.label(), lane.place_in_words());
        Some((head + Vec3::Z * OVER_HEAD_M, text))
    };
    if lanes.len() > 1 { lanes.iter().filter_map(text).collect() } else { Vec::new() }
}

/// Returns the points that a picture must show: the snakes, some of their lanes, and the lanes' width.
pub(super) fn in_view<'l>(lanes: impl IntoIterator<Item = &'l Lane>) -> Vec<Vec3> {
    /// Visible length of the lane ahead of and behind a snake, in metres.
    const AROUND_M: f32 = 3.0;
    let mut points = Vec::new();
    for lane in lanes {
        let half_width = Vec3::X * (lane.trial().stairs.width_m / 2.0);
        for pose in lane.replay.poses() {
            let at = pose.translation + lane.offset();
            let along = [Vec3::ZERO, Vec3::Y * AROUND_M, Vec3::NEG_Y * AROUND_M];
            points.extend(along.map(|along| at + along));
        }
        let middle = lane.drawn_middle() + lane.offset();
        points.extend([middle - half_width, middle + half_width]);
    }
    points
}
