//! The world and the snake that the next run gets: surface, stairs, joints, limbs, and what is rewarded.
//!
//! A change also goes to the stage: beside what is on show the same genome begins under it. So that a drag does not
//! start the stage again with every pixel, a slider is taken when it is let go, or rests for a moment.

use bevy_egui::egui;

use super::knobs::{Knob, LIMITS, SNAKE, STAIRS, SURFACE};
use super::title;
use crate::evolve::Settings;
use crate::save::shipped_presets;
use crate::score::{Fitness, PerPart};
use crate::studio::command::Command;
use crate::studio::evolution::Evolution;
use crate::studio::look;

/// The panel, with what is being dragged or typed.
#[derive(Debug)]
pub(super) struct WorldPanel {
    /// The field being changed, the value it has so far, and since when, in seconds.
    changing: Option<(String, f32, f64)>,
    /// The frame in which the panel was drawn last.
    drawn_in: u64,
    /// Names and descriptions of the shipped presets.
    presets: Vec<(String, String)>,
}

/// A slider that is held still for so long shows what it does, in seconds.
const REST_S: f64 = 0.35;

impl Default for WorldPanel {
    fn default() -> Self {
        // The shipped presets are well formed; a test holds them to it.
        let presets = shipped_presets().unwrap_or_default();
        let presets = presets.into_iter().map(|preset| (preset.name, preset.about)).collect();
        Self { changing: None, drawn_in: 0, presets }
    }
}

impl WorldPanel {
    /// Draws the panel and adds what was asked for.
    pub fn ui(&mut self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        let settings = run.next_settings();
        let frame = ui.ctx().cumulative_frame_nr();
        if frame > self.drawn_in + 1 {
            // What was left unfinished when the panel was left is forgotten.
            self.changing = None;
        }
        self.drawn_in = frame;
        self.choices(ui, run, asked);
        // Always there, so that nothing moves under the pointer when a slider is let go.
        let differs = run.next_run_differs();
        let (text, color) = if differs {
            ("The run under way keeps its own world.", look::of(ui).second)
        } else {
            ("The run under way is in this world.", look::of(ui).text_weak)
        };
        ui.label(egui::RichText::new(text).color(color));
        if ui.add_enabled(differs, egui::Button::new("New run in this world")).clicked() {
            asked.extend([Command::Reset, Command::Start]);
        }
        let section = |ui: &mut egui::Ui, name: &str, is_open: bool| {
            ui.add_space(look::GAP / 2.0);
            let name = egui::RichText::new(name).size(look::TITLE_SIZE).strong();
            egui::CollapsingHeader::new(name).default_open(is_open)
        };
        section(ui, "Surface", true).show(ui, |ui| self.surfaces(ui, settings, asked));
        section(ui, "Snake", false).show(ui, |ui| {
            for (knob, value) in &SNAKE {
                self.slider(ui, "", knob, value(settings), asked);
            }
            for (knob, given) in &LIMITS {
                self.limit(ui, knob, given(settings), asked);
            }
        });
        section(ui, "Stairs and world", false).show(ui, |ui| {
            for (knob, value) in &STAIRS {
                self.slider(ui, "", knob, value(settings), asked);
            }
        });
    }

    /// Preset and fitness.
    fn choices(&self, ui: &mut egui::Ui, run: &Evolution, asked: &mut Vec<Command>) {
        title(ui, "World");
        let fitness = run.next_settings().trial.fitness;
        egui::Grid::new("choices").num_columns(2).show(ui, |ui| {
            ui.label("Preset");
            egui::ComboBox::from_id_salt("preset")
                .selected_text(run.next_preset())
                .width(look::COMBO_WIDTH)
                .show_ui(ui, |ui| {
                    for (name, about) in &self.presets {
                        let is_chosen = name == run.next_preset();
                        let choice = ui.selectable_label(is_chosen, name).on_hover_text(about);
                        if choice.clicked() {
                            asked.push(Command::SetPreset(name.clone()));
                        }
                    }
                });
            ui.end_row();
            ui.label("Fitness");
            egui::ComboBox::from_id_salt("fitness")
                .selected_text(short_name(fitness))
                .width(look::COMBO_WIDTH)
                .show_ui(ui, |ui| {
                    for kind in Fitness::ALL {
                        let choice = ui
                            .selectable_label(kind == fitness, short_name(kind))
                            .on_hover_text(about(kind));
                        if choice.clicked() {
                            asked.push(set("trial.fitness", kind.name()));
                        }
                    }
                })
                .response
                .on_hover_text(about(fitness));
            ui.end_row();
        });
    }

    fn surfaces(&mut self, ui: &mut egui::Ui, settings: &Settings, asked: &mut Vec<Command>) {
        let trial = &settings.trial;
        let mut differs = trial.ground.is_some();
        if ui.checkbox(&mut differs, "The ground has a surface of its own").changed() {
            asked.push(if differs {
                set("ground.friction", &trial.surface.friction.to_string())
            } else {
                set("trial.ground", "none")
            });
        }
        if trial.ground.is_some() {
            ui.label(egui::RichText::new("Stairs").color(look::of(ui).text_weak));
        }
        for (knob, value) in &SURFACE {
            self.slider(ui, "trial.surface.", knob, value(&trial.surface), asked);
        }
        if let Some(ground) = &trial.ground {
            ui.label(egui::RichText::new("Ground").color(look::of(ui).text_weak));
            for (knob, value) in &SURFACE {
                self.slider(ui, "trial.ground.", knob, value(ground), asked);
            }
        }
    }

