//! Subsumption: an accurate rule replaces more special rules with the same action.

use super::xcs::Xcs;
use super::xcs_rules::XcsRule;

impl Xcs {
    /// Adds a child to the population. It only increases the numerosity of a more general parent with the same action, or of an equal
    /// rule, if there is one.
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

    /// Returns whether a rule is accurate and experienced enough to replace more special ones.
    pub(super) fn may_subsume(&self, rule: &XcsRule) -> bool {
        rule.experience > self.settings.subsumption_experience
            && rule.error < self.settings.error_threshold
    }
}

#[cfg(test)]
mod tests {
    use super::super::XcsSettings;
    use super::super::xcs_rules::samples::experienced;
    use super::*;

    fn empty() -> Xcs {
        Xcs::new(XcsSettings::default(), 3, 2).unwrap()
    }

    #[test]
    fn a_child_of_an_accurate_general_parent_only_adds_to_its_numerosity() {
        let settles = |change: &dyn Fn(&mut Xcs)| {
            let mut xcs = empty();
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
        // A rule equal to another is never added, whether it is accurate or not.
        let mut xcs = empty();
        xcs.add(XcsRule { error: 500.0, ..experienced("10#", 0) });
        xcs.settle(experienced("10#", 0), [0, 0]);
        assert_eq!((xcs.rules.len(), xcs.rules[0].numerosity), (1, 2));
    }
}
