//! Font sizes of the names on tabs. In a narrow panel the names are smaller, so that all tabs are visible. Further
//! panels replace those that were chosen longest ago.

use bevy_egui::egui;

use super::PanelKind;
use crate::studio::ui::theme;
use crate::studio::workspace::layout::Layout;

/// Total horizontal padding of a tab's name, in points, as the dock area draws it.
const AROUND: f32 = 16.0;

/// Width of the button that folds the panels of a tab bar, in points, as the dock area draws it.
const FOLD_BUTTON: f32 = 24.0;

/// Font sizes of small names, in points. The largest that fits into the bar is used, or else the last.
const SMALL_SIZES: [f32; 2] = [theme::SMALL_SIZE, 10.0];

/// Closes panels for whose tabs a bar has no room even with the smallest names: see [`Layout::fit_tabs`].
pub(super) fn fit_tabs(context: &egui::Context, layout: &mut Layout) {
    let smallest = egui::FontId::proportional(SMALL_SIZES[1]);
    layout.fit_tabs(|kinds| bar_width(context, kinds, &smallest));
}

/// Returns the panels whose tabs have small names because their bar is too narrow for the usual size, and the font
/// sizes of the names, in points.
pub(super) fn small_tabs(context: &egui::Context, layout: &Layout) -> Vec<(PanelKind, f32)> {
    let style = context.global_style();
    let font = egui::TextStyle::Button.resolve(&style);
    let sized = layout.tab_bars().into_iter().flat_map(|(width, kinds)| {
        let fits = |font: &egui::FontId| bar_width(context, &kinds, font) <= width;
        let small_fits = |size: &f32| fits(&egui::FontId::proportional(*size));
        let largest = || SMALL_SIZES.into_iter().find(small_fits).unwrap_or(SMALL_SIZES[1]);
        let size = (!fits(&font)).then(largest);
        kinds.into_iter().filter_map(move |kind| Some((kind, size?)))
    });
    sized.collect()
}

/// Returns the width of a tab bar with these panels, in points: the button that folds it, and the tabs.
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

/// Returns the name of a panel for its tab.
pub(super) fn tab_name(kind: PanelKind, small: &[(PanelKind, f32)]) -> egui::WidgetText {
    match small.iter().find(|(of, _)| *of == kind) {
        Some((_, size)) => egui::RichText::new(kind.name()).size(*size).into(),
        None => kind.name().into(),
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
        let small = egui::FontId::proportional(SMALL_SIZES[1]);
        let width = bar_width(&context, PanelKind::INITIAL, &small);
        assert!(width <= LEAST_PANEL, "{width}");
    }
}
