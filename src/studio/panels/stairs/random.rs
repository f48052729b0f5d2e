//! Random stairs of a class. The same seed gives the same stairs again.

use bevy_egui::egui;

use crate::studio::ui::accessible::named;
use crate::studio::ui::theme;
use snakes_core::genome::{StairsClass, StairsGenome};
use snakes_core::schema::{Choice, Choices};

/// Selected class and seed of random stairs.
#[derive(Debug)]
pub(super) struct RandomStairs {
    class: StairsClass,
    seed: u32,
}

/// Maximum seed of random stairs.
const MOST: u32 = 999_999;

impl Default for RandomStairs {
    fn default() -> Self {
        Self { class: StairsClass::Irregular, seed: 0 }
    }
}

impl RandomStairs {
    /// Draws the row of controls. Returns random stairs after the class or the seed has changed.
    pub fn ui(&mut self, ui: &mut egui::Ui) -> Option<StairsGenome> {
        let mut is_other = false;
        ui.horizontal_wrapped(|ui| {
            ui.label("Random");
            let list = egui::ComboBox::from_id_salt("class of stairs")
                .selected_text(self.class.choice().title)
                .width(theme::COMBO_WIDTH * 0.75)
                .show_ui(ui, |ui| {
                    for &class in StairsClass::OPTIONS {
                        let Choice { title, sentence, .. } = class.choice();
                        let button = ui.selectable_label(class == self.class, title);
                        if button.on_hover_text(sentence).clicked() {
                            self.class = class;
                            is_other = true;
                        }
                    }
                });
            named(list.response, egui::WidgetType::ComboBox, "Class of stairs");
            let field = egui::DragValue::new(&mut self.seed)
                .range(0..=MOST)
                .prefix("seed ")
                .update_while_editing(false);
            let seed = ui.add(field).on_hover_text("The same seed gives the same stairs again");
            is_other |= (seed.changed() && !seed.dragged()) || seed.drag_stopped();
            if ui.button("Next").on_hover_text("The stairs of the next seed").clicked() {
                self.seed = if self.seed < MOST { self.seed + 1 } else { 0 };
                is_other = true;
            }
        });
        is_other.then(|| self.class.of_seed(self.seed))
    }
}
