//! The solids of which a staircase consists, and its outline from the side.

use super::Stairs;
use crate::world::{Pose, Rotation, Vector};

/// One box of the staircase, in the axes of the world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StairBox {
    /// Number of the step to which the box belongs; the lowest is 0.
    pub step: u32,
    /// Lower corner: least x, y and z, in metres.
    pub min_m: [f32; 3],
    /// Upper corner: greatest x, y and z, in metres.
    pub max_m: [f32; 3],
}

/// One solid of the staircase: a box, or the tilted board of a sloping rise. The board's lower edges lie within boxes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StairSolid {
    /// Number of the step to which the solid belongs; the lowest is 0.
    pub step: u32,
    /// Position of the solid's centre, and its rotation about the x axis.
    pub pose: Pose,
    /// Half the width of the solid, half its depth along the tread or the slope, and half its height, in metres.
    pub half_m: Vector,
}

/// Greatest thickness of a nosing, in metres; on low steps, a nosing is half the rise thick.
const NOSING_THICK_M: f32 = 0.1;

impl Stairs {
    /// Returns the steps as solid boxes that stand on the ground, lowest first. A tread with a nosing has a box of its own; a tread at the
    /// level of the ground has no box.
    ///
    /// The landing belongs to the box of the last step, because a sliding block would be caught at a seam between two level boxes.
    pub fn boxes(&self) -> Vec<StairBox> {
        let mut boxes = Vec::new();
        for step in 0..self.steps {
            let (top_m, below_m) = (self.height_m(step + 1), self.height_m(step));
            let back_y_m = self.back_y_m(step);
            let mut push = |[from_y_m, from_z_m]: [f32; 2], [to_y_m, to_z_m]: [f32; 2]| {
                if to_z_m > from_z_m {
                    boxes.push(StairBox {
                        step,
                        min_m: [-self.width_m / 2.0, from_y_m, from_z_m],
                        max_m: [self.width_m / 2.0, to_y_m, to_z_m],
                    });
                }
            };
            let nosing_m = self.step_nosing_m(step);
            if self.step_slope_m(step) > 0.0 {
                // The board of a slope rests on the lower of the two levels.
                let [riser_m, tread_m] = [self.riser_y_m(step), self.tread_y_m(step)];
                push([riser_m, 0.0], [tread_m, below_m.min(top_m)]);
                push([tread_m, 0.0], [back_y_m, top_m]);
            } else if nosing_m > 0.0 {
                let (riser_m, under_m) = (self.riser_y_m(step), self.nosing_under_m(step));
                push([riser_m, 0.0], [back_y_m, under_m]);
                push([riser_m - nosing_m, under_m], [back_y_m, top_m]);
            } else {
                push([self.riser_y_m(step), 0.0], [back_y_m, top_m]);
            }
        }
        boxes
    }

    /// Returns all solids: the boxes, lowest first, and then the boards of sloping rises.
    pub fn solids(&self) -> Vec<StairSolid> {
        let solid = |of: StairBox| {
            let min = Vector::from(of.min_m);
            let half_m = (Vector::from(of.max_m) - min) / 2.0;
            StairSolid { step: of.step, pose: Pose::from_translation(min + half_m), half_m }
        };
        let sloping = (0..self.steps).filter(|&step| self.step_slope_m(step) > 0.0);
        let boards = sloping.map(|step| self.board(step));
        self.boxes().into_iter().map(solid).chain(boards).collect()
    }

    /// Returns the board of a sloping rise.
    fn board(&self, step: u32) -> StairSolid {
        let from = Vector::new(0.0, self.riser_y_m(step), self.height_m(step));
        let to = Vector::new(0.0, self.tread_y_m(step), self.height_m(step + 1));
        let along = to - from;
        let length_m = along.length();
        let (sin, cos) = (along.z / length_m, along.y / length_m);
        // The board is as thick as the triangle between the two levels is high over its longest side.
        let thick_m = along.z.abs() * cos;
        let normal = Vector::new(0.0, -sin, cos);
        // Square roots give the half angle, because their results are the same on every processor. A slope lies between -90 and 90
        // degrees.
        let half_cos = ((1.0 + cos) / 2.0).sqrt();
        let half_sin = sin / (2.0 * half_cos);
        let rotation = Rotation::from_xyzw(half_sin, 0.0, 0.0, half_cos);
        let centre = (from + to) / 2.0 - normal * (thick_m / 2.0);
        StairSolid {
            step,
            pose: Pose::from_parts(centre, rotation),
            half_m: Vector::new(self.width_m / 2.0, length_m / 2.0, thick_m / 2.0),
        }
    }

    /// Returns the outline of the stairs from the side, from the foot of the first riser to the end of the landing: y and z of its
    /// corners, in metres. Each step has the foot and the top of its riser, with the nosing between, and then the end of its tread.
    pub fn outline_m(&self) -> Vec<[f32; 2]> {
        let mut outline = vec![[self.first_riser_y_m, 0.0]];
        for step in 0..self.steps {
            let (riser_m, top_m) = (self.riser_y_m(step), self.height_m(step + 1));
            let nosing_m = self.step_nosing_m(step);
            if nosing_m > 0.0 {
                let under_m = self.nosing_under_m(step);
                outline.extend([[riser_m, under_m], [riser_m - nosing_m, under_m]]);
            }
            outline.push([self.tread_y_m(step) - nosing_m, top_m]);
            outline.push([self.back_y_m(step), top_m]);
        }
        outline
    }

