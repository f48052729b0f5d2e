//! The saved form of XCS. The form in memory also has tables for matching.

use serde::{Deserialize, Serialize};

use super::mask_table::MaskTable;
use super::xcs::Xcs;
use super::xcs_rules::XcsRule;
use super::xcs_settings::XcsSettings;
use crate::check::Invalid;

/// The saved form of an [`Xcs`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SavedXcs {
    /// Parameters of the system.
    pub settings: XcsSettings,
    /// Number of bits of a situation, 1 to 32.
    pub situation_bits: usize,
    /// Number of actions, 1 to 256.
    pub actions: usize,
    /// Number of decisions learned from so far.
    pub time: u64,
    /// Rules in order of birth.
    pub rules: Vec<XcsRule>,
}

impl TryFrom<SavedXcs> for Xcs {
    type Error = Invalid;

    fn try_from(saved: SavedXcs) -> Result<Self, Invalid> {
        let SavedXcs { settings, situation_bits, actions, time, rules } = saved;
        let masks = MaskTable::of(rules.iter().map(|rule| (rule.condition, rule.action)));
        let numerosity = 0;
        let mut xcs = Self { settings, situation_bits, actions, time, rules, masks, numerosity };
        xcs.check()?;
        xcs.numerosity = xcs.rules.iter().map(|rule| rule.numerosity).sum();
        Ok(xcs)
    }
}

impl From<Xcs> for SavedXcs {
    fn from(xcs: Xcs) -> Self {
        let Xcs { settings, situation_bits, actions, time, rules, .. } = xcs;
        Self { settings, situation_bits, actions, time, rules }
    }
}

#[cfg(test)]
mod tests {
    use super::super::xcs_rules::samples::{rule, saved};
    use super::*;
    use crate::learn::classifiers::{EpisodeEnd, RecordedDecision};
    use crate::rng::{Purpose, stream};

    #[test]
    fn hostile_rule_sets_are_refused() {
        let good = || rule("1##", 0, 1.0, 1.0);
        let refused = |rules| Xcs::try_from(saved(rules)).unwrap_err().to_string();
        for (part, bad) in [
            ("rules[1].condition is 1#;", rule("1#", 0, 1.0, 1.0)),
            ("rules[1].condition is 1##; allowed: one rule", good()),
            ("rules[1].action is 3; allowed: 0 to 2", rule("0##", 3, 1.0, 1.0)),
            ("rules[1].prediction is NaN", rule("0##", 0, f32::NAN, 1.0)),
            ("rules[1].error is -1", XcsRule { error: -1.0, ..rule("0##", 0, 1.0, 1.0) }),
            ("rules[1].fitness is inf", rule("0##", 0, 1.0, f32::INFINITY)),
            ("rules[1].time_stamp is 6", XcsRule { time_stamp: 6, ..rule("0##", 0, 1.0, 1.0) }),
            ("action_set_size is 0;", XcsRule { action_set_size: 0.0, ..rule("0##", 0, 1.0, 1.0) }),
            ("rules[1].numerosity is 0", XcsRule { numerosity: 0, ..rule("0##", 0, 1.0, 1.0) }),
            (
                "numerosity is 4294967295",
                XcsRule { numerosity: u32::MAX, ..rule("0##", 0, 1.0, 1.0) },
            ),
            ("sum of numerosities is 11", XcsRule { numerosity: 10, ..rule("0##", 0, 1.0, 1.0) }),
        ] {
            let error = refused(vec![good(), bad]);
            assert!(error.contains(part), "{error}");
        }
        assert!(refused(vec![good(); 11]).starts_with("rules is 11; allowed: 0 to 10"));
        assert!(Xcs::new(XcsSettings::default(), 0, 2).is_err());
        assert!(Xcs::new(XcsSettings::default(), 33, 2).is_err());
        assert!(Xcs::new(XcsSettings::default(), 3, 0).is_err());
        let small = XcsSettings { population: 3, ..XcsSettings::default() };
        assert!(Xcs::new(small, 3, 4).is_err());
    }

    #[test]
    fn a_saved_population_goes_on_exactly_as_the_original() {
        let settings = XcsSettings { population: 40, ..XcsSettings::default() };
        let mut xcs = Xcs::new(settings, 4, 2).unwrap();
        let mut rng = stream(5, 0, 0, Purpose::Birth);
        let experience: Vec<RecordedDecision> = (0..300_u32)
            .map(|i| RecordedDecision {
                bits: i * 7 % 16,
                action: (i % 2) as u16,
                reward: (i % 5) as f32,
            })
            .collect();
        xcs.learn(&experience, EpisodeEnd::TimeOut { bits: 3 }, &mut rng).unwrap();
        let text = ron::to_string(&xcs).unwrap();
        let mut read: Xcs = ron::from_str(&text).unwrap();
        assert_eq!(read, xcs);
        let end = EpisodeEnd::Terminal;
        let report = xcs.learn(&experience, end, &mut stream(6, 0, 0, Purpose::Birth)).unwrap();
        assert_eq!(read.learn(&experience, end, &mut stream(6, 0, 0, Purpose::Birth)), Ok(report));
        assert_eq!(read, xcs);
        assert_eq!(xcs.check(), Ok(()));
        assert!(ron::from_str::<Xcs>(&text.replacen("experience:", "experience:-", 1)).is_err());
    }
}
