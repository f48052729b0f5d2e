//! Subsumption: an accurate rule stands for the more special ones that say the same.

use super::xcs::Xcs;
use super::xcs_rules::XcsRule;

impl Xcs {
    /// Adds a child to a parent that says the same in general, to an equal rule, or to the population.
    pub(super) fn settle(&mut self, child: XcsRule, parents: [usize; 2]) {
        let subsumes = |&parent: &usize| {
            let parent = &self.rules[parent];
            self.may_subsume(parent)
                && parent.action == child.action
                && parent.condition.is_more_general_than(&child.condition)
        };
        let subsumer = parents.into_iter().find(subsumes).filter(|_| self.settings.ga_subsumption);
        match subsumer.or_else(|| self.masks.find(&child.condition, child.action)) {
            Some(same) => {
                self.rules[same].numerosity += 1;
                self.numerosity += 1;
            }
            None => self.add(child),
        }
    }

    /// Whether a rule is accurate and experienced enough to replace more special ones.
    fn may_subsume(&self, rule: &XcsRule) -> bool {
        rule.experience > self.settings.subsumption_experience
            && rule.error < self.settings.error_threshold
    }

    /// Lets the most general accurate rule of an action set, the oldest among equals, absorb the more special ones.
    pub(super) fn subsume_within(&mut self, set: &mut Vec<usize>, alive: &mut Vec<usize>) {
        let mut subsumer: Option<usize> = None;
        for &index in set.iter().filter(|&&index| self.may_subsume(&self.rules[index])) {
            let wildcards = |index: usize| self.rules[index].condition.wildcards();
            if subsumer.is_none_or(|best| wildcards(index) > wildcards(best)) {
                subsumer = Some(index);
            }
        }
        let Some(subsumer) = subsumer else { return };
        let general = self.rules[subsumer].condition;
        let is_absorbed = |&&i: &&usize| general.is_more_general_than(&self.rules[i].condition);
        let absorbed: Vec<usize> = set.iter().filter(is_absorbed).copied().collect();
        for &index in &absorbed {
            self.rules[subsumer].numerosity += std::mem::take(&mut self.rules[index].numerosity);
        }
        self.remove_rules(&absorbed, [set, alive]);
    }
}

#[cfg(test)]
mod tests {
    use super::super::XcsSettings;
    use super::*;

    fn empty(settings: XcsSettings) -> Xcs {
        Xcs::new(settings, 3, 2).unwrap()
    }

    fn experienced(condition: &str, action: u16) -> XcsRule {
        XcsRule {
            condition: condition.parse().unwrap(),
            action,
            prediction: 100.0,
            error: 0.0,
            fitness: 0.5,
            experience: 21,
            time_stamp: 0,
            action_set_size: 2.0,
            numerosity: 1,
        }
    }

    #[test]
    fn a_child_of_an_accurate_general_parent_only_adds_to_its_numerosity() {
        let settles = |change: &dyn Fn(&mut Xcs)| {
            let mut xcs = empty(XcsSettings::default());
            xcs.add(experienced("1##", 0));
            change(&mut xcs);
            xcs.settle(experienced("10#", 0), [0, 0]);
            (xcs.rules.len(), xcs.rules[0].numerosity, xcs.numerosity)
        };
        assert_eq!(settles(&|_| {}), (1, 2, 2));
        assert_eq!(settles(&|xcs| xcs.rules[0].error = 10.0), (2, 1, 2));
        assert_eq!(settles(&|xcs| xcs.rules[0].experience = 20), (2, 1, 2));
        assert_eq!(settles(&|xcs| xcs.rules[0].action = 1), (2, 1, 2));
        assert_eq!(settles(&|xcs| xcs.settings.ga_subsumption = false), (2, 1, 2));
        // An equal rule is never added twice, accurate or not.
        let mut xcs = empty(XcsSettings::default());
        xcs.add(XcsRule { error: 500.0, ..experienced("10#", 0) });
        xcs.settle(experienced("10#", 0), [0, 0]);
        assert_eq!((xcs.rules.len(), xcs.rules[0].numerosity), (1, 2));
    }

    #[test]
    fn the_most_general_accurate_rule_of_an_action_set_absorbs_the_others() {
        let mut xcs = empty(XcsSettings::default());
        xcs.add(experienced("10#", 0));
        xcs.add(XcsRule { error: 500.0, ..experienced("###", 0) });
        xcs.add(experienced("1##", 0));
        xcs.add(XcsRule { numerosity: 4, ..experienced("101", 0) });
        xcs.add(experienced("##1", 0));
        let (mut set, mut alive) = (vec![0, 1, 2, 3, 4], vec![2, 3, 4]);
        xcs.subsume_within(&mut set, &mut alive);
        let texts: Vec<String> = xcs.rules.iter().map(|rule| rule.condition.to_string()).collect();
        assert_eq!(texts, ["###", "1##", "##1"], "the order of birth stays");
        assert_eq!((xcs.rules[1].numerosity, xcs.numerosity), (6, 8));
        assert_eq!((set, alive), (vec![0, 1, 2], vec![1, 2]));
    }
}
