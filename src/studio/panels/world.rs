//! The world and the snake that the next run gets, section by section, and a way to find a setting among all.

use bevy_egui::egui;

use super::icons::{Icon, small_icon_button};
use super::parameters::{Section, Sheet, WORLD, all_sections};
use super::presets::PresetChoice;
use super::{explain, title_and};
use crate::studio::command::Command;
use crate::studio::evolution::Evolution;
use crate::studio::look;
use crate::studio::undo::{History, Way};

/// The panel, with what is being dragged or typed.
#[derive(Debug, Default)]
pub(super) struct WorldPanel {
    sheet: Sheet,
    presets: PresetChoice,
    /// What somebody looks for.
    wanted: String,
}

impl WorldPanel {
    /// Draws the panel and adds what was asked for.
    pub fn ui(
        &mut self,
        ui: &mut egui::Ui,
        run: &Evolution,
        history: &History,
        asked: &mut Vec<Command>,
    ) {
        self.sheet.begin(ui, run);
        title_and(ui, "World", |ui| undo_buttons(ui, history, asked));
        self.presets.ui(ui, run, asked);
        next_run(ui, run, asked);
        self.find(ui);
        if self.wanted.trim().is_empty() {
            self.sections(ui, run, asked);
        } else {
            self.found(ui, run, asked);
        }
    }

    /// Shows the settings that are about this.
    pub fn seek(&mut self, text: &str) {
        text.clone_into(&mut self.wanted);
    }

    /// The field for what somebody looks for.
    fn find(&mut self, ui: &mut egui::Ui) {
        ui.horizontal(|ui| {
            let is_searching = !self.wanted.is_empty();
            let clear = if is_searching { look::GAP * 8.0 } else { 0.0 };
            let field = egui::TextEdit::singleline(&mut self.wanted)
                .hint_text("Find a setting")
                .margin(egui::Margin::symmetric(look::GAP as i8, look::GAP as i8 / 2))
                .desired_width(ui.available_width() - clear - look::GAP);
            let response = ui.add(field);
            let is_on = ui.is_enabled();
            response.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::TextEdit, is_on, "Find a setting")
            });
            response.on_hover_text(
                "Shows the settings of all sections, the search's too, that are about it",
            );
            if is_searching && ui.small_button("Clear").clicked() {
                self.wanted.clear();
            }
        });
    }

    fn sections(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        for section in WORLD {
            ui.add_space(look::GAP / 2.0);
            let name = egui::RichText::new(section.title).size(look::TITLE_SIZE).strong();
            let header = egui::CollapsingHeader::new(name).default_open(is_open_at_first(section));
            let shown = header.show_unindented(ui, |ui| {
                if section.prefix == GROUND_PREFIX {
                    own_ground(ui, run, asked);
                }
                self.sheet.section(ui, run, section, asked);
            });
            shown.header_response.on_hover_text(section.about);
        }
    }

    /// The settings that somebody looks for, under the titles of their sections.
    fn found(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        let wanted = self.wanted.clone();
        let mut is_anything = false;
        for section in all_sections() {
            let is_section =
                section.title.to_lowercase().contains(wanted.trim().to_lowercase().as_str());
            let is_wanted =
                |entry: &super::parameters::Entry| is_section || entry.is_about(&wanted);
            let is_ground = section.prefix == GROUND_PREFIX;
            let is_there = !is_ground || run.next_settings().trial.ground.is_some();
            if is_there && section.entries.iter().any(is_wanted) {
                is_anything = true;
                ui.add_space(look::GAP / 2.0);
                explain(ui, section.title);
                self.sheet.entries(ui, run, section, is_wanted, asked);
            }
        }
        if !is_anything {
            explain(ui, "No setting is about that.");
        }
    }
}

/// How the names of the ground's settings begin.
const GROUND_PREFIX: &str = "trial.ground.";