    /// Returns the front edge of a step's tread, or the edge from which a step leads down: y and z, in metres.
    pub fn edge_m(&self, step: u32) -> [f32; 2] {
        if self.step_rise_m(step) < 0.0 {
            [self.riser_y_m(step), self.height_m(step)]
        } else {
            [self.tread_y_m(step) - self.step_nosing_m(step), self.height_m(step + 1)]
        }
    }

    /// Returns the position on the y axis at which a step ends, in metres: the next riser, or for the last step the end of the landing.
    fn back_y_m(&self, step: u32) -> f32 {
        if step + 1 == self.steps { self.end_y_m() } else { self.riser_y_m(step + 1) }
    }

    /// Returns the height of the underside of a step's nosing over the ground, in metres.
    fn nosing_under_m(&self, step: u32) -> f32 {
        self.height_m(step + 1) - NOSING_THICK_M.min(self.step_rise_m(step) / 2.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_boxes_rise_by_half_a_metre_every_two_metres() {
        let boxes = Stairs::default().boxes();
        assert_eq!(boxes.len(), 10);
        assert_eq!(boxes[0].min_m, [-2.5, 3.0, 0.0]);
        assert_eq!(boxes[0].max_m, [2.5, 5.0, 0.5]);
        assert_eq!(boxes[9].min_m[1], 21.0);
        assert_eq!(boxes[9].max_m[2], 5.0);
        assert_eq!(boxes[9].max_m[1], 37.0, "the landing belongs to the last step");
    }

    #[test]
    fn the_surface_lies_on_the_solids() {
        let stairs = Stairs::uneven();
        let solids = stairs.solids();
        assert_eq!(solids.iter().filter(|of| of.pose.rotation != Rotation::IDENTITY).count(), 2);
        for number in 0..1600_i16 {
            let y_m = 2.0 + f32::from(number) * 0.01 + 0.003;
            let tops_m = solids.iter().filter_map(|of| {
                let along = of.pose.rotation * Vector::Y;
                let top = of.pose * Vector::new(0.0, 0.0, of.half_m.z);
                let into_m = (y_m - top.y) / along.y;
                (into_m.abs() <= of.half_m.y).then_some(top.z + into_m * along.z)
            });
            let top_m = tops_m.fold(0.0, f32::max);
            let surface_m = stairs.surface_z_m(0.0, y_m);
            assert!((surface_m - top_m).abs() < 1.0e-4, "at {y_m}: {surface_m} on {top_m}");
        }
    }

    #[test]
    fn a_point_above_the_surface_is_over_the_stairs_and_beyond_a_first_ramp_over_steps() {
        let stairs = Stairs::uneven();
        for number in 0..1400_i16 {
            let y_m = 3.0 + f32::from(number) * 0.01 + 0.003;
            let at = [0.0, y_m, stairs.surface_z_m(0.0, y_m) + 0.3];
            assert!(stairs.is_over(at), "{y_m}");
            let expected = stairs.steps_climbed(f64::from(y_m));
            assert_eq!(stairs.steps_under(at), expected, "{y_m}");
            assert_eq!(
                crate::world::stair_profile::StairProfile::of(&stairs).climb(at).steps,
                expected
            );
        }
        assert!(!stairs.is_over([0.0, 4.5, 0.4]), "inside a slope");
    }

    #[test]
    fn boards_of_slopes_end_inside_the_boxes_around_them() {
        let stairs = Stairs::uneven();
        let boxes = stairs.boxes();
        for board in stairs.solids().into_iter().skip(boxes.len()) {
            for along in [1.0, -1.0] {
                let at = board.pose * Vector::new(0.0, along * board.half_m.y, -board.half_m.z);
                let is_inside = at.z <= 1.0e-4
                    || boxes.iter().any(|of| {
                        let within =
                            |axis: usize| of.min_m[axis] - 1.0e-4..=of.max_m[axis] + 1.0e-4;
                        within(1).contains(&at.y) && within(2).contains(&at.z)
                    });
                assert!(is_inside, "{at} of {board:?}");
            }
        }
    }

    #[test]
    fn the_outline_of_plain_stairs_has_the_corners_of_their_boxes() {
        let stairs = Stairs::default();
        let outline = stairs.outline_m();
        assert_eq!(outline.len(), 21);
        assert_eq!(outline[..4], [[3.0, 0.0], [3.0, 0.5], [5.0, 0.5], [5.0, 1.0]]);
        assert_eq!(outline[20], [37.0, 5.0]);
    }

    #[test]
    fn a_tread_at_the_level_of_the_ground_has_no_box() {
        let stairs = Stairs::uneven();
        assert_eq!(stairs.height_m(4), 0.0);
        assert!(stairs.boxes().iter().all(|of| of.step != 3));
    }
}
