//! Sizes of the names on tabs. In a narrow panel they are smaller, so that each stays in reach: tabs beyond the end of
//! their bar can only be scrolled to.

use bevy_egui::egui;

use super::PanelKind;
use crate::studio::ui::theme;
use crate::studio::workspace::layout::Layout;

/// Space around the name of a tab, in points, as the dock draws it.
const AROUND: f32 = 16.0;

/// Width of the button that folds the panels of a tab bar, in points, as the dock draws it.
const FOLD_BUTTON: f32 = 24.0;

/// The panels whose tabs have small names, because their bar is too narrow for those of the usual size.
pub(super) fn small_tabs(context: &egui::Context, layout: &Layout) -> Vec<PanelKind> {
    let style = context.global_style();
    let font = egui::TextStyle::Button.resolve(&style);
    let is_crowded =
        |(width, kinds): &(f32, Vec<PanelKind>)| bar_width(context, kinds, &font) > *width;
    layout.tab_bars().into_iter().filter(is_crowded).flat_map(|(_, kinds)| kinds).collect()
}

/// Width of a tab bar with these panels, in points: the button that folds it, and the tabs.
fn bar_width(context: &egui::Context, kinds: &[PanelKind], font: &egui::FontId) -> f32 {
    let name_width = |kind: &PanelKind| {
        let name = kind.name().to_owned();
        let layout = |fonts: &mut egui::epaint::text::FontsView<'_>| {
            fonts.layout_no_wrap(name, font.clone(), egui::Color32::PLACEHOLDER).size().x
        };
        context.fonts_mut(layout) + AROUND
    };
    FOLD_BUTTON + kinds.iter().map(name_width).sum::<f32>()
}

/// The name of a panel on its tab.
pub(super) fn tab_name(kind: PanelKind, is_small: bool) -> egui::WidgetText {
    if is_small {
        egui::RichText::new(kind.name()).size(theme::SMALL_SIZE).into()
    } else {
        kind.name().into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::workspace::widths::LEAST_PANEL;

    #[test]
    fn all_tabs_of_the_narrowest_panel_are_in_reach() {
        let context = egui::Context::default();
        context.begin_pass(egui::RawInput::default());
        theme::apply(&context);
        let small = egui::FontId::proportional(theme::SMALL_SIZE);
        let width = bar_width(&context, &PanelKind::ALL, &small);
        assert!(width <= LEAST_PANEL, "{width}");
    }
}
