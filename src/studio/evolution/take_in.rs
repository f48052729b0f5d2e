//! Takes in what the background found, and shows what is better than all before.

use bevy::prelude::*;

use super::Evolution;
use crate::evolve::Champion;
use crate::run::Event;
use crate::save::Earlier;
use crate::studio::Frame;
use crate::studio::exhibit::Exhibit;
use crate::studio::lane::Lane;
use crate::studio::notice::Notices;
use crate::studio::playback::Playback;
use crate::studio::stage::{Programme, Show};

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Startup, start_at_once).add_systems(Update, take_in.in_set(Frame::TakeIn));
}

/// A fresh run evolves from the first moment.
fn start_at_once(mut evolution: ResMut<Evolution>, mut notices: ResMut<Notices>) {
    if let Err(problem) = evolution.start() {
        notices.problem(problem);
    }
}

/// Takes in what the background found. A champion that beats the one on show and all before it takes the stage,
/// unless that is held: then somebody is looking at something.
fn take_in(
    mut evolution: ResMut<Evolution>,
    mut notices: ResMut<Notices>,
    mut show: MessageWriter<Show>,
    lanes: Query<&Lane>,
    (programme, mut playback): (Res<Programme>, ResMut<Playback>),
) {
    evolution.take_in_listing();
    let Some(background) = &evolution.background else { return };
    let events: Vec<Event> = std::iter::from_fn(|| background.poll()).collect();
    // Only what was found in the world of this run can be compared with what it finds.
    let world = &evolution.settings().trial;
    let rivals = lanes.iter().map(Lane::exhibit);
    let rivals = rivals.filter(|exhibit| exhibit.champion().trial == *world);
    let champions = evolution.reports.iter().filter_map(|report| report.champion.as_ref());
    let known = champions.map(|champion| champion.evaluation.fitness);
    let mut to_beat = rivals.map(Exhibit::fitness).chain(known).fold(f32::MIN, f32::max);
    // Who holds the stage, has several on it, or tries out another world than the run's, is looking at something.
    let is_tried = |lane: &Lane| lane.exhibit().is_changed() && lane.trial() != world;
    let is_looked_at = *programme != Programme::Solo || lanes.iter().any(Lane::is_disturbed);
    let is_held = is_looked_at || !playback.is_playing() || lanes.iter().any(is_tried);
    let mut present = |champion: &Champion, number, notices: &mut Notices| {
        if champion.evaluation.fitness <= to_beat {
            return;
        }
        to_beat = champion.evaluation.fitness;
        let exhibit = Exhibit::found(champion, number);
        if is_held {
            notices.news(format!("New best of the run: {}", exhibit.caption()));
        } else {
            notices.news(format!("New on stage: {}", exhibit.caption()));
            playback.restart();
            show.write(Show::solo(exhibit));
        }
    };
    let number = evolution.number;
    for event in events {
        match event {
            Event::Opened(behind) => {
                // Whatever happens from now on, it is not thrown away once more.
                evolution.source.earlier = Earlier::Keep;
                let generations = evolution.settings().evolution.generations;
                let last = behind.last().filter(|last| last.generation < generations);
                if let Some(last) = last {
                    notices.news(format!("The run goes on after generation {}.", last.generation));
                }
                let champions = behind.iter().filter_map(|report| report.champion.as_ref());
                let fitness = |champion: &&Champion| champion.evaluation.fitness;
                let best = champions.max_by(|a, b| fitness(a).total_cmp(&fitness(b)));
                best.into_iter().for_each(|best| present(best, number, &mut notices));
                evolution.reports = behind;
            }
            Event::Refused(problem) => {
                notices.problem(format!("Nothing is evolved: {problem}"));
                evolution.background = None;
                evolution.engine.set_run_folder(None);
            }
            Event::Explored(exploration) => evolution.explore(exploration),
            Event::Generation(report) => {
                let champion = report.champion.iter();
                champion.for_each(|champion| present(champion, number, &mut notices));
                evolution.reports.push(*report);
            }
            Event::Finished { run_hash } => {
                evolution.run_hash = Some(run_hash);
                evolution.engine.set_run_folder(None);
                notices.news("The run is finished; \"New run\" begins another.".to_owned());
            }
            Event::BrokeOff => {
                notices.problem("The run broke off by an error of the program.".to_owned());
                evolution.background = None;
            }
            Event::NotSaved(problem) => {
                notices.problem(format!("Not saved, and held: {problem}. Start tries again."));
            }
            Event::Crashed(problem) => notices.problem(problem),
        }
    }
}
