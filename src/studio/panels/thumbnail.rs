//! Thumbnail of a champion: stairs, path of the middle limb and final pose, drawn from shapes without textures.

use bevy_egui::egui::{self, Pos2, Rect, Shape, Stroke};

use crate::studio::ui::theme::{self, Palette};
use snakes_core::save::library::Thumbnail;

/// Maximum vertical stretch of the drawing, because stairs are long and low.
const MAX_STRETCH: f32 = 2.0;
/// Margin around the drawing, in metres.
const MARGIN_M: f32 = 1.5;

/// Draws the thumbnail of a champion or run.
pub fn thumbnail(painter: &egui::Painter, rect: Rect, of: &Thumbnail, palette: &Palette) {
    painter.rect_filled(rect, 4.0, palette.field);
    let painter = painter.with_clip_rect(rect.intersect(painter.clip_rect()));
    let view = ThumbnailView::new(rect, of);
    for step in of.stairs_m.get(1..).unwrap_or_default().as_chunks::<2>().0 {
        let [[front_y_m, top_z_m], [back_y_m, _]] = *step;
        let corners = [[front_y_m, 0.0], [back_y_m, top_z_m]].map(|at| view.at(at));
        let color = theme::flat(palette.step_edge);
        painter.rect_filled(Rect::from_points(&corners), 0.0, color);
    }
    let way: Vec<Pos2> = of.way_m.iter().map(|at| view.at(*at)).collect();
    painter.add(Shape::line(way, Stroke::new(1.0, theme::flat(palette.trail))));
    for (limb, corners) in &of.parts_m {
        let color = if limb % 2 == 0 { palette.red_limb } else { palette.blue_limb };
        let color = theme::flat(color);
        let points = corners.map(|at| view.at(at)).to_vec();
        // The stroke keeps a limb visible when it is seen edge-on.
        painter.add(Shape::convex_polygon(points, color, Stroke::new(0.5, color)));
    }
    let ground = [rect.left(), rect.right()].map(|x| egui::pos2(x, view.at([0.0, 0.0]).y));
    painter.line_segment(ground, Stroke::new(1.0, palette.text_weak));
}

/// Conversion from metres to points in a thumbnail.
struct ThumbnailView {
    rect: Rect,
    least_y_m: f32,
    points_per_m: egui::Vec2,
}

impl ThumbnailView {
    fn new(rect: Rect, of: &Thumbnail) -> Self {
        let limbs = of.parts_m.iter().flat_map(|(_, corners)| corners);
        // Only the start of the landing is shown, because the landing can be long.
        let shown_stairs = of.stairs_m.len().saturating_sub(2);
        let stairs = of.stairs_m.iter().take(shown_stairs.max(1));
        let seen: Vec<&[f32; 2]> = stairs.chain(&of.way_m).chain(limbs).collect();
        let of_axis = |axis: usize, fold: fn(f32, f32) -> f32, start: f32| {
            seen.iter().map(|at| at[axis]).filter(|m| m.is_finite()).fold(start, fold)
        };
        let least_y_m = of_axis(0, f32::min, f32::MAX).min(0.0) - MARGIN_M;
        let most_y_m = of_axis(0, f32::max, f32::MIN).max(1.0) + MARGIN_M;
        let most_z_m = of_axis(1, f32::max, 1.0) + MARGIN_M;
        let along = rect.width() / (most_y_m - least_y_m);
        let up = (rect.height() * 0.9 / most_z_m).min(along * MAX_STRETCH);
        Self { rect, least_y_m, points_per_m: egui::vec2(along, up) }
    }

    fn at(&self, [y_m, z_m]: [f32; 2]) -> Pos2 {
        let x = self.rect.left() + (y_m - self.least_y_m) * self.points_per_m.x;
        egui::pos2(x, self.rect.bottom() - self.rect.height() * 0.1 - z_m * self.points_per_m.y)
    }
}

/// Draws the best fitness of each generation of a run as a line.
pub fn sparkline(painter: &egui::Painter, rect: Rect, best: &[Option<f32>], palette: &Palette) {
    painter.rect_filled(rect, 4.0, palette.field);
    let known = || best.iter().flatten().copied();
    let (least, most) = (known().fold(f32::MAX, f32::min), known().fold(f32::MIN, f32::max));
    if least > most {
        return;
    }
    let area = rect.shrink(theme::GAP / 2.0);
    let last = best.len().saturating_sub(1).max(1) as f32;
    // At most one point is drawn per pixel of the width.
    let every = best.len().div_ceil(area.width().max(1.0) as usize).max(1);
    let points = best.iter().enumerate().step_by(every).filter_map(|(index, of)| {
        let share = ((*of)? - least) / (most - least).max(f32::MIN_POSITIVE);
        let x = egui::lerp(area.x_range(), index as f32 / last);
        Some(egui::pos2(x, egui::lerp(area.bottom()..=area.top(), share)))
    });
    painter.add(Shape::line(points.collect(), Stroke::new(1.5, palette.accent)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::save::library::{EntryDetails, SavePlace, read_entry};

    #[test]
    fn the_whole_drawing_fits_into_the_thumbnail() {
        let Ok(EntryDetails::Champion(of)) = read_entry(&SavePlace::Shipped("climber")) else {
            panic!("it is built-in");
        };
        let rect = Rect::from_min_size(egui::pos2(10.0, 20.0), theme::THUMBNAIL_SIZE);
        let view = ThumbnailView::new(rect, &of.thumbnail);
        let corners = of.thumbnail.parts_m.iter().flat_map(|(_, corners)| corners);
        for at in of.thumbnail.way_m.iter().chain(corners) {
            assert!(rect.contains(view.at(*at)), "{at:?}");
        }
        // An empty thumbnail causes no error.
        let empty = ThumbnailView::new(rect, &Thumbnail::default());
        assert!(empty.at([0.0, 0.0]).x.is_finite());
    }
}
