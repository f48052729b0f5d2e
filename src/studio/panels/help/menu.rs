//! The menu bar, which lists every action with its shortcut.

use bevy_egui::egui;
use bevy_egui::egui::containers::menu::MenuBar;

use crate::studio::commands::actions::{Action, Menu, Situation, actions};
use crate::studio::commands::files::{FileCommand, FileQuestion};
use crate::studio::commands::{Command, ShareCommand};
use crate::studio::state::files::RecentFiles;
use crate::studio::state::shares::ShareProgress;
use crate::studio::ui::accessible::named_selected;
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::check_box::{CHECK_BOX_SIDE, paint_check_box};
use crate::studio::ui::text_rows::{at_right, weak};
use crate::studio::ui::theme;
use snakes_core::save::library::run_of_plan;

/// Function that returns whether the setting that a command toggles is on, or `None` for other commands.
pub(crate) type IsOn<'a> = &'a dyn Fn(&Command) -> Option<bool>;

/// Draws the menus, and sends the user's commands. `is_on` returns whether the setting that a command toggles is on.
/// `recent` are the files that were opened recently. `about` is shown at the right end.
pub(crate) fn menu(
    ui: &mut egui::Ui,
    situation: Situation,
    is_on: IsOn<'_>,
    recent: &RecentFiles,
    (about, share): (&str, Option<&ShareProgress>),
) {
    MenuBar::new().ui(ui, |ui| {
        let name = egui::RichText::new("Snakes & Stairs").strong().color(theme::of(ui).accent);
        ui.label(name);
        ui.add_space(theme::GAP / 2.0);
        for menu in Menu::ALL {
            ui.menu_button(menu.name(), |ui| {
                ui.set_min_width(theme::MENU_WIDTH);
                let listed = || actions().iter().filter(|action| action.menu == menu);
                let is_toggle =
                    |action: &Action| action.command(situation).as_ref().and_then(is_on);
                let has_toggles = listed().any(|action| is_toggle(action).is_some());
                // In a low window, a menu would otherwise extend beyond the lower edge.
                let height = ui.ctx().content_rect().height() - theme::GAP * 6.0;
                // By default, egui limits a menu to a height of 400 points.
                ui.set_max_height(height);
                egui::ScrollArea::vertical().max_height(height).show(ui, |ui| {
                    ui.spacing_mut().item_spacing.y = 0.0;
                    if menu == Menu::Share {
                        ui.label(weak(ui, SHARED));
                    }
                    for action in listed() {
                        entry(ui, action, situation, (has_toggles, is_on));
                        if action.name == BEFORE_RECENT {
                            open_recent(ui, recent);
                        }
                    }
                });
            });
        }
        at_right(ui, |ui| {
            if let Some(share) = share {
                share_progress(ui, share);
            }
            ui.add(egui::Label::new(weak(ui, about)).truncate()).on_hover_text(about);
        });
    });
}

/// Draws the progress of the file that is being written, and the button that cancels it.
fn share_progress(ui: &mut egui::Ui, share: &ShareProgress) {
    let cancel = egui::Button::new("Cancel").frame(true).small();
    let stop = Command::Share(ShareCommand::Cancel);
    CommandButton::of(cancel, "Cancel writing the file", stop).show(ui);
    let bar = egui::ProgressBar::new(share.share).desired_width(theme::COLUMN_WIDTHS[2]);
    ui.add(bar.desired_height(ui.spacing().interact_size.y * 0.5));
    let words = share.in_words();
    let hint = match share.name.ends_with(".gif") {
        true => format!(
            "{words}. A GIF is drawn more than once, to choose its colours and its size: minutes without a graphics card. An MP4 takes less time"
        ),
        false => words.clone(),
    };
    ui.add(egui::Label::new(words).truncate()).on_hover_text(hint);
    ui.add_space(theme::GAP);
}

/// Contents of the files of the menu Share.
const SHARED: &str =
    "What these files hold: the snakes on the stage, or the best one of a whole generation";
/// Name of the action after which the submenu of recent files is placed.
const BEFORE_RECENT: &str = "Open…";

