//! Test that every action, setting and view is at most three clicks away. The ways are read off the drawn menus, the
//! palette, the bar above the stage and the search of the Change panel.

use super::*;
use crate::studio::commands::actions::Menu;
use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::quality::Quality;
use crate::studio::panels::help::menu::menu;
use crate::studio::panels::player::camera_bar::tests::switched_off_bar;
use crate::studio::panels::run::EvolutionPanel;
use crate::studio::panels::testing::{clicked, panel, shows};
use crate::studio::panels::world::WorldPanel;
use crate::studio::panels::world::surface_readout::ReadLanes;
use crate::studio::state::current_run::prepared_run;
use crate::studio::state::files::RecentFiles;
use crate::studio::state::lessons::LESSONS;
use crate::studio::state::undo::UndoHistory;
use egui_kittest::Harness;

/// Name of something, and the labels that are clicked to get there. Typing into a field that has the focus is no click.
type Way = (String, Vec<&'static str>);

/// Situations in which together every action is possible.
fn situations() -> [Situation; 2] {
    let all = Situation {
        is_what_if: true,
        can_try_another: true,
        can_leave: true,
        can_undo: true,
        can_redo: true,
        ..Situation::default()
    };
    [all, Situation { is_sharing: true, is_finished: true, ..all }]
}

fn by_menus() -> Vec<Way> {
    let mut ways = Vec::new();
    for of in Menu::ALL {
        let recent = RecentFiles::default();
        let mut bar = panel([900.0, 1200.0], move |ui| {
            menu(ui, situations()[0], &|_| None, &recent, ("", None));
        });
        clicked(&mut bar, of.name());
        let drawn = actions().iter().filter(|action| shows(&bar, action.name));
        ways.extend(drawn.map(|action| (action.name.to_owned(), vec![of.name(), action.name])));
    }
    ways
}

fn by_palette() -> Vec<Way> {
    let palette = CommandPalette { presets: presets(), ..CommandPalette::default() };
    let lessons = LESSONS.each_ref().map(|lesson| lesson.title);
    let mut ways = Vec::new();
    for situation in situations() {
        let entries = palette.entries(situation, &lessons);
        let found = entries.iter().filter(|entry| {
            let typed = format!("{} {}", entry.group, entry.name);
            matching(&entries, &typed).contains(entry)
        });
        ways.extend(found.map(|of| (of.name.clone(), vec!["Help", "Find a command", "its row"])));
    }
    ways
}

fn by_search() -> Vec<Way> {
    let (run, history) = (prepared_run(), UndoHistory::default());
    let mut world = WorldPanel::default();
    let mut harness = Harness::builder().with_size(egui::vec2(400.0, 3000.0)).build_ui_state(
        |ui, label: &mut String| {
            world.search.clone_from(label);
            world.ui(ui, &run, &history, &ReadLanes::default());
        },
        String::new(),
    );
    let mut ways = Vec::new();
    for of in every_setting() {
        of.setting.label.clone_into(harness.state_mut());
        harness.step();
        if shows(&harness, of.setting.label) {
            ways.push((name_of(&of), vec![PanelKind::World.name(), "Find a setting"]));
        }
    }
    ways
}

/// Returns the ways through the bar above the stage and the tabs, and from the Watch panel to one generation.
fn by_buttons() -> Vec<Way> {
    let mut bar = switched_off_bar();
    let cameras = CameraMode::ALL.into_iter().filter(|mode| shows(&bar, mode.name()));
    let mut ways: Vec<Way> =
        cameras.map(|mode| (mode.name().to_owned(), vec![mode.name()])).collect();
    clicked(&mut bar, "Show");
    let on_stage = actions().iter().filter(|action| action.shows_on_stage());
    let on_stage = on_stage.map(|action| action.name).chain(Quality::ALL.map(Quality::name));
    let shown = on_stage.filter(|name| shows(&bar, name));
    ways.extend(shown.map(|name| (name.to_owned(), vec!["Show", name])));
    ways.extend(PanelKind::INITIAL.iter().map(|kind| (kind.name().to_owned(), vec![kind.name()])));
    let (run, mut watch) = (prepared_run(), EvolutionPanel::default());
    let mut watch = panel([400.0, 1200.0], |ui| watch.ui(ui, &run, |_| ()));
    let champions = Command::Window(WindowCommand::OpenPanel(PanelKind::Champions));
    if clicked(&mut watch, "Champions").contains(&champions) {
        let clicks = vec![PanelKind::Run.name(), "Champions", "its row"];
        ways.push(("Show a generation's champion".to_owned(), clicks));
    }
    ways
}

#[test]
fn every_action_setting_and_view_is_at_most_three_clicks_away() {
    let ways = [by_menus(), by_palette(), by_search(), by_buttons()].concat();
    let names = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    let all = [
        actions().iter().map(|action| action.name.to_owned()).collect(),
        every_setting().iter().map(name_of).collect(),
        PanelKind::IN_MENU.iter().map(|kind| kind.name().to_owned()).collect(),
        names(&CameraMode::ALL.map(CameraMode::name)),
        names(&Quality::ALL.map(Quality::name)),
        names(&LESSONS.each_ref().map(|lesson| lesson.title)),
    ]
    .concat();
    let clicks = |to: &String| ways.iter().filter(|way| way.0 == *to).map(|way| way.1.len()).min();
    let far: Vec<&String> =
        all.iter().filter(|to| clicks(to).is_none_or(|clicks| clicks > 3)).collect();
    assert!(far.is_empty() && all.len() > 300, "of {}: {far:?}", all.len());
    // Each of the four kinds of ways leads somewhere that no other does, or in fewer clicks.
    for (to, least) in [("Dark theme", 2), ("Watch", 1), ("Charts", 2), ("Friction (surface)", 2)] {
        assert_eq!(clicks(&to.to_owned()), Some(least), "{to}");
    }
}
