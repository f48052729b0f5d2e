//! A picture of one moment, without a window: of a champion, or of several side by side.

use bevy::prelude::*;

use super::StudioError;
use super::exhibit::Exhibit;
use super::lane::Lane;
use super::look::Theme;
use super::offscreen::Offscreen;
use super::overlay::{Overlay, Overlays};
use super::stage::lanes;
use super::view::{Shot, View};
use crate::save::{LoadedChampion, Picture};

/// What is to be drawn.
#[derive(Debug, Clone)]
pub struct Scene {
    /// The champions and what they are called, one lane for each.
    pub champions: Vec<(String, LoadedChampion)>,
    /// The moment, in simulated seconds; without one, the end.
    pub at_s: Option<f64>,
    /// Size of the picture, in pixels.
    pub size: (u32, u32),
    /// From where it is looked at: "follow", "side" or "top".
    pub camera: Shot,
    /// Light or dark.
    pub theme: Theme,
    /// What is drawn over it.
    pub overlays: Vec<Overlay>,
}

/// A name over a head.
#[derive(Debug, Clone, PartialEq)]
pub struct Tag {
    /// What it says.
    pub text: String,
    /// The middle of its lower edge, in pixels from the picture's top left.
    pub at: (f32, f32),
}

/// A tag's anchor over a head, in metres over the limb's centre.
const OVER_HEAD_M: f32 = 1.4;

/// Draws a moment. With the picture come the names over the heads, if there are several.
///
/// # Errors
/// There is no graphics driver, or a champion cannot be built.
pub fn render(scene: &Scene) -> Result<(Picture, Vec<Tag>), StudioError> {
    let saved = scene.champions.iter().enumerate();
    let exhibits = saved.map(|(index, (name, loaded))| Exhibit::saved(loaded, index, name));
    let (mut lanes, problems) = lanes(exhibits.collect());
    if let Some(problem) = problems.into_iter().next() {
        return Err(StudioError::Unfit(problem.trim_end_matches('.').to_owned()));
    }
    for lane in &mut lanes {
        if scene.overlays.contains(&Overlay::Trail) {
            lane.know_what_comes();
        }
        lane.skip_to(scene.at_s.unwrap_or(f64::MAX));
    }
    let (width, height) = scene.size;
    let place = overview(&lanes, scene.camera, width as f32 / height.max(1) as f32);
    let heads: Vec<(Vec3, String)> = lanes
        .iter()
        .filter(|_| lanes.len() > 1)
        .filter_map(|lane| {
            let head = lane.drawn_poses().next()?.translation + lane.offset();
            let text = format!("{}  {:.1} m", lane.exhibit().label(), lane.drawn_middle().y);
            Some((head + Vec3::Z * OVER_HEAD_M, text))
        })
        .collect();
    Offscreen::draw(scene.size, scene.theme, |studio| {
        let world = studio.app.world_mut();
        let mut overlays = world.resource_mut::<Overlays>();
        scene.overlays.iter().for_each(|overlay| overlays.toggle(*overlay));
        for lane in lanes {
            let place = Transform::from_translation(lane.offset());
            world.spawn((lane, place, Visibility::default()));
        }
        studio.look_from(place);
        let picture = studio.picture()?;
        let places = studio.places_of(heads.iter().map(|(head, _)| *head));
        let tags = heads.iter().zip(places).filter_map(|((_, text), place)| {
            let at = place?;
            Some(Tag { text: text.clone(), at: (at.x, at.y) })
        });
        Ok((picture, tags.collect()))
    })
}

/// Where the camera stands so that all snakes, and some of the stairs around them, are in view.
fn overview(lanes: &[Lane], shot: Shot, aspect: f32) -> Transform {
    /// So much of the lane before and behind a snake is in view, in metres.
    const AROUND_M: f32 = 3.0;
    let mut points = Vec::new();
    for lane in lanes {
        let half_width = Vec3::X * (lane.trial().stairs.width_m / 2.0);
        for pose in lane.last_poses() {
            let at = pose.translation + lane.offset();
            let along = [Vec3::ZERO, Vec3::Y * AROUND_M, Vec3::NEG_Y * AROUND_M];
            points.extend(along.map(|along| at + along));
        }
        let middle = lane.drawn_middle() + lane.offset();
        points.extend([middle - half_width, middle + half_width]);
    }
    let (least, most) = points
        .iter()
        .fold((Vec3::MAX, Vec3::MIN), |(least, most), point| (least.min(*point), most.max(*point)));
    let target = (least + most) / 2.0;
    let mut view = View::of(shot, lanes.len());
    view.distance_m = view.distance_to_see(target, points, aspect);
    view.looking_at(target)
}
