//! The Change panel: settings of the world and the snake of the next run by section, with a search over all settings.

pub mod presets;
pub mod surface_readout;

use std::collections::BTreeSet;

use bevy_egui::egui;

use super::own_files::OwnName;
use super::settings::Sheet;
use super::stairs::stairs_choice;
use super::undo_buttons::undo_buttons;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{Command, PlanCommand, RunCommand, WindowCommand};
use crate::studio::state::current_run::{CurrentRun, RunStatus};
use crate::studio::state::undo::UndoHistory;
use crate::studio::ui::accessible::named;
use crate::studio::ui::buttons::{CommandButton, command_box};
use crate::studio::ui::text_rows::{explain, folded, text_field, title_and, title_text};
use crate::studio::ui::theme;
use snakes_core::schema::{ListedSetting, Section, SettingKind};
use snakes_core::score::{AgentSettings, Trial};
use snakes_core::world::Stairs;

use presets::preset_choice;
use surface_readout::{ReadLanes, ReadSurface};

/// The Change panel, with its search text and fields.
#[derive(Debug, Default)]
pub(super) struct WorldPanel {
    sheet: Sheet,
    /// Field for the name of a preset to save.
    preset_name: OwnName,
    /// Text for which settings are searched.
    search: String,
}

impl WorldPanel {
    /// Draws the panel and collects the user's commands.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        run: &CurrentRun,
        history: &UndoHistory,
        on_stage: &ReadLanes,
        commands: &mut Vec<Command>,
    ) {
        self.sheet.begin(ui, run);
        title_and(ui, "World", |ui| undo_buttons(ui, history, commands));
        preset_choice(ui, &mut self.preset_name, run, commands);
        next_run(ui, run, commands);
        self.search_field(ui);
        if self.search.trim().is_empty() {
            let all = self.sheet.sections("trial.");
            let (first, others): (Vec<Section>, Vec<Section>) =
                all.into_iter().partition(|section| FIRST.contains(section));
            self.sheet.knob(ui, |path| path == GRAVITY);
            for section in first {
                self.folded(ui, section, run, on_stage, commands);
            }
            if self.sheet.fold(ui, ADVANCED, title_text("Advanced"), ADVANCED) {
                for section in others {
                    self.folded(ui, section, run, on_stage, commands);
                }
            }
        } else {
            self.search_results(ui);
        }
        self.sheet.send(commands);
    }

    /// Unfolds the advanced settings of the sections with these titles.
    pub fn unfold(&mut self, sections: &BTreeSet<String>) {
        self.sheet.unfold(sections.iter().cloned());
    }

    /// Sets the text for which settings are searched.
    pub fn set_search(&mut self, text: &str) {
        text.clone_into(&mut self.search);
    }

    /// Draws the search field.
    fn search_field(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let is_searching = !self.search.is_empty();
            let clear = if is_searching { theme::GAP * 8.0 } else { 0.0 };
            let field = text_field(&mut self.search)
                .hint_text("Find a setting")
                .desired_width(ui.available_width() - clear - theme::GAP);
            let field = named(ui.add(field), egui::WidgetType::TextEdit, "Find a setting");
            field.on_hover_text(
                "Searches the settings of all sections, including those of the Watch panel",
            );
            if is_searching && ui.small_button("Clear").clicked() {
                self.search.clear();
            }
        });
    }

    /// Draws a section that its header unfolds.
    fn folded(
        &mut self,
        ui: &mut egui::Ui,
        section: Section,
        run: &CurrentRun,
        on_stage: &ReadLanes,
        commands: &mut Vec<Command>,
    ) {
        ui.add_space(theme::GAP / 2.0);
        let header = egui::CollapsingHeader::new(title_text(section.title))
            .default_open(FIRST.contains(&section));
        folded(ui, header, section.about, |ui| {
            if section == Trial::GROUND {
                ground_switch(ui, run, commands);
            }
            if section == Stairs::SECTION {
                stairs_row(ui, run, commands);
            }
            if let Some((_, surface)) = READ_OUT.iter().find(|(of, _)| *of == section) {
                on_stage.ui(ui, *surface);
            }
            self.sheet.section(ui, section);
        });
    }

    /// Draws the settings that match the search, by section: first those of sections whose title has all words, then
    /// those whose own name has them, and then those that only mention them; settings that the next run does not use come
    /// after all others.
    fn search_results(&mut self, ui: &mut egui::Ui) {
        let words = self.search.to_lowercase();
        let has_all = |text: &str| {
            let text = text.to_lowercase();
            words.split_whitespace().all(|word| text.contains(word))
        };
        let rank = |listed: &ListedSetting| {
            let by_words = match listed.setting.kind {
                SettingKind::Absent(_) => None,
                _ if has_all(listed.section.title) => Some(0),
                _ if has_all(&listed.setting.title()) => Some(1),
                _ => listed.setting.is_about(&words).then_some(2),
            };
            by_words.map(|rank| if listed.is_used { rank } else { rank + 3 })
        };
        let sections = self.sheet.sections("");
        let mut is_anything = false;
        for (wanted, section) in (0..6).flat_map(|rank| sections.iter().map(move |of| (rank, *of)))
        {
            let is_wanted = |listed: &ListedSetting| rank(listed) == Some(wanted);
            if self.sheet.in_section(section).any(is_wanted) {
                is_anything = true;
                ui.add_space(theme::GAP / 2.0);
                explain(ui, section.title);
                self.sheet.entries(ui, section, is_wanted);
            }
        }
        if !is_anything {
            explain(ui, "No setting matches.");
        }
    }
}

