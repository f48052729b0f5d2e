//! Rules of building codes for stairs, compared at the scale of real stairs.
//!
//! The snake is far larger than a person, so only proportions can be compared: a rise of 0.5 m stands for a rise of 175 mm. On this scale
//! the snake of five blocks is 3.5 m long.

use super::Stairs;

/// Millimetres of a real staircase that correspond to one metre of the simulated stairs.
pub const TRUE_MM_PER_M: f32 = 350.0;

/// Rules of a building code for the rises and treads of stairs. All lengths are in millimetres of real stairs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BuildingCode {
    /// Kind of building and country to which the code applies.
    pub name: &'static str,
    /// Name and section of the code.
    pub source: &'static str,
    /// Least and greatest rise allowed, in mm.
    pub rise_mm: [f32; 2],
    /// Least and greatest tread allowed, in mm.
    pub tread_mm: [f32; 2],
    /// Greatest difference allowed between the rises of a flight, and between its treads, in mm; `None` if the code sets no limit.
    pub spread_mm: Option<f32>,
    /// Least and greatest sum of two rises and a tread, which is about a pace, in mm; `None` if the code sets no limit.
    pub pace_mm: Option<[f32; 2]>,
}

/// The building codes with which stairs are compared.
pub const BUILDING_CODES: [BuildingCode; 3] = [
    BuildingCode {
        name: "Homes, United States",
        source: "International Residential Code, R311.7.5: rises up to 196 mm, treads from 254 mm, equal within 9.5 mm",
        rise_mm: [0.0, 196.0],
        tread_mm: [254.0, f32::MAX],
        spread_mm: Some(9.5),
        pace_mm: None,
    },
    BuildingCode {
        name: "Public buildings, United States",
        source: "International Building Code, 1011.5: rises of 102 to 178 mm, treads from 279 mm, equal within 9.5 mm",
        rise_mm: [102.0, 178.0],
        tread_mm: [279.0, f32::MAX],
        spread_mm: Some(9.5),
        pace_mm: None,
    },
    BuildingCode {
        name: "Homes, Germany",
        source: "DIN 18065: rises of 140 to 200 mm, treads of 230 to 370 mm, two rises and a tread make 590 to 650 mm",
        rise_mm: [140.0, 200.0],
        tread_mm: [230.0, 370.0],
        spread_mm: None,
        pace_mm: Some([590.0, 650.0]),
    },
];

/// Depth from which a tread counts as a landing, to which the rules for treads do not apply, in millimetres: the depth in the
/// International Residential Code, R311.7.6.
const LANDING_MM: f32 = 914.0;
/// Tolerance for errors of rounding, in millimetres.
const TOLERANCE_MM: f32 = 0.01;

impl Stairs {
    /// Returns whether the tread of step number `index` (0 is the first) is so deep that it counts as a landing in building codes.
    fn is_landing(&self, index: u32) -> bool {
        true_mm(self.step_tread_m(index)) >= LANDING_MM
    }

    /// Returns the mean rise and the mean tread in millimetres of real stairs; `None` without steps. A step down counts like a step up.
    /// Treads that are landings do not count.
    pub fn mean_step_mm(&self) -> Option<[f32; 2]> {
        let mean = |lengths: Vec<f32>| {
            (!lengths.is_empty()).then(|| lengths.iter().sum::<f32>() / lengths.len() as f32)
        };
        let rise_mm = mean((0..self.steps).map(|step| true_mm(self.step_rise_m(step))).collect())?;
        let treads = (0..self.steps).filter(|step| !self.is_landing(*step));
        let tread_mm = mean(treads.map(|step| true_mm(self.step_tread_m(step))).collect());
        // If all treads are landings, the depth of the first one stands for the mean.
        Some([rise_mm, tread_mm.unwrap_or_else(|| true_mm(self.step_tread_m(0)))])
    }
}

fn true_mm(length_m: f32) -> f32 {
    length_m.abs() * TRUE_MM_PER_M
}

impl BuildingCode {
    /// Returns the slope, rise over tread, of the steepest stairs that the code allows.
    pub fn steepest(&self) -> f32 {
        let [_, rise_mm] = self.rise_mm;
        let [mut tread_mm, _] = self.tread_mm;
        if let Some([least_mm, _]) = self.pace_mm {
            tread_mm = tread_mm.max(least_mm - 2.0 * rise_mm);
        }
        rise_mm / tread_mm
    }

