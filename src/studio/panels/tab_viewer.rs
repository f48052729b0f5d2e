//! Shows the panels as tabs of the dock area.

use bevy_egui::egui;
use egui_dock::{TabStyle, TabViewer};

use super::tab_names::tab_name;
use super::{PanelKind, Viewer};
use crate::studio::ui::accessible::named;

impl TabViewer for Viewer<'_, '_, '_> {
    type Tab = PanelKind;

    fn id(&mut self, kind: &mut PanelKind) -> egui::Id {
        egui::Id::new(("panel", kind.name()))
    }

    fn title(&mut self, kind: &mut PanelKind) -> egui::WidgetText {
        tab_name(*kind, &self.small_tabs)
    }

    fn ui(&mut self, ui: &mut egui::Ui, kind: &mut PanelKind) {
        // Only rectangles in the main window are recorded for the tour, because floating windows can move.
        self.panels.panel_rects.push((*kind, ui.clip_rect()));
        if *kind == PanelKind::Stage {
            self.stage(ui);
        } else if [PanelKind::Champions, PanelKind::Library].contains(kind) {
            self.panel(ui, *kind);
        } else {
            egui::ScrollArea::vertical().auto_shrink(false).show(ui, |ui| self.panel(ui, *kind));
        }
    }

    fn on_tab_button(&mut self, kind: &mut PanelKind, response: &egui::Response) {
        let name = format!("Panel {}", kind.name());
        named(response.clone(), egui::WidgetType::Button, &name)
            .on_hover_text(kind.hint_with_key());
    }

    fn is_closeable(&self, kind: &PanelKind) -> bool {
        *kind != PanelKind::Stage
    }

    fn allowed_in_windows(&self, kind: &mut PanelKind) -> bool {
        *kind != PanelKind::Stage
    }

    fn clear_background(&self, kind: &PanelKind) -> bool {
        *kind != PanelKind::Stage
    }

    fn scroll_bars(&self, _kind: &PanelKind) -> [bool; 2] {
        // Each panel has a separate scroll area.
        [false, false]
    }

    fn tab_style_override(&self, kind: &PanelKind, style: &TabStyle) -> Option<TabStyle> {
        (*kind == PanelKind::Stage).then(|| {
            let mut style = style.clone();
            style.tab_body.inner_margin = egui::Margin::ZERO;
            style
        })
    }
}
