//! Caption of the presenting mode: a large line about what the stage shows, and a smaller line below. The caption is in
//! a band, so that it covers no part of the picture.

use bevy_egui::egui;

use super::generation_card::how_many;
use crate::studio::panels::on_stage::OnStage;
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::ranking::{RankedLane, ranking};
use crate::studio::stage::staged_champion::ChampionSource;
use crate::studio::state::current_run::{CurrentRun, RunStatus};
use crate::studio::ui::decimals::decimals;
use crate::studio::ui::lane_dot::lane_dot;
use crate::studio::ui::theme;

/// Maximum number of snakes that a race's caption names, the leading ones.
const NAMED: usize = 3;
/// Distance within which snakes count as level, in metres.
const EQUAL_M: f32 = 0.05;

/// Texts of the presenting mode's caption.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct PresentedCaption {
    /// Large line, with a dot in the colour of its lane.
    pub title: CaptionPart,
    /// Parts of the smaller line below.
    details: Vec<CaptionPart>,
}

/// A part of the caption: a text with an optional dot.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct CaptionPart {
    /// Lane whose colour the dot before the text has; the first is 0. `None` for no dot.
    lane: Option<usize>,
    /// The text.
    pub text: String,
}

impl CaptionPart {
    fn plain(text: String) -> Self {
        Self { lane: None, text }
    }
}

impl PresentedCaption {
    /// Creates the caption of what the stage shows now. It contains nothing that the playback has not reached yet.
    pub fn of(lanes: &[&Lane], on_stage: &OnStage, run: &CurrentRun) -> Self {
        let Some(first) = lanes.first() else { return Self::default() };
        if on_stage.following.holds {
            let (done, all) = run.progress();
            let title = format!("Generation 1: {done} of {all} random snakes tried");
            let details = vec![CaptionPart::plain("They appear here in a moment.".to_owned())];
            return Self { title: CaptionPart::plain(title), details };
        }
        let time_s = on_stage.playback.time_s();
        let mut caption = match &*on_stage.mode {
            StageMode::Solo | StageMode::Generation { .. } => {
                let generation = first.staged.champion().origin.generation;
                let is_first_landing = run
                    .milestones
                    .iter()
                    .find(|milestone| milestone.is_landed)
                    .is_some_and(|milestone| milestone.generation == generation)
                    && first.staged.source() == ChampionSource::Run(run.number);
                Self::of_one(first, time_s, is_first_landing)
            }
            StageMode::Race => {
                let racers = lanes.iter().copied().filter(|lane| !lane.is_ghost);
                Self::of_race(&ranking(racers, time_s))
            }
            StageMode::WhatIf { .. } => Self::of_what_if(lanes, time_s),
        };
        if let StageMode::Generation { size, .. } = &*on_stage.mode {
            caption.details.push(CaptionPart::plain(how_many(*size, lanes.len())));
        }
        if let Some((part, parts)) = on_stage.following.story_part().filter(|(_, parts)| *parts > 1)
        {
            caption.details.push(CaptionPart::plain(format!("Story, part {part} of {parts}")));
        }
        if matches!(*on_stage.mode, StageMode::Solo | StageMode::Generation { .. }) {
            caption.details.extend(evolution(run).map(CaptionPart::plain));
        }
        caption
    }

    fn of_one(lane: &Lane, time_s: f64, is_first_landing: bool) -> Self {
        let name = lane.staged.label();
        let title = match lane.landed_s(time_s) {
            Some(_) if is_first_landing => format!("{name} is the first to reach the top!"),
            _ => format!("{name}: {}", lane.progress_in_words(time_s)),
        };
        Self { title: CaptionPart::plain(title), details: Vec::new() }
    }

    /// Creates the caption of a race: its leader, and those behind.
    pub fn of_race(ranking: &[RankedLane]) -> Self {
        let result = |ranked: &RankedLane| match ranked.landed_s {
            _ if !ranked.counts() => "out".to_owned(),
            Some(landed_s) => format!("reached the top after {landed_s:.1} s"),
            None => format!("{} m", decimals(ranked.y_m, 1)),
        };
        let Some(leader) = ranking.first() else { return Self::default() };
        let is_level = |of: &RankedLane| (of.y_m - leader.y_m).abs() < EQUAL_M;
        let title = match leader.landed_s.filter(|_| leader.counts()) {
            Some(_) => format!("{} wins: {}", leader.name, result(leader)),
            None if ranking.iter().all(is_level) => "All are level".to_owned(),
            None => format!("{} leads: {}", leader.name, result(leader)),
        };
        let behind = ranking.iter().enumerate().take(NAMED).skip(1).map(|(place, ranked)| {
            let text = format!("{}. {}  {}", place + 1, ranked.name, result(ranked));
            CaptionPart { lane: Some(ranked.lane), text }
        });
        Self {
            title: CaptionPart { lane: Some(leader.lane), text: title },
            details: behind.collect(),
        }
    }