fn is_open_at_first(section: &Section) -> bool {
    ["Surface", "Ground", "Reward"].contains(&section.title)
}

/// Whether the ground has a surface of its own.
fn own_ground(ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
    let trial = &run.next_settings().trial;
    let mut differs = trial.ground.is_some();
    let hint = "Ticked, what the ground is made of begins as a copy of the stairs' surface; unticked, both are one";
    let name = "The ground has a surface of its own";
    if ui.checkbox(&mut differs, name).on_hover_text(hint).changed() {
        let (field, text) = if differs {
            ("ground.friction", trial.surface.friction.to_string())
        } else {
            ("trial.ground", "none".to_owned())
        };
        asked.push(Command::SetField { field: field.to_owned(), text });
    }
}

/// In which world the run under way is, and the way to the next.
fn next_run(ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
    // Always there, so that nothing moves under the pointer when a slider is let go.
    let differs = run.next_run_differs();
    let palette = look::of(ui);
    let (text, color) = if !run.is_under_way() {
        ("The next run is in this world.", palette.text_weak)
    } else if run.settings().trial != run.next_settings().trial {
        ("The run under way keeps its own world.", palette.second)
    } else {
        ("The run under way is in this world.", palette.text_weak)
    };
    ui.label(egui::RichText::new(text).color(color));
    if ui.add_enabled(differs, egui::Button::new("New run in this world")).clicked() {
        asked.extend([Command::Reset, Command::Start]);
    }
}