/// Draws the submenu of recent files: names, with full paths as tooltips. The plan of a run has the name of its folder.
fn open_recent(ui: &mut egui::Ui, recent: &RecentFiles) {
    ui.add_enabled_ui(!recent.0.is_empty(), |ui| {
        ui.menu_button("Open recent", |ui| {
            ui.set_min_width(theme::MENU_WIDTH);
            for path in &recent.0 {
                let button = egui::Button::new(run_of_plan(path).name()).truncate();
                let open = FileCommand::Answer(FileQuestion::Open, vec![path.clone()]);
                let hint = path.display().to_string();
                if CommandButton::of(button, hint, Command::File(open)).show(ui) {
                    ui.close();
                }
            }
        });
    });
}

/// Draws a menu entry. In a menu that `has_toggles`, names are indented by the width of a check box.
fn entry(
    ui: &mut egui::Ui,
    action: &Action,
    situation: Situation,
    (has_toggles, is_on): (bool, IsOn<'_>),
) {
    // An action for several digits needs a digit, which a menu cannot supply.
    if action.key().contains("...") {
        return;
    }
    let command = action.command(situation);
    let place = egui::Id::new("check box of an entry");
    let box_atom = egui::Atom::custom(place, egui::Vec2::splat(CHECK_BOX_SIDE));
    let button = match has_toggles {
        true => egui::Button::new((box_atom, action.name)),
        false => egui::Button::new(action.name),
    };
    let shown = ui.add_enabled_ui(command.is_some(), |ui| {
        let shown = button.shortcut_text(action.key()).atom_ui(ui);
        if let Some(is_on) = command.as_ref().and_then(is_on) {
            if let Some(rect) = shown.rect(place) {
                paint_check_box(ui, rect, is_on);
            }
            return named_selected(shown.response, egui::WidgetType::Checkbox, is_on, action.name);
        }
        shown.response
    });
    let shown = match action.hint {
        "" => shown.inner,
        hint => shown.inner.on_hover_text(hint),
    };
    if shown.clicked() {
        Command::send_all(command, ui);
        ui.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::{FilmSize, RunCommand};
    use crate::studio::panels::testing::{Sent, click, clicked, panel};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// Creates the menu bar in the default situation.
    fn bar<'a>(is_on: IsOn<'a>, recent: &'a RecentFiles) -> Sent<'a> {
        panel([800.0, 600.0], move |ui| {
            menu(ui, Situation::default(), is_on, recent, ("climb, seed 1", None));
        })
    }

    /// Opens a menu and clicks an entry. Returns all commands that were sent.
    fn chosen(bar: &mut Sent<'_>, menu: &str, entry: &str) -> Vec<Command> {
        clicked(bar, menu);
        bar.get_by_label_contains(entry).click();
        bar.run();
        bar.state().clone()
    }

    #[test]
    fn a_menu_entry_sends_its_command() {
        let recent = RecentFiles::default();
        let mut bar = bar(&|_| None, &recent);
        let one = [Command::Run(RunCommand::SingleGeneration)];
        assert_eq!(chosen(&mut bar, "Run", "Evolve one generation"), one);
        assert_eq!(chosen(&mut bar, "Edit", "Undo"), one, "there is nothing to undo");
    }

    #[test]
    fn the_file_menu_asks_for_files_and_lists_those_opened_lately() {
        let texts = ["/saves/mine.ron", "/runs/climb-seed1-be07eab1/run.ron"];
        let recent = RecentFiles::from_texts(&texts.map(str::to_owned));
        let mut bar = bar(&|_| None, &recent);
        for (entry, command) in [
            ("Import…", FileCommand::Ask(FileQuestion::Import)),
            ("Export…", FileCommand::AskExport),
            ("Show saves folder", FileCommand::ShowSaves),
        ] {
            let sent = chosen(&mut bar, "File", entry);
            assert_eq!(sent.last(), Some(&Command::File(command)), "{entry}");
        }
        for (name, path) in ["mine", "climb-seed1-be07eab1"].into_iter().zip(texts) {
            chosen(&mut bar, "File", "Open recent");
            let expected = FileCommand::Answer(FileQuestion::Open, vec![path.into()]);
            assert_eq!(clicked(&mut bar, name).last(), Some(&Command::File(expected)));
        }
    }

    #[test]
    fn the_last_entry_of_each_menu_is_in_sight_in_a_low_window() {
        // The smallest window of the window tests, at the scales 1 and 1.25.
        for size in [egui::vec2(1024.0, 640.0), egui::vec2(819.0, 512.0)] {
            for of in Menu::ALL {
                let recent = RecentFiles::default();
                let mut harness = panel(size.into(), move |ui| {
                    theme::apply(ui.ctx());
                    menu(ui, Situation::default(), &|_| None, &recent, ("", None));
                });
                click(&mut harness, of.name());
                let mut entries = actions().iter().filter(|action| action.menu == of);
                let last = entries.rfind(|action| !action.key().contains("...")).expect("one");
                let entry = harness.get_by_label_contains(last.name).rect();
                let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, size);
                assert!(screen.contains_rect(entry), "{}: {entry} in {size}", last.name);
                let layer = harness.ctx.layer_id_at(entry.center()).expect("a menu");
                let menu_rect = harness.ctx.memory(|memory| memory.area_rect(layer.id));
                assert!(menu_rect.is_some_and(|rect| rect.contains_rect(entry)), "{}", last.name);
            }
        }
    }

    #[test]
    fn a3_the_share_menu_has_every_format_until_a_file_is_being_written() {
        use snakes_lab::export::ExportFormat;
        type State = (Situation, Option<ShareProgress>);
        let mut harness = Harness::new_ui_state(
            |ui, (now, share): &mut State| {
                let recent = RecentFiles::default();
                menu(ui, *now, &|_| None, &recent, ("climb, seed 1", share.as_ref()));
            },
            State::default(),
        );
        for format in ExportFormat::ALL {
            click(&mut harness, "Share");
            harness.get_by_label(SHARED);
            let ending = format!("(.{})", format.info().ending);
            harness.get_by_label_contains(&ending).click();
            harness.run();
            let asked = Command::Share(ShareCommand::Ask(format, FilmSize::Usual));
            assert_eq!(Command::take_sent(&harness.ctx), [asked], "{ending}");
        }
        assert!(harness.query_by_label_contains("climb.mp4").is_none());
        let (now, share) = harness.state_mut();
        now.is_sharing = true;
        *share = Some(ShareProgress {
            name: "climb.mp4".to_owned(),
            share: 0.42,
            expected_bytes: Some(6_140_000),
            left: Some(std::time::Duration::from_secs(20)),
        });
        harness.run();
        harness.get_by_label("climb.mp4  42 %, about 20 s left, about 6.1 MB");
        harness.get_by_label_contains("climb.mp4").hover();
        harness.run_steps(60);
        assert!(harness.query_by_label_contains("An MP4 takes less time").is_none());
        let (_, share) = harness.state_mut();
        let name = "climb.gif".to_owned();
        *share = Some(ShareProgress { name, ..ShareProgress::default() });
        harness.run();
        harness.get_by_label("climb.gif  0 %, preparing").hover();
        harness.run_steps(60);
        harness.get_by_label_contains("An MP4 takes less time");
        click(&mut harness, "Cancel");
        let cancel = Command::Share(ShareCommand::Cancel);
        assert_eq!(Command::take_sent(&harness.ctx), [cancel]);
        click(&mut harness, "Share");
        harness.get_by_label_contains("(.csv)").click();
        harness.run();
        assert_eq!(Command::take_sent(&harness.ctx), [], "one file at a time");
    }

    #[test]
    fn an_entry_that_switches_something_has_a_check_box_with_its_state() {
        use crate::studio::commands::{PlayerCommand, ViewCommand};
        use egui_kittest::kittest::NodeT;
        let is_on = |command: &Command| match command {
            Command::View(ViewCommand::ToggleTheme) => Some(true),
            Command::View(ViewCommand::ToggleFollow) => Some(false),
            Command::Player(PlayerCommand::ToggleLoop) => Some(true),
            _ => None,
        };
        let recent = RecentFiles::default();
        let mut bar = bar(&is_on, &recent);
        clicked(&mut bar, "View");
        let state = |name: &str| {
            let role = egui::accesskit::Role::CheckBox;
            bar.get_by_role_and_label(role, name).accesskit_node().toggled()
        };
        use egui::accesskit::Toggled;
        assert_eq!(state("Dark theme"), Some(Toggled::True));
        assert_eq!(state("Follow snake"), Some(Toggled::False));
        let sent = clicked(&mut bar, "Dark theme");
        assert_eq!(sent, [Command::View(ViewCommand::ToggleTheme)]);
    }
}