    /// Creates the caption of a what-if: compares the latest copy, which is the last lane, with the original, which is the first.
    fn of_what_if(lanes: &[&Lane], time_s: f64) -> Self {
        let racers: Vec<&&Lane> = lanes.iter().filter(|lane| !lane.is_ghost).collect();
        let (Some(original), Some(changed)) = (racers.first(), racers.last()) else {
            return Self::default();
        };
        let ahead_m = changed.drawn_middle().y - original.drawn_middle().y;
        let difference = match ahead_m {
            _ if ahead_m.abs() < EQUAL_M => "level with the original".to_owned(),
            ahead_m if ahead_m > 0.0 => format!("{ahead_m:.1} m ahead"),
            _ => format!("{:.1} m behind", -ahead_m),
        };
        let details = [original, changed].map(|lane| CaptionPart {
            lane: Some(lane.number),
            text: format!("{}: {}", lane.staged.label(), lane.progress_in_words(time_s)),
        });
        Self {
            title: CaptionPart {
                lane: Some(changed.number),
                text: format!("{}: {difference}", changed.staged.label()),
            },
            details: details.into(),
        }
    }
}

/// Describes the state of the current run; returns `None` during a lesson, or if the run has not begun.
fn evolution(run: &CurrentRun) -> Option<String> {
    if run.is_lent {
        return None;
    }
    let (done, all) = (run.reports.len(), run.plan_now.most_generations_in_words());
    match run.status() {
        RunStatus::Running => Some(format!("Evolution: generation {} of {all}", done + 1)),
        RunStatus::Paused => Some(format!("Evolution paused after generation {done}")),
        RunStatus::Finished => Some(format!("Evolution finished: {done} generations")),
        RunStatus::Ready => None,
    }
}

/// Draws the caption in a band at the bottom.
pub(crate) fn caption_band(ui: &mut egui::Ui, caption: &PresentedCaption) {
    let palette = theme::of(ui);
    let margin = egui::Margin::symmetric(theme::GAP as i8 * 3, theme::GAP as i8);
    let frame = egui::Frame::new().fill(palette.panel).inner_margin(margin);
    egui::Panel::bottom("presented caption")
        .resizable(false)
        .exact_size(theme::PRESENTED_BAND)
        .frame(frame)
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = theme::GAP / 2.0;
            let width = ui.available_width() - theme::PRESENTED_SIZES[0];
            let fits = |size: &f32| {
                let (text, font) = (caption.title.text.clone(), egui::FontId::proportional(*size));
                ui.painter().layout_no_wrap(text, font, egui::Color32::WHITE).size().x <= width
            };
            let sizes = theme::PRESENTED_SIZES;
            let size = sizes.into_iter().find(fits).unwrap_or(sizes[sizes.len() - 1]);
            // The line below does not move when the title is drawn in a smaller size.
            let height = sizes[0] * LINE;
            ui.horizontal(|ui| part(ui, &caption.title, size, height));
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = theme::GAP * 3.0;
                let size = theme::PRESENTED_DETAIL_SIZE;
                caption.details.iter().for_each(|detail| part(ui, detail, size, size * LINE));
            });
        });
}

/// Height of a line of the caption, as a multiple of its font size.
const LINE: f32 = 1.25;