/// Draws the ways through what was changed, and adds what was asked for.
pub(super) fn undo_buttons(ui: &mut egui::Ui, history: &History, asked: &mut Vec<Command>) {
    for (way, icon, name, command) in [
        (Way::Forth, Icon::Redo, "Redo", Command::Redo),
        (Way::Back, Icon::Undo, "Undo", Command::Undo),
    ] {
        let hint = match history.next(way) {
            Some(step) => format!("{name} {step}"),
            None => way.nothing().to_owned(),
        };
        let is_on = history.next(way).is_some();
        let button = |ui: &mut egui::Ui| small_icon_button(ui, icon, name, &hint);
        if ui.add_enabled_ui(is_on, button).inner.clicked() {
            asked.push(command);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::evolution::prepared_run;
    use crate::studio::panels::parameters::tests::assert_nothing_is_wider_than;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// What the panel sends when a person does `act`.
    fn sent(run: &Evolution, act: impl FnOnce(&mut Harness<'_, Vec<Command>>)) -> Vec<Command> {
        sent_at(run, look::PANEL_WIDTH, &History::default(), act)
    }

    /// The same at some width, after what was changed.
    fn sent_at(
        run: &Evolution,
        width: f32,
        history: &History,
        act: impl FnOnce(&mut Harness<'_, Vec<Command>>),
    ) -> Vec<Command> {
        let mut panel = WorldPanel::default();
        let mut harness = Harness::builder()
            .with_size(egui::vec2(width, 4000.0))
            .with_step_dt(1.0 / 60.0)
            .build_ui_state(
                |ui, asked| {
                    look::apply(ui.ctx());
                    panel.ui(ui, run, history, asked);
                },
                Vec::new(),
            );
        harness.run();
        act(&mut harness);
        harness.run();
        harness.state().clone()
    }

    fn set(field: &str, text: &str) -> Command {
        Command::SetField { field: field.to_owned(), text: text.to_owned() }
    }

    #[test]
    fn a_slider_is_taken_when_it_is_let_go_or_rests_and_not_before() {
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
        for asked in [drag(0, true), drag(30, false)] {
            let [Command::SetField { field, text }] = &asked[..] else { panic!("one command") };
            assert_eq!(field, "trial.surface.bounce");
            let value: f32 = text.parse().expect("a number");
            assert!((0.3..0.7).contains(&value), "half way along the rail: {value}");
        }
        assert_eq!(drag(0, false), []);
    }

    #[test]
    fn a_surface_for_the_ground_begins_as_a_copy() {
        let run = prepared_run();
        let asked = sent(&run, |harness| {
            harness.get_by_label("The ground has a surface of its own").click();
        });
        assert_eq!(asked, [set("ground.friction", "1")]);
    }

    #[test]
    fn while_the_run_is_in_another_world_a_new_one_is_offered() {
        let mut run = prepared_run();
        run.single_generation().expect("started");
        run.set_field("surface.friction", "0.5").expect("allowed");
        let asked = sent(&run, |harness| harness.get_by_label("New run in this world").click());
        assert_eq!(asked, [Command::Reset, Command::Start]);
    }

    #[test]
    fn a_value_that_differs_can_be_given_back_alone_or_with_its_section() {
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
        let asked = sent(&run, |harness| harness.get_by_label("Reset Friction").click());
        assert_eq!(asked, [set("trial.surface.friction", &friction)]);
        let asked = sent(&run, |harness| harness.get_by_label("Reset section").click());
        let back = [("friction", friction), ("bounce", bounce)]
            .map(|(field, text)| (format!("trial.surface.{field}"), text));
        assert_eq!(asked, [Command::SetFields(back.to_vec())]);
    }

    #[test]
    fn a_setting_of_a_closed_section_or_of_the_search_is_found_by_a_word() {
        let run = prepared_run();
        let find = |word: &'static str, found: &'static str| {
            sent(&run, move |harness| {
                harness.get_by_label("Find a setting").focus();
                harness.run();
                harness.get_by_label("Find a setting").type_text(word);
                harness.run();
                assert!(
                    harness.query_all_by_label_contains(found).next().is_some(),
                    "{word}: {found}"
                );
            })
        };
        find("moon", "Gravity, m/s²");
        find("Tournament", "Selection");
        find("joint DAMP", "Joint damping, N·m·s/rad");
        find("xyz", "No setting is about that.");
    }

    #[test]
    fn undo_and_redo_say_what_they_are_about_and_are_off_without_it() {
        let mut run = prepared_run();
        let mut history = History::default();
        let off = sent_at(&run, 400.0, &history, |harness| harness.get_by_label("Undo").click());
        assert_eq!(off, []);
        let before = run.next_plan().clone();
        run.set_field("surface.friction", "0.5").expect("allowed");
        history.note(&set("trial.surface.friction", "0.5"), before, run.next_plan());
        let on = sent_at(&run, 400.0, &history, |harness| harness.get_by_label("Undo").click());
        assert_eq!(on, [Command::Undo]);
        history.take(Way::Back);
        let on = sent_at(&run, 400.0, &history, |harness| harness.get_by_label("Redo").click());
        assert_eq!(on, [Command::Redo]);
    }

    #[test]
    fn at_every_width_the_columns_align_and_nothing_is_wider_than_the_panel() {
        use egui::accesskit::Role;
        let mut run = prepared_run();
        // Whatever makes a row fuller: ways back, a list of limbs, a limit that is given.
        let given = [
            ("trial.surface.soft_cfm_m_s_per_n", "0.00012345"),
            ("trial.agent.limb_width_m", "[1, 1.5, 1, 1, 1]"),
            ("trial.agent.bend_limit_rad", "1"),
            ("trial.agent.joint_damping_nms_per_rad", "12.5"),
        ];
        for (field, text) in given {
            run.set_field(field, text).expect("allowed");
        }
        for width in [300.0, 320.0, 459.0, 480.0, 600.0, 900.0] {
            sent_at(&run, width, &History::default(), |harness| {
                for title in ["Body", "Joints", "Repeated trials", "Disqualification"] {
                    harness.get_by_label(title).click();
                    harness.run();
                }
                let rect = |label: &str| harness.get_by_role_and_label(Role::Slider, label).rect();
                let one = rect("Friction");
                for other in ["Soft CFM, m/s per N", "Limb length, m", "Joint damping, N·m·s/rad"]
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
