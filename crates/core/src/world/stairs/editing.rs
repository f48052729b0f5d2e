//! Changes of single steps, for an editor. Slopes become shallower where they would not fit. The resulting stairs may not be allowed:
//! [`crate::schema::check`] checks them.

use super::Stairs;
use crate::schema::PerPart;

/// Lengths that an editor sets are multiples of this length, in metres, so that sums of rises and treads are short numbers.
const GRAIN_M: f32 = 0.001;

impl Stairs {
    /// Returns the front edge of a step's tread, by which an editor moves the step: y and z, in metres. For a step down, it is the corner
    /// where the step's tread begins.
    pub fn handle_m(&self, step: u32) -> [f32; 2] {
        let y_m = self.tread_y_m(step) - self.step_nosing_m(step);
        [y_m, self.height_m(step + 1)]
    }

    /// Returns the stairs with the handle of a step at another place, y and z in metres. All other steps stay where they are. If the last
    /// step moves, everything behind it moves with it.
    #[must_use]
    pub fn with_handle_at(&self, step: u32, [y_m, z_m]: [f32; 2]) -> Self {
        let index = step as usize;
        if step >= self.steps {
            return self.clone();
        }
        let [from_y_m, from_z_m] = self.handle_m(step);
        let [along_m, up_m] = [y_m - from_y_m, z_m - from_z_m];
        let [mut rises_m, mut treads_m, slopes_m] = self.each_step();
        let add = |length_m: &mut f32, by_m: f32| {
            if by_m != 0.0 {
                *length_m = on_grain_m(*length_m + by_m);
            }
        };
        add(&mut rises_m[index], up_m);
        if let Some(next_m) = rises_m.get_mut(index + 1) {
            add(next_m, -up_m);
            add(&mut treads_m[index], -along_m);
        }
        let mut first_riser_y_m = self.first_riser_y_m;
        match index.checked_sub(1) {
            Some(before) => add(&mut treads_m[before], along_m),
            None => add(&mut first_riser_y_m, along_m),
        }
        Self { first_riser_y_m, ..self.with_steps([rises_m, treads_m, slopes_m]) }
    }

    /// Returns the stairs with another rise of one step, in metres. The steps above it are lifted or lowered.
    #[must_use]
    pub fn with_step_rise(&self, step: u32, rise_m: f32) -> Self {
        let [mut rises_m, treads_m, slopes_m] = self.each_step();
        if let Some(of) = rises_m.get_mut(step as usize) {
            *of = on_grain_m(rise_m);
        }
        self.with_steps([rises_m, treads_m, slopes_m])
    }

    /// Returns the stairs with another tread of one step, in metres. The steps behind it are moved.
    #[must_use]
    pub fn with_step_tread(&self, step: u32, tread_m: f32) -> Self {
        let [rises_m, mut treads_m, slopes_m] = self.each_step();
        if let Some(of) = treads_m.get_mut(step as usize) {
            *of = on_grain_m(tread_m);
        }
        self.with_steps([rises_m, treads_m, slopes_m])
    }

    /// Returns the stairs with a copy of a step inserted behind it.
    #[must_use]
    pub fn with_step_copied(&self, step: u32) -> Self {
        let copied = |mut each: Vec<f32>| {
            if let Some(value) = each.get(step as usize).copied() {
                each.insert(step as usize, value);
            }
            each
        };
        self.with_steps(self.each_step().map(copied))
    }

    /// Returns the stairs without this step. The steps behind it move into its place.
    #[must_use]
    pub fn without_step(&self, step: u32) -> Self {
        let rest = |mut each: Vec<f32>| {
            if (step as usize) < each.len() {
                each.remove(step as usize);
            }
            each
        };
        self.with_steps(self.each_step().map(rest))
    }

    /// Returns the rise, the tread and the slope of each step.
    fn each_step(&self) -> [Vec<f32>; 3] {
        let lengths: [fn(&Self, u32) -> f32; 3] =
            [Self::step_rise_m, Self::step_tread_m, Self::step_slope_m];
        lengths.map(|length_m| (0..self.steps).map(|step| length_m(self, step)).collect())
    }

    fn with_steps(&self, [rises_m, treads_m, slopes_m]: [Vec<f32>; 3]) -> Self {
        let steps = rises_m.len() as u32;
        Self {
            steps,
            rise_m: shortest(rises_m, &self.rise_m),
            tread_m: shortest(treads_m, &self.tread_m),
            slope_m: shortest(slopes_m, &self.slope_m),
            ..self.clone()
        }
        .with_room_for_slopes()
    }
}