    /// A limit that is each genome's own unless it is given.
    fn limit(
        &mut self,
        ui: &mut egui::Ui,
        knob: &Knob,
        given: &Option<PerPart>,
        asked: &mut Vec<Command>,
    ) {
        let mut is_given = given.is_some();
        let hint = "Unticked, each genome has its own, drawn from the preset's list";
        if ui.checkbox(&mut is_given, knob.label).on_hover_text(hint).changed() {
            asked.push(set(knob.field, if is_given { "1" } else { "none" }));
        }
        if let Some(given) = given {
            self.slider(ui, "", knob, given.at(0), asked);
        }
    }

    /// A slider with a name over it. What it is set to is asked for when it is let go.
    fn slider(
        &mut self,
        ui: &mut egui::Ui,
        prefix: &str,
        knob: &Knob,
        value: f32,
        asked: &mut Vec<Command>,
    ) {
        let field = format!("{prefix}{}", knob.field);
        let mut shown = match &self.changing {
            Some((changing, so_far, _)) if *changing == field => *so_far,
            _ => value,
        };
        let mut slider = egui::Slider::new(&mut shown, knob.least..=knob.most)
            .clamping(egui::SliderClamping::Never)
            .custom_formatter(|value, _| rounded(value as f32));
        if let Some(from) = knob.logarithmic_from {
            slider = slider.logarithmic(true).smallest_positive(f64::from(from));
        }
        if knob.is_whole {
            slider = slider.step_by(1.0);
        }
        let name = ui.label(knob.label).on_hover_text(knob.hint);
        ui.spacing_mut().slider_width = look::SLIDER_WIDTH;
        let response = ui.add(slider).labelled_by(name.id).on_hover_text(knob.hint);
        let now_s = ui.input(|input| input.time);
        if response.changed() {
            self.changing = Some((field.clone(), shown, now_s));
        }
        let since_s = match &self.changing {
            Some((changing, _, since_s)) if *changing == field => *since_s,
            _ => return,
        };
        let is_let_go = !response.dragged() && !response.has_focus();
        let rests = response.dragged() && now_s - since_s > REST_S;
        if is_let_go {
            self.changing = None;
        }
        let text = rounded(shown);
        if (is_let_go || rests) && text != rounded(value) {
            asked.push(set(&field, &text));
            if rests {
                // Once, until it is moved again.
                self.changing = Some((field, shown, f64::INFINITY));
            }
        }
    }
}

fn set(field: &str, text: &str) -> Command {
    Command::SetField { field: field.to_owned(), text: text.to_owned() }
}

/// A slider's value with as many digits as a person can mean: four that count.
fn rounded(value: f32) -> String {
    let four_digits: f32 = format!("{value:.3e}").parse().unwrap_or(value);
    four_digits.to_string()
}

fn short_name(fitness: Fitness) -> &'static str {
    match fitness {
        Fitness::Centre => "Centre, y",
        Fitness::Head => "Head, y",
        Fitness::CentreOfMass => "Centre of mass, y",
        Fitness::Height => "Height",
        Fitness::FurthestY => "Furthest y ever",
        Fitness::StepsClimbed => "Steps climbed",
        Fitness::Climb => "Climb: y on the stairs",
    }
}

fn about(fitness: Fitness) -> String {
    format!("The {}.\nRewards wrongly: {}", fitness.words(), fitness.rewards_wrongly())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::with_field;
    use crate::studio::evolution::prepared_run;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// What the panel sends when a person does `act`.
    fn sent(run: &Evolution, act: impl FnOnce(&mut Harness<'_, Vec<Command>>)) -> Vec<Command> {
        let mut panel = WorldPanel::default();
        let size = egui::vec2(look::PANEL_WIDTH, 1000.0);
        let mut harness = Harness::builder()
            .with_size(size)
            .with_step_dt(1.0 / 60.0)
            .build_ui_state(|ui, asked| panel.ui(ui, run, asked), Vec::new());
        act(&mut harness);
        harness.run();
        harness.state().clone()
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
    fn every_slider_sets_a_field_that_there_is() {
        let mut settings = Settings::default();
        settings.trial.ground = Some(settings.trial.surface.clone());
        let surfaces = ["trial.surface.", "trial.ground."].into_iter().flat_map(|prefix| {
            SURFACE.iter().map(move |(knob, _)| (format!("{prefix}{}", knob.field), knob))
        });
        let others = STAIRS.iter().chain(&SNAKE).map(|(knob, _)| (knob.field.to_owned(), knob));
        let limits = LIMITS.iter().map(|(knob, _)| (knob.field.to_owned(), knob));
        for (field, knob) in surfaces.chain(others).chain(limits) {
            for value in [knob.least, knob.most] {
                with_field(&settings, &field, &rounded(value)).expect(&field);
            }
        }
    }

    #[test]
    fn every_slider_shows_the_field_that_it_sets() {
        let settings = Settings::default();
        for (knob, value) in STAIRS.iter().chain(&SNAKE) {
            let target = (knob.least + knob.most) / 2.0;
            let target = if knob.is_whole { target.round() } else { target };
            let changed = with_field(&settings, knob.field, &rounded(target)).expect(knob.field);
            assert_eq!(value(&changed), target, "{}", knob.field);
        }
        for (knob, value) in &SURFACE {
            let target = (knob.least + knob.most) / 2.0;
            let field = format!("surface.{}", knob.field);
            let changed = with_field(&settings, &field, &rounded(target)).expect(&field);
            assert_eq!(value(&changed.trial.surface), target, "{field}");
        }
    }
}
