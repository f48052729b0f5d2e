//! Draws the frames of a film, one update of the scene per frame. While the renderer returns a frame, the next one is
//! drawn.

use std::collections::VecDeque;

use bevy::prelude::*;

use super::error::FilmError;
use super::order::FilmOrder;
use super::plan::{FilmFrame, lanes_of};
use crate::studio::pictures::offscreen::Offscreen;
use crate::studio::pictures::render::over_heads;
use crate::studio::stage::lane::{AT_THE_TOP, Lane};
use crate::studio::stage::ranking::ranking;
use snakes_core::save::Picture;
use snakes_lab::plot;
use snakes_lab::plot::{FilmBand, FilmTitle, NameTag};

/// Maximum number of frames that are drawn but not yet returned by the renderer.
const IN_FLIGHT: usize = 3;

/// The scene in which the frames of a film are drawn.
pub struct Shooting<'s> {
    order: &'s FilmOrder,
    plan: &'s [FilmFrame],
    studio: &'s mut Offscreen,
    /// Index of the part on the stage; `None` before the first frame.
    part: Option<usize>,
    /// Simulated time of the stage, in seconds.
    time_s: f64,
}

/// A frame that the renderer has not returned yet, with its texts.
struct PendingFrame {
    index: usize,
    shot: u64,
    band: Option<FilmBand>,
    tags: Vec<NameTag>,
    title: Option<FilmTitle>,
}

/// Sets up the scene and runs `work`, which draws frames of the plan.
pub fn shoot(
    order: &FilmOrder,
    plan: &[FilmFrame],
    work: impl FnOnce(&mut Shooting<'_>) -> Result<(), FilmError>,
) -> Result<(), FilmError> {
    let mut done = Ok(());
    Offscreen::draw(order.size, order.look.theme, |studio| {
        studio.show_overlays(&order.look.overlays);
        done = work(&mut Shooting { order, plan, studio, part: None, time_s: 0.0 });
        Ok(())
    })?;
    done
}

impl Shooting<'_> {
    /// Draws the frames with these indices, in ascending order, and passes each to `each` with its index.
    pub fn play(
        &mut self,
        indices: impl IntoIterator<Item = usize>,
        mut each: impl FnMut(usize, Picture) -> Result<(), FilmError>,
    ) -> Result<(), FilmError> {
        let mut pending = VecDeque::new();
        for index in indices {
            pending.push_back(self.draw(index)?);
            while let Some(frame) = pending.front() {
                let picture = if pending.len() > IN_FLIGHT {
                    Some(self.studio.await_shot(frame.shot)?)
                } else {
                    self.studio.taken(frame.shot)?
                };
                let Some(picture) = picture else { break };
                each(frame.index, written_on(picture, frame)?)?;
                pending.pop_front();
            }
        }
        for frame in pending {
            let picture = self.studio.await_shot(frame.shot)?;
            each(frame.index, written_on(picture, &frame)?)?;
        }
        Ok(())
    }

    /// Draws a frame. Returns it as pending, with the texts to write onto it.
    fn draw(&mut self, index: usize) -> Result<PendingFrame, FilmError> {
        let planned = &self.plan[index];
        let is_new = self.part != Some(planned.part) || planned.time_s < self.time_s;
        if is_new {
            self.put_on_stage(planned.part)?;
        }
        let world = self.studio.app.world_mut();
        let mut lanes = world.query::<&mut Lane>();
        lanes.iter_mut(world).for_each(|mut lane| lane.skip_to(planned.time_s));
        self.time_s = planned.time_s;
        self.studio.place_camera(planned.camera);
        if is_new {
            self.studio.settle();
        }
        let shot = self.studio.shoot();
        let (band, heads) = if self.order.has_captions { self.texts() } else { (None, Vec::new()) };
        let tags = self.studio.tags_of(heads);
        let title = planned.title.clone().filter(|_| self.order.has_captions);
        Ok(PendingFrame { index, shot, band, tags, title })
    }

    /// Replaces the lanes of the stage by those of a part, at their start.
    fn put_on_stage(&mut self, part: usize) -> Result<(), FilmError> {
        self.studio.clear_stage();
        self.studio.put_on_stage(lanes_of(&self.order.parts[part])?);
        (self.part, self.time_s) = (Some(part), 0.0);
        Ok(())
    }

    /// Returns the caption band for the time on the stage, and the texts above the heads.
    fn texts(&mut self) -> (Option<FilmBand>, Vec<(Vec3, String)>) {
        let world = self.studio.app.world_mut();
        let mut lanes = world.query::<&Lane>();
        let lanes = lanes.iter(world).sort_by_key::<&Lane, _>(|lane| lane.number);
        let lanes: Vec<&Lane> = lanes.collect();
        let heads = over_heads(&lanes);
        (band(&lanes, self.time_s), heads)
    }
}

/// Returns the texts of the caption band: the progress of one champion, or the order of several.
fn band(lanes: &[&Lane], time_s: f64) -> Option<FilmBand> {
    let first = lanes.first()?;
    let clock = format!("{time_s:.1} s");
    if lanes.len() == 1 {
        let (progress, place) = (first.progress_in_words(time_s), first.place_in_words());
        let has_place = progress.ends_with(" m") || place == AT_THE_TOP;
        let detail = if has_place { progress } else { format!("{progress}, at {place}") };
        return Some(FilmBand { name: first.staged.label().to_owned(), detail, clock });
    }
    let mut places = (1..)
        .zip(ranking(lanes.iter().copied(), time_s))
        .map(|(place, ranked)| format!("{place}. {}", ranked.name));
    let name = places.next().unwrap_or_default();
    Some(FilmBand { name, detail: places.take(3).collect::<Vec<_>>().join("   "), clock })
}