/// Returns one value for all steps if they are equal, so that equal steps stay plain stairs.
fn shortest(each: Vec<f32>, before: &PerPart) -> PerPart {
    match each.first() {
        Some(first) if each.iter().all(|value| value == first) => PerPart::All(*first),
        Some(_) => PerPart::Each(each),
        // Without steps, the value for later steps is kept.
        None => PerPart::All(before.at(0)),
    }
}

fn on_grain_m(length_m: f32) -> f32 {
    let grains = f64::from(length_m) / f64::from(GRAIN_M);
    #[expect(clippy::cast_possible_truncation, reason = "a setting is a 32-bit float")]
    let rounded_m = (grains.round() / 1000.0) as f32;
    rounded_m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::check;

    #[test]
    fn a_moved_handle_leaves_the_other_steps_where_they_are() {
        let stairs = Stairs::default();
        let moved = stairs.with_handle_at(3, [9.4, 2.25]);
        check(&moved).expect("allowed");
        assert_eq!(moved.handle_m(3), [9.4, 2.25]);
        for step in (0..10).filter(|step| *step != 3) {
            let [[y_m, z_m], [then_y_m, then_z_m]] =
                [&stairs, &moved].map(|stairs| stairs.handle_m(step));
            assert!((y_m - then_y_m).abs() < 1.0e-4 && (z_m - then_z_m).abs() < 1.0e-4, "{step}");
        }
        assert_eq!([moved.step_rise_m(3), moved.step_rise_m(4)], [0.75, 0.25]);
        assert_eq!([moved.step_tread_m(2), moved.step_tread_m(3)], [2.4, 1.6]);
        assert_eq!(moved.with_handle_at(3, [9.0, 2.0]), stairs, "equal steps are plain again");
    }

    #[test]
    fn the_first_handle_moves_the_beginning_and_the_last_one_the_landing() {
        let stairs = Stairs::default();
        let first = stairs.with_handle_at(0, [2.5, 0.5]);
        assert_eq!((first.first_riser_y_m, first.step_tread_m(0)), (2.5, 2.5));
        let last = stairs.with_handle_at(9, [21.5, 5.5]);
        assert_eq!((last.end_y_m(), last.height_m(10)), (stairs.end_y_m() + 0.5, 5.5));
        assert_eq!(last.step_tread_m(9), 2.0);
        assert_eq!(stairs.with_handle_at(10, [0.0, 0.0]), stairs, "there is no such step");
    }

    #[test]
    fn a_handle_is_at_the_edge_of_nosings_slopes_and_steps_down() {
        let stairs = Stairs::uneven();
        for step in 0..stairs.steps {
            let [y_m, z_m] = stairs.handle_m(step);
            let moved = stairs.with_handle_at(step, [y_m, z_m]);
            assert_eq!(moved, stairs, "not moved at all: step {step}");
            let [y_m, z_m] = [y_m + 0.125, z_m + 0.0625];
            let moved = stairs.with_handle_at(step, [y_m, z_m]);
            let [then_y_m, then_z_m] = moved.handle_m(step);
            assert!((then_y_m - y_m).abs() < 2.0e-3 && (then_z_m - z_m).abs() < 2.0e-3, "{step}");
        }
    }

    #[test]
    fn steps_of_ramps_can_be_moved() {
        let plain = Stairs::default();
        let ramps = Stairs { slope_m: PerPart::Each(vec![1.75; 10]), ..plain };
        check(&ramps).expect("as deep as is allowed");
        let [y_m, z_m] = ramps.handle_m(4);
        let higher = ramps.with_handle_at(4, [y_m, z_m + 0.2]);
        check(&higher).expect("the slope is less deep now");
        assert!((higher.step_slope_m(4) - 1.65).abs() < 1.0e-6);
        check(&ramps.with_step_tread(3, 1.5)).expect("allowed");
    }

    #[test]
    fn steps_are_changed_copied_and_removed() {
        let stairs = Stairs::default();
        let changed = stairs.with_step_rise(1, 0.7).with_step_tread(1, 1.5);
        assert_eq!(changed.height_m(10), 5.2);
        assert_eq!(changed.riser_y_m(2), 6.5);
        let longer = changed.with_step_copied(1);
        assert_eq!(longer.steps, 11);
        assert_eq!([1, 2, 3].map(|step| longer.step_rise_m(step)), [0.7, 0.7, 0.5]);
        assert_eq!(longer.without_step(2), changed);
        assert_eq!(changed.without_step(1), Stairs { steps: 9, ..stairs });
        let uneven = Stairs::uneven();
        check(&uneven.with_step_copied(0)).expect("each list has a value more");
        let none = Stairs { steps: 1, ..Stairs::default() }.without_step(0);
        assert_eq!(none, Stairs { steps: 0, ..Stairs::default() });
    }
}
