//! Names of widgets for accessibility tools.

use bevy_egui::egui::{Response, WidgetInfo, WidgetType};

/// Tells accessibility tools the kind and the name of a widget.
pub(crate) fn named(response: Response, kind: WidgetType, name: &str) -> Response {
    response.widget_info(|| WidgetInfo::labeled(kind, response.enabled(), name));
    response
}

/// Tells accessibility tools the kind and the name of a widget, and whether it is selected.
pub(crate) fn named_selected(
    response: Response,
    kind: WidgetType,
    is_selected: bool,
    name: &str,
) -> Response {
    response.widget_info(|| WidgetInfo::selected(kind, response.enabled(), is_selected, name));
    response
}