/// Writes the texts of a frame onto its picture.
fn written_on(mut picture: Picture, frame: &PendingFrame) -> Result<Picture, FilmError> {
    plot::tags(&mut picture, &frame.tags)?;
    if let Some(band) = &frame.band {
        plot::film_band(&mut picture, band)?;
    }
    if let Some(title) = &frame.title {
        plot::film_title(&mut picture, title)?;
    }
    Ok(picture)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::camera_mode::CameraMode;
    use crate::studio::commands::overlay::Overlay;
    use crate::studio::pictures::film::order::FilmPart;
    use crate::studio::pictures::film::plan::planned;
    use crate::studio::state::shares::StageLook;
    use crate::studio::ui::theme::Theme;
    use snakes_core::save::{load_champion, shipped_champion};

    /// Returns whether there is no Vulkan driver. The test is then skipped, unless it is required.
    fn lacks_a_driver() -> bool {
        let folders = ["/usr/share/vulkan/icd.d", "/etc/vulkan/icd.d"];
        let has_files =
            |folder: &&str| std::fs::read_dir(folder).is_ok_and(|mut files| files.next().is_some());
        let is_missing = !folders.iter().any(has_files);
        if is_missing {
            let required =
                std::env::var("SNAKES_PEER_TESTS").is_ok_and(|value| value == "required");
            assert!(!required, "no Vulkan driver is installed");
            eprintln!("skipped: frames: no Vulkan driver is installed");
        }
        is_missing
    }

    #[test]
    fn a_snake_that_landed_first_stays_first_however_far_the_others_go_on_the_landing() {
        let saves = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("saves");
        let champion = |name: &str| {
            let loaded = load_champion(&saves.join(format!("{name}.ron"))).expect("well formed");
            (name.to_owned(), loaded)
        };
        let champions = ["climber", "thrifty", "robust", "fast"].map(champion).to_vec();
        let mut lanes = lanes_of(&FilmPart { title: None, champions }).expect("they fit");
        let time_s = 30.0;
        lanes.iter_mut().for_each(|lane| lane.skip_to(time_s));
        let names = |key: &dyn Fn(&Lane) -> f64| -> Vec<String> {
            let mut order: Vec<&Lane> = lanes.iter().collect();
            order.sort_by(|a, b| key(a).total_cmp(&key(b)));
            order.iter().map(|lane| lane.staged.label().to_owned()).collect()
        };
        let by_landing = names(&|lane| lane.landed_s(time_s).expect("it lands"));
        let by_way = names(&|lane| -f64::from(lane.drawn_middle().y));
        assert_ne!(by_landing, by_way, "the case shows nothing");
        let band = band(&lanes.iter().collect::<Vec<_>>(), time_s).expect("lanes");
        let places = (1..).zip(&by_landing).map(|(place, name)| format!("{place}. {name}"));
        let places: Vec<String> = places.collect();
        assert_eq!((&band.name, &band.detail), (&places[0], &places[1..].join("   ")));
    }

    #[test]
    fn a_frame_is_the_same_after_other_frames_as_when_it_is_drawn_alone() {
        if lacks_a_driver() {
            return;
        }
        let part = |title: Option<&str>| FilmPart {
            title: title.map(|title| (title.to_owned(), String::new())),
            champions: vec![("climber".to_owned(), shipped_champion().expect("well formed"))],
        };
        let order = FilmOrder {
            parts: vec![part(None), part(Some("Generation 2"))],
            start_s: 6.0,
            end_s: Some(6.5),
            speed: 1.0,
            fps: 10,
            size: (160, 90),
            most_bytes: 8_000_000,
            may_be_smaller: false,
            may_be_slower: false,
            ends_with_climb: false,
            look: StageLook {
                camera: CameraMode::Follow,
                theme: Theme::Light,
                overlays: vec![Overlay::Trail, Overlay::Contacts, Overlay::Torques],
            },
            has_captions: true,
        };
        let plan = planned(&order).expect("planned");
        let frames = |indices: &[usize]| {
            let mut drawn = Vec::new();
            let shot = shoot(&order, &plan, |shooting| {
                shooting.play(indices.iter().copied(), |index, picture| {
                    drawn.push((index, picture));
                    Ok(())
                })
            });
            shot.expect("drawn");
            drawn
        };
        let all: Vec<usize> = (0..plan.len()).collect();
        let together = frames(&all);
        assert_eq!(together.iter().map(|(index, _)| *index).collect::<Vec<_>>(), all);
        // A frame in the middle of the first part, its last frame, and a frame under the title of the second part.
        for index in [2, 4, 7] {
            let alone = frames(&[index]);
            let pixels = alone[0].1.rgb.iter().zip(&together[index].1.rgb);
            let differ = pixels.filter(|(alone, together)| alone != together).count();
            assert_eq!(differ, 0, "frame {index}");
        }
        assert_ne!(together[2].1, together[4].1, "the snake moves");
    }

    #[test]
    fn a_view_along_the_ground_takes_no_minutes_without_a_graphics_card() {
        if lacks_a_driver() {
            return;
        }
        let champions = vec![("climber".to_owned(), shipped_champion().expect("well formed"))];
        let lanes = lanes_of(&FilmPart { title: None, champions }).expect("they fit");
        let drawn = Offscreen::draw((895, 503), Theme::Light, |studio| {
            studio.put_on_stage(lanes);
            studio.settle();
            let eye = Transform::from_xyz(18.400_47, 36.670_143, 0.920_652_57);
            studio.place_camera(
                eye.looking_at(Vec3::new(15.784_954, 26.886_23, 0.150_682_24), Vec3::Z),
            );
            let shot = studio.shoot();
            studio.await_shot(shot)
        });
        assert!(drawn.is_ok(), "{drawn:?}");
    }
}