    /// Describes how the rises and treads of stairs break the code; `None` if they follow it. A step down counts like a step up.
    pub fn problem(&self, stairs: &Stairs) -> Option<String> {
        if let Some(step) = (0..stairs.steps).find(|step| stairs.step_slope_m(*step) > 0.0) {
            return Some(format!("step {} is a ramp", step + 1));
        }
        let outside = |what: String, mm: f32, [least_mm, most_mm]: [f32; 2]| {
            if mm > most_mm + TOLERANCE_MM {
                Some(format!("{what} is {mm:.0} mm, over {most_mm:.0}"))
            } else if mm < least_mm - TOLERANCE_MM {
                Some(format!("{what} is {mm:.0} mm, under {least_mm:.0}"))
            } else {
                None
            }
        };
        for step in 0..stairs.steps {
            let number = step + 1;
            let rise_mm = true_mm(stairs.step_rise_m(step));
            let problem = outside(format!("rise {number}"), rise_mm, self.rise_mm);
            if problem.is_some() {
                return problem;
            }
            // The last tread is level with the landing and belongs to it.
            if number == stairs.steps || stairs.is_landing(step) {
                continue;
            }
            let tread_mm = true_mm(stairs.step_tread_m(step));
            let of_tread = || outside(format!("tread {number}"), tread_mm, self.tread_mm);
            let pace_mm = 2.0 * rise_mm + tread_mm;
            let of_pace = || outside(format!("the pace of step {number}"), pace_mm, self.pace_mm?);
            let problem = of_tread().or_else(of_pace);
            if problem.is_some() {
                return problem;
            }
        }
        self.problem_of_flights(stairs)
    }

    /// Describes how unequal the steps between two landings are, if the code does not allow it; `None` if it does.
    fn problem_of_flights(&self, stairs: &Stairs) -> Option<String> {
        let most_mm = self.spread_mm?;
        let too_uneven = |what: &str, lengths_mm: &[f32]| {
            let least = lengths_mm.iter().copied().fold(f32::MAX, f32::min);
            let spread_mm = lengths_mm.iter().map(|mm| mm - least).fold(0.0, f32::max);
            (spread_mm > most_mm + TOLERANCE_MM)
                .then(|| format!("{what} of a flight differ by {spread_mm:.0} mm, over {most_mm}"))
        };
        let (mut rises_mm, mut treads_mm) = (Vec::new(), Vec::new());
        for step in 0..stairs.steps {
            rises_mm.push(true_mm(stairs.step_rise_m(step)));
            let is_end = step + 1 == stairs.steps || stairs.is_landing(step);
            if !is_end {
                treads_mm.push(true_mm(stairs.step_tread_m(step)));
                continue;
            }
            let problem =
                too_uneven("rises", &rises_mm).or_else(|| too_uneven("treads", &treads_mm));
            if problem.is_some() {
                return problem;
            }
            rises_mm.clear();
            treads_mm.clear();
        }
        None
    }
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
    fn stairs_of_a_house_follow_every_code_and_the_default_ones_have_too_deep_treads() {
        assert_eq!(problems(&equal(0.5, 0.8)), [None, None, None]);
        let deep = "tread 1 is 700 mm, over 370".to_owned();
        assert_eq!(problems(&Stairs::default()), [None, None, Some(deep)]);
    }

    #[test]
    fn the_first_problem_is_named_with_its_limit() {
        let said = |stairs: &Stairs, code: usize| problems(stairs)[code].clone().expect("refused");
        assert_eq!(said(&equal(0.6, 0.8), 0), "rise 1 is 210 mm, over 196");
        assert_eq!(said(&equal(0.52, 0.8), 1), "rise 1 is 182 mm, over 178");
        assert_eq!(said(&equal(0.2, 0.8), 1), "rise 1 is 70 mm, under 102");
        assert_eq!(said(&equal(0.5, 0.7), 0), "tread 1 is 245 mm, under 254");
        assert_eq!(said(&equal(0.55, 0.8), 2), "the pace of step 1 is 665 mm, over 650");
        assert_eq!(said(&Stairs::uneven(), 0), "step 1 is a ramp");
        assert_eq!(problems(&Stairs { steps: 0, ..Stairs::default() }), [None, None, None]);
    }

    #[test]
    fn steps_have_to_be_equal_within_a_flight_but_not_across_a_landing() {
        let with_treads = |treads_m: [f32; 3]| Stairs {
            steps: 3,
            rise_m: PerPart::Each(vec![0.46, 0.5, 0.5]),
            tread_m: PerPart::Each(treads_m.to_vec()),
            ..Stairs::default()
        };
        let uneven = problems(&with_treads([0.8, 0.8, 0.8]));
        assert_eq!(uneven[0].as_deref(), Some("rises of a flight differ by 14 mm, over 9.5"));
        let landing = with_treads([5.0, 0.8, 0.8]);
        assert_eq!(problems(&landing), [None, None, None]);
        assert_eq!(landing.mean_step_mm().map(|[_, tread_mm]| tread_mm), Some(280.0));
    }

    #[test]
    fn the_steepest_stairs_of_a_code_follow_it_and_steeper_ones_do_not() {
        for code in BUILDING_CODES {
            let rise_m = code.rise_mm[1] / TRUE_MM_PER_M;
            let tread_m = rise_m / code.steepest();
            assert_eq!(code.problem(&equal(rise_m, tread_m)), None, "{}", code.name);
            let steeper = equal(rise_m, tread_m * 0.99);
            assert!(code.problem(&steeper).is_some(), "{}", code.name);
        }
    }
}