/// Draws a part of the caption. `size` is its font size and `height` that of its line, in points.
fn part(ui: &mut egui::Ui, part: &CaptionPart, size: f32, height: f32) {
    ui.horizontal(|ui| {
        // The line gets its height first, so that the dot is centred in it.
        ui.set_height(height);
        ui.spacing_mut().item_spacing.x = size * 0.4;
        if let Some(lane) = part.lane {
            lane_dot(ui, lane, size * 0.6);
        }
        let text = egui::RichText::new(&part.text).size(size);
        ui.add(egui::Label::new(text).truncate().selectable(false));
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::{climber_lane, panel};
    use egui_kittest::kittest::Queryable;

    /// Creates a lane with the built-in climber at this time, in simulated seconds.
    fn lane(number: usize, name: &str, time_s: f64) -> Lane {
        let mut lane = climber_lane(number, name);
        lane.finish_lookahead();
        lane.skip_to(time_s);
        lane
    }

    #[test]
    fn one_snake_is_named_with_the_steps_that_it_has_climbed_by_now() {
        let title = |time_s: f64, is_first: bool| {
            PresentedCaption::of_one(&lane(0, "climber", time_s), time_s, is_first).title.text
        };
        assert_eq!(title(0.0, true), "climber: on its way to the stairs");
        let half_way = title(6.0, false);
        assert!(half_way.starts_with("climber: climbed "), "{half_way}");
        assert!(half_way.ends_with(" of 10 steps"), "{half_way}");
        assert!(title(14.0, false).starts_with("climber: at the top after "));
        assert_eq!(title(14.0, true), "climber is the first to reach the top!");
    }

    #[test]
    fn a_place_is_a_distance_until_the_whole_snake_is_on_the_landing() {
        let place = |time_s| lane(0, "climber", time_s).place_in_words();
        assert!(place(6.0).ends_with(" m"), "{}", place(6.0));
        assert_eq!(place(f64::MAX), "at the top");
    }

    #[test]
    fn a28_a_landing_counts_even_if_the_snake_has_gone_on_beyond_it() {
        let staged = lane(0, "climber", 0.0).staged.clone();
        let title = |landing_m: f32| {
            let mut trial = staged.trial().clone();
            trial.stairs.landing_m = landing_m;
            let mut lane = Lane::new(staged.in_world(&trial, "climber".to_owned()), 0);
            lane.finish_lookahead();
            lane.skip_to(f64::MAX);
            let beyond = lane.drawn_middle().y > trial.stairs.end_y_m();
            let title = PresentedCaption::of_one(&lane, f64::MAX, false).title.text;
            let is_healthy = lane.evaluation().disqualified.is_none();
            (beyond && is_healthy && lane.landed_s(f64::MAX).is_some()).then_some(title)
        };
        let title = (2..12).find_map(|landing_m| title(landing_m as f32)).expect("one goes beyond");
        assert!(title.starts_with("climber: reached the top after "), "{title}");
    }

    #[test]
    fn a_race_names_its_leader_and_those_behind_with_the_dots_of_their_lanes() {
        let lanes = [lane(0, "late", 2.0), lane(1, "early", 9.0), lane(2, "third", 0.5)];
        let four = lane(3, "fourth", 0.0);
        let lanes: Vec<&Lane> = lanes.iter().chain([&four]).collect();
        let caption = PresentedCaption::of_race(&ranking(lanes.iter().copied(), 2.0));
        assert_eq!(caption.title.lane, Some(1));
        assert!(caption.title.text.starts_with("early leads: "), "{caption:?}");
        let behind: Vec<_> = caption.details.iter().map(|of| (of.lane, &of.text[..2])).collect();
        assert_eq!(behind, [(Some(0), "2."), (Some(2), "3.")]);
        let winner = PresentedCaption::of_race(&ranking([lanes[1]], 15.0)).title.text;
        assert!(winner.starts_with("early wins: reached the top after "), "{winner}");
    }

    #[test]
    fn a_what_if_tells_the_difference_of_its_snakes() {
        let (original, changed) = (lane(0, "original", 6.0), lane(1, "friction 0.1", 1.0));
        let caption = PresentedCaption::of_what_if(&[&original, &changed], 6.0);
        assert!(caption.title.text.starts_with("friction 0.1: "), "{caption:?}");
        assert!(caption.title.text.ends_with(" m behind"), "{caption:?}");
        assert_eq!((caption.title.lane, caption.details.len()), (Some(1), 2));
        let equal = PresentedCaption::of_what_if(&[&original, &original], 6.0);
        assert!(equal.title.text.ends_with(": level with the original"));
    }

    #[test]
    fn the_band_has_one_height_and_shrinks_a_long_caption() {
        let band = |text: &str| {
            let caption = PresentedCaption {
                title: CaptionPart { lane: Some(2), text: text.to_owned() },
                details: vec![CaptionPart::plain("All 30 snakes at once".to_owned())],
            };
            let panel = panel([1000.0, 625.0], |ui| {
                caption_band(ui, &caption);
                let left = ui.available_rect_before_wrap();
                ui.put(left, egui::Label::new("the stage"));
            });
            let title = panel.get_by_label(text).rect();
            let below = panel.get_by_label("All 30 snakes at once").rect();
            assert!(title.right() <= 1000.0 && below.bottom() <= 625.0, "{title} {below}");
            (title.height(), below.top())
        };
        let short = "Generation 12";
        let long = "a champion with a name of many letters leads: reached the top after 12.3 s";
        assert!(band(short).0 > band(long).0 * 1.2);
        assert_eq!(band(short).1, band(long).1);
    }
}