/// Sections above the fold, which are open at first.
const FIRST: [Section; 4] = [Trial::SURFACE, Trial::GROUND, AgentSettings::JOINTS, Stairs::SECTION];
/// Setting that is drawn above all sections.
const GRAVITY: &str = "trial.physics.gravity_m_s2";
/// Key and name of the fold with the other sections.
const ADVANCED: &str = "Advanced settings of the world";

/// Sections that begin with readings of a surface.
const READ_OUT: [(Section, ReadSurface); 3] = [
    (Trial::SURFACE, ReadSurface::Stairs),
    (Trial::GROUND, ReadSurface::Ground),
    (AgentSettings::SKIN, ReadSurface::Skin),
];

/// Draws the selection of known stairs, and the button that opens their editor.
fn stairs_row(ui: &mut egui::Ui, run: &CurrentRun, commands: &mut Vec<Command>) {
    ui.horizontal_wrapped(|ui| {
        stairs_choice(ui, run, commands);
        let hint = "Drag the edges of the steps, change each step in a table, and save the stairs";
        let edit = Command::Window(WindowCommand::OpenPanel(PanelKind::Stairs));
        CommandButton::new("Edit…", hint, edit).show(ui, commands);
    });
}

/// Draws the switch that gives the ground its own surface.
fn ground_switch(ui: &mut egui::Ui, run: &CurrentRun, commands: &mut Vec<Command>) {
    let trial = &run.next_settings().trial;
    let differs = trial.ground.is_some();
    let hint = "On: the ground gets its own settings, copied from the stairs. Off: ground and stairs share one surface";
    let change = match differs {
        true => PlanCommand::set("trial.ground", "none"),
        false => PlanCommand::set("ground.friction", &trial.surface.friction.to_string()),
    };
    let words = ("The ground has its own surface", hint);
    command_box(ui, differs, words, Command::Plan(change), commands);
}

