//! What building codes say about stairs, in the proportions of the real ones.
//!
//! The snake is a toy of another size than a person, so only proportions can be compared: a rise of 0.5 m stands for one of
//! 175 mm, where the snake of five blocks would be 3.5 m long.

use super::Stairs;

/// Millimetres of a real staircase for a metre of the snake's.
pub const TRUE_MM_PER_M: f32 = 350.0;

/// A rule for stairs. All lengths are in millimetres of real stairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuildingCode {
    /// Where it applies.
    pub name: &'static str,
    /// Its name and section.
    pub source: &'static str,
    /// Least and greatest rise.
    pub rise_mm: [f32; 2],
    /// Least tread.
    pub least_tread_mm: f32,
    /// Greatest difference between the rises of a flight, and between its treads.
    pub spread_mm: Option<f32>,
    /// Least and greatest sum of two rises and a tread, which is about a pace.
    pub pace_mm: Option<[f32; 2]>,
}

/// The codes that stairs are compared with.
pub const BUILDING_CODES: [BuildingCode; 3] = [
    BuildingCode {
        name: "Homes, United States",
        source: "International Residential Code, R311.7.5",
        rise_mm: [0.0, 196.0],
        least_tread_mm: 254.0,
        spread_mm: Some(9.5),
        pace_mm: None,
    },
    BuildingCode {
        name: "Public buildings, United States",
        source: "International Building Code, 1011.5",
        rise_mm: [102.0, 178.0],
        least_tread_mm: 279.0,
        spread_mm: Some(9.5),
        pace_mm: None,
    },
    BuildingCode {
        name: "Comfortable pace, Germany",
        source: "DIN 18065: two rises and a tread make 590 to 650 mm",
        rise_mm: [0.0, f32::MAX],
        least_tread_mm: 0.0,
        spread_mm: None,
        pace_mm: Some([590.0, 650.0]),
    },
];

/// Depth from which a tread is a landing, which the rules for treads leave out, in millimetres: that of the International
/// Residential Code, R311.7.6.
const LANDING_MM: f32 = 914.0;
/// Errors of rounding, in millimetres.
const TOLERANCE_MM: f32 = 0.01;

impl BuildingCode {
    /// The steepest stairs that it allows: the greatest rise over the least tread.
    pub fn steepest(&self) -> Option<f32> {
        let [_, most_mm] = self.rise_mm;
        (self.least_tread_mm > 0.0).then(|| most_mm / self.least_tread_mm)
    }

    /// Why stairs do not follow it, in words; `None` if they do. A step down counts like one up.
    pub fn problem(&self, stairs: &Stairs) -> Option<String> {
        if (0..stairs.steps).any(|step| stairs.step_slope_m(step) > 0.0) {
            return Some("a ramp is no step".to_owned());
        }
        let mm = |length_m: f32| length_m.abs() * TRUE_MM_PER_M;
        let rises_mm = || (0..stairs.steps).map(|step| (step, mm(stairs.step_rise_m(step))));
        let [least_mm, most_mm] = self.rise_mm;
        for (step, rise_mm) in rises_mm() {
            let step = step + 1;
            if rise_mm > most_mm + TOLERANCE_MM {
                return Some(format!("step {step} rises {rise_mm:.0} mm, over {most_mm:.0}"));
            }
            if rise_mm < least_mm - TOLERANCE_MM {
                return Some(format!("step {step} rises {rise_mm:.0} mm, under {least_mm:.0}"));
            }
        }
        // The last tread is level with the landing.
        let treads_mm = || {
            let before_last = 0..stairs.steps.saturating_sub(1);
            let treads_mm = before_last.map(|step| (step, mm(stairs.step_tread_m(step))));
            treads_mm.filter(|(_, tread_mm)| *tread_mm < LANDING_MM)
        };
        for (step, tread_mm) in treads_mm() {
            let step = step + 1;
            if tread_mm < self.least_tread_mm - TOLERANCE_MM {
                let least_mm = self.least_tread_mm;
                return Some(format!("tread {step} is {tread_mm:.0} mm, under {least_mm:.0}"));
            }
            let pace_mm = 2.0 * mm(stairs.step_rise_m(step - 1)) + tread_mm;
            if let Some([least_mm, most_mm]) = self.pace_mm
                && !(least_mm - TOLERANCE_MM..=most_mm + TOLERANCE_MM).contains(&pace_mm)
            {
                return Some(format!("the pace of step {step} is {pace_mm:.0} mm"));
            }
        }
        let most_spread_mm = self.spread_mm?;
        let too_uneven = |what: &str, spread_mm: f32| {
            (spread_mm > most_spread_mm + TOLERANCE_MM)
                .then(|| format!("{what} differ by {spread_mm:.0} mm, over {most_spread_mm:.1}"))
        };
        too_uneven("rises", spread(rises_mm().map(|(_, mm)| mm)))
            .or_else(|| too_uneven("treads", spread(treads_mm().map(|(_, mm)| mm))))
    }
}

/// The difference between the greatest and the least of some lengths; 0 of none.
fn spread(lengths: impl Iterator<Item = f32>) -> f32 {
    let [mut least, mut most] = [f32::MAX, f32::MIN];
    for length in lengths {
        (least, most) = (least.min(length), most.max(length));
    }
    (most - least).max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::PerPart;

    fn problems(stairs: &Stairs) -> [Option<String>; 3] {
        BUILDING_CODES.map(|code| code.problem(stairs))
    }

    fn equal(rise_m: f32, tread_m: f32) -> Stairs {
        Stairs { rise_m: rise_m.into(), tread_m: tread_m.into(), ..Stairs::default() }
    }

    #[test]
    fn stairs_of_a_house_follow_every_code_and_the_default_ones_are_too_flat_for_a_pace() {
        assert_eq!(problems(&equal(0.5, 0.8)), [None, None, None]);
        let pace = "the pace of step 1 is 1050 mm".to_owned();
        assert_eq!(problems(&Stairs::default()), [None, None, Some(pace)]);
    }

    #[test]
    fn the_first_problem_is_named_with_its_limit() {
        let said = |stairs: &Stairs, code: usize| problems(stairs)[code].clone().expect("refused");
        assert_eq!(said(&equal(0.6, 0.8), 0), "step 1 rises 210 mm, over 196");
        assert_eq!(said(&equal(0.52, 0.8), 1), "step 1 rises 182 mm, over 178");
        assert_eq!(said(&equal(0.2, 0.8), 1), "step 1 rises 70 mm, under 102");
        assert_eq!(said(&equal(0.5, 0.7), 0), "tread 1 is 245 mm, under 254");
        let uneven =
            Stairs { steps: 3, rise_m: PerPart::Each(vec![0.5, 0.46, 0.5]), ..equal(0.5, 0.8) };
        assert_eq!(said(&uneven, 0), "rises differ by 14 mm, over 9.5");
        let landing =
            Stairs { steps: 3, tread_m: PerPart::Each(vec![0.8, 5.0, 0.8]), ..equal(0.5, 0.8) };
        assert_eq!(problems(&landing), [None, None, None], "a landing is no tread");
        assert_eq!(said(&Stairs::uneven(), 0), "a ramp is no step");
        assert_eq!(problems(&Stairs { steps: 0, ..Stairs::default() }), [None, None, None]);
    }

    #[test]
    fn the_steepest_allowed_stairs_are_known_where_a_code_limits_both() {
        let steepest = BUILDING_CODES.map(|code| code.steepest().map(|of| (of * 100.0).round()));
        assert_eq!(steepest, [Some(77.0), Some(64.0), None]);
    }
}
