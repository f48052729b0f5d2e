//! Where everything is that the panels show, for scripts and tests: role, label and place of each control, as a screen
//! reader gets them, in a file.

use std::fmt::Write;
use std::path::PathBuf;

use bevy::prelude::*;
use bevy_egui::{EguiContext, EguiOutput, EguiPostUpdateSet, PrimaryEguiContext};

use super::notice::Notices;
use crate::save::store_text;

/// The file, if there shall be one.
#[derive(Resource, Debug, Default)]
pub(super) struct Places(pub Option<PathBuf>);

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Places>().add_systems(
        PostUpdate,
        describe
            .after(EguiPostUpdateSet::ProcessOutput)
            .run_if(|places: Res<Places>| places.0.is_some()),
    );
}

/// Writes a line for each control: role, left, top, right, bottom in logical pixels, label.
fn describe(
    mut places: ResMut<Places>,
    mut contexts: Query<(&mut EguiContext, &EguiOutput), With<PrimaryEguiContext>>,
    mut notices: ResMut<Notices>,
    mut written: Local<String>,
) {
    let Some(path) = &places.0 else { return };
    for (mut context, output) in &mut contexts {
        let context = context.get_mut();
        context.enable_accesskit();
        let Some(update) = &output.platform_output.accesskit_update else { continue };
        let scale = f64::from(context.zoom_factor());
        let mut text = String::new();
        for (_, node) in &update.nodes {
            let label = node.label().or(node.value()).unwrap_or_default().replace('\n', " ");
            let Some(place) = node.bounds().filter(|_| !label.is_empty()) else { continue };
            let ends = [place.x0, place.y0, place.x1, place.y1].map(|end| (end * scale).round());
            let [left, top, right, bottom] = ends;
            let role = node.role();
            // Writing to a string does not fail.
            let _ = writeln!(text, "{role:?}\t{left}\t{top}\t{right}\t{bottom}\t{label}");
        }
        if text != *written {
            if let Err(error) = store_text(path, &text) {
                notices.problem(error.to_string());
                places.0 = None;
                return;
            }
            *written = text;
        }
    }
}