/// Draws whether the current run uses these settings, with a button that starts the next run.
fn next_run(ui: &mut egui::Ui, run: &CurrentRun, commands: &mut Vec<Command>) {
    // The row is always present, so that the layout does not move when a slider is released.
    let palette = theme::of(ui);
    let (text, color) = if !run.is_under_way() {
        ("These settings will be used by the next run.", palette.text_weak)
    } else if run.settings().trial != run.next_settings().trial {
        ("The current run still uses the old settings.", palette.second)
    } else {
        ("The current run uses these settings.", palette.text_weak)
    };
    ui.label(egui::RichText::new(text).color(color));
    let hint = "Prepares and starts a run with the changed settings; the current run stays saved";
    let refusal = match run.status() {
        _ if run.next_run_differs() => None,
        RunStatus::Running | RunStatus::Paused => {
            Some("The current run uses these settings already: change a setting first")
        }
        RunStatus::Ready => Some("The next run uses these settings: start it in the Watch panel"),
        RunStatus::Finished => Some("The finished run used these settings: change a setting first"),
    };
    let begin = Command::Run(RunCommand::New);
    CommandButton::new("New run in this world", hint, begin).unless(refusal).show(ui, commands);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::settings::tests::{assert_nothing_is_wider_than, every_section};
    use crate::studio::panels::testing::{Sent, set, shows, type_into};
    use crate::studio::state::current_run::prepared_run;
    use crate::studio::state::undo::UndoDirection;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// Calls `act` on the panel. Returns the commands that were sent.
    fn sent(run: &CurrentRun, act: impl FnOnce(&mut Sent<'_>)) -> Vec<Command> {
        sent_at(run, theme::PANEL_WIDTH, &UndoHistory::default(), act)
    }

    /// Calls `act` on the panel, with this width in points and this history. Returns the commands that were sent.
    fn sent_at(
        run: &CurrentRun,
        width: f32,
        history: &UndoHistory,
        act: impl FnOnce(&mut Sent<'_>),
    ) -> Vec<Command> {
        let mut panel = WorldPanel::default();
        panel.unfold(&every_section());
        let mut harness = Harness::builder()
            .with_size(egui::vec2(width, 4000.0))
            .with_step_dt(1.0 / 60.0)
            .build_ui_state(
                |ui, commands| {
                    theme::apply(ui.ctx());
                    panel.ui(ui, run, history, &ReadLanes::default(), commands);
                },
                Vec::new(),
            );
        harness.run();
        act(&mut harness);
        harness.run();
        harness.state().clone()
    }

    #[test]
    fn a_slider_value_is_sent_when_it_is_released_or_rests() {
        let run = prepared_run();
        let drag = |rests_for_frames: usize, lets_go: bool| {
            sent(&run, |harness| {
                let slider = harness.get_by_role_and_label(egui::accesskit::Role::Slider, "Bounce");
                let rail = slider.rect();
                harness.drag_at(rail.left_center() + egui::vec2(6.0, 0.0));
                harness.run();
                harness.hover_at(rail.center());
                harness.run_steps(1 + rests_for_frames);
                if lets_go {
                    harness.drop_at(rail.center());
                }
            })
        };
        for commands in [drag(0, true), drag(30, false)] {
            let [Command::Plan(PlanCommand::SetField { field, text })] = &commands[..] else {
                panic!("one command")
            };
            assert_eq!(field, "trial.surface.bounce");
            let value: f32 = text.parse().expect("a number");
            assert!((0.3..0.7).contains(&value), "half way along the rail: {value}");
        }
        assert_eq!(drag(0, false), []);
    }

    #[test]
    fn the_ground_surface_starts_as_a_copy_of_the_stairs() {
        let run = prepared_run();
        let commands = sent(&run, |harness| {
            harness.get_by_label("The ground has its own surface").click();
        });
        assert_eq!(commands, [set("ground.friction", "1")]);
    }

    #[test]
    fn a_changed_world_offers_a_new_run() {
        let mut run = prepared_run();
        run.single_generation().expect("started");
        run.set_field("surface.friction", "0.5").expect("allowed");
        let commands = sent(&run, |harness| harness.get_by_label("New run in this world").click());
        assert_eq!(commands, [Command::Run(RunCommand::New)]);
    }

    #[test]
    fn a_disabled_button_for_a_new_run_says_why() {
        let mut run = prepared_run();
        for reason in ["start it in the Watch panel", "change a setting first"] {
            let commands = sent(&run, |harness| {
                harness.get_by_label("New run in this world").hover();
                harness.run_steps(60);
                assert!(shows(harness, reason), "{reason}");
            });
            assert_eq!(commands, []);
            run.single_generation().expect("started");
        }
    }

    #[test]
    fn a_changed_value_can_be_reset_alone_or_with_its_section() {
        let mut run = prepared_run();
        run.set_preset("report").expect("shipped");
        let calm = sent(&run, |harness| {
            assert!(harness.query_by_label("Reset Friction").is_none(), "nothing differs");
        });
        assert_eq!(calm, []);
        run.set_field("surface.friction", "0.5").expect("allowed");
        run.set_field("surface.bounce", "0.25").expect("allowed");
        let preset = run.preset_settings().expect("shipped").trial.surface.clone();
        let (friction, bounce) = (preset.friction.to_string(), preset.bounce.to_string());
        let commands = sent(&run, |harness| harness.get_by_label("Reset Friction").click());
        assert_eq!(commands, [set("trial.surface.friction", &friction)]);
        let commands = sent(&run, |harness| harness.get_by_label("Reset section").click());
        let back = [("friction", friction), ("bounce", bounce)]
            .map(|(field, text)| (format!("trial.surface.{field}"), text));
        assert_eq!(commands, [Command::Plan(PlanCommand::SetFields(back.to_vec()))]);
    }

    #[test]
    fn the_search_finds_settings_of_closed_sections_and_of_the_run_panel() {
        let run = prepared_run();
        let assert_finds = |word: &'static str, found: &'static str| {
            sent(&run, move |harness| {
                type_into(harness, "Find a setting", word);
                assert!(shows(harness, found), "{word}: {found}");
            })
        };
        assert_finds("moon", "Gravity, m/s²");
        assert_finds("Tournament", "Selection");
        assert_finds("joint DAMP", "Joint damping, N·m·s/rad");
        assert_finds("xyz", "No setting matches.");
    }

    #[test]
    fn a10_settings_whose_section_or_name_has_the_words_come_before_those_that_mention_them() {
        let run = prepared_run();
        sent(&run, |harness| {
            type_into(harness, "Find a setting", "joint");
            let top =
                |label: &str| harness.query_all_by_label(label).next().map(|of| of.rect().top());
            let joints = top("Joints").expect("the section");
            let field = harness.get_by_label("Find a setting").rect();
            assert!(joints < field.bottom() + theme::GAP * 4.0, "{joints}");
            // This run uses neither decisions nor a network.
            for unused in ["XCS", "Hidden neurons"] {
                let last = harness.query_all_by_label(unused).map(|of| of.rect().top());
                let last = last.fold(f32::MAX, f32::min);
                let damping = top("Joint damping, N·m·s/rad").expect("a setting in use");
                assert!(last > damping, "{unused}: {last}");
            }
        });
    }

    #[test]
    fn undo_and_redo_are_disabled_without_history() {
        let mut run = prepared_run();
        let mut history = UndoHistory::default();
        let off = sent_at(&run, 400.0, &history, |harness| harness.get_by_label("Undo").click());
        assert_eq!(off, []);
        let before = run.next_plan().clone();
        run.set_field("surface.friction", "0.5").expect("allowed");
        history.note(&set("trial.surface.friction", "0.5"), before, run.next_plan());
        let on = sent_at(&run, 400.0, &history, |harness| harness.get_by_label("Undo").click());
        assert_eq!(on, [Command::Undo]);
        let step = history.take(UndoDirection::Back);
        history.complete(UndoDirection::Back, step, None);
        let on = sent_at(&run, 400.0, &history, |harness| harness.get_by_label("Redo").click());
        assert_eq!(on, [Command::Redo]);
    }

    #[test]
    fn columns_align_and_fit_at_every_panel_width() {
        use egui::accesskit::Role;
        let mut run = prepared_run();
        // With these values, the rows are widest: reset buttons, lists of limbs, limits.
        let given = [
            ("trial.surface.soft_cfm_m_s_per_n", "0.00012345"),
            ("trial.agent.limb_width_m", "[1, 1.5, 1, 1, 1]"),
            ("trial.agent.bend_limit_rad", "1"),
            ("trial.agent.joint_damping_nms_per_rad", "12.5"),
        ];
        for (field, text) in given {
            run.set_field(field, text).expect("allowed");
        }
        for width in [300.0, theme::PANEL_WIDTH, 459.0, 480.0, 600.0, 900.0] {
            sent_at(&run, width, &UndoHistory::default(), |harness| {
                for title in [ADVANCED, "Body", "Repeated trials", "Disqualification"] {
                    harness.get_by_label(title).click();
                    harness.run();
                }
                let rect = |label: &str| harness.get_by_role_and_label(Role::Slider, label).rect();
                let one = rect("Friction");
                for other in
                    ["Softness (CFM), m/s per N", "Limb length, m", "Joint damping, N·m·s/rad"]
                {
                    let other = rect(other);
                    let are_aligned = one.left() == other.left() && one.width() == other.width();
                    assert!(are_aligned, "{one:?} and {other:?} at {width} points");
                }
                assert_nothing_is_wider_than(harness, width);
            });
        }
    }
}
