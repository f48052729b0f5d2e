//! The conditions and actions of a rule population, laid out for matching.
//!
//! Every decision compares the situation with every rule. The table keeps only the words needed for this comparison, each kind in an array
//! of its own, so that the processor compares several rules at a time and 2,000 rules take 16 kB of memory.

use super::condition::Condition;

/// Number of rules that are first tested together for whether any of them matches. Few rules match, so most blocks need no second test.
const BLOCK: usize = 16;

/// The masks and actions of rules, in the order of the rules.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MaskTable {
    cares: Vec<u32>,
    values: Vec<u32>,
    actions: Vec<u16>,
}

impl MaskTable {
    /// Builds the table of these rules.
    pub fn of(rules: impl Iterator<Item = (Condition, u16)>) -> Self {
        let mut table = Self::default();
        rules.for_each(|(condition, action)| table.push(&condition, action));
        table
    }

    /// Adds a rule at the end.
    pub fn push(&mut self, condition: &Condition, action: u16) {
        self.cares.push(condition.care());
        self.values.push(condition.value());
        self.actions.push(action);
    }

    /// Removes the rules at these indices, which are in ascending order. The other rules move up.
    pub fn remove_all(&mut self, indices: &[usize]) {
        remove_all(&mut self.cares, indices);
        remove_all(&mut self.values, indices);
        remove_all(&mut self.actions, indices);
    }

    /// Writes the indices of the rules that match a situation into `matched`, in ascending order.
    pub fn match_into(&self, bits: u32, matched: &mut Vec<usize>) {
        matched.clear();
        let is_match = |(care, value): (&u32, &u32)| (bits ^ value) & care == 0;
        let blocks = self.cares.chunks(BLOCK).zip(self.values.chunks(BLOCK));
        for (block, (cares, values)) in blocks.enumerate() {
            // The test has no branch per rule, so that the processor compares a whole block at once.
            if cares.iter().zip(values).fold(false, |any, masks| any | is_match(masks)) {
                let matches = cares.iter().zip(values).enumerate();
                let matches = matches.filter(|&(_, masks)| is_match(masks));
                matched.extend(matches.map(|(index, _)| block * BLOCK + index));
            }
        }
    }

    /// Returns the index of the first rule with this condition and action; `None` if there is none.
    pub fn find(&self, condition: &Condition, action: u16) -> Option<usize> {
        let masks = self.cares.iter().zip(&self.values).zip(&self.actions);
        let sought = ((condition.care(), condition.value()), action);
        masks.into_iter().position(|((&care, &value), &action)| ((care, value), action) == sought)
    }

    /// Returns the action of a rule.
    pub fn action(&self, index: usize) -> usize {
        usize::from(self.actions[index])
    }
}

/// Removes the items at these indices, which are in ascending order.
fn remove_all<T>(items: &mut Vec<T>, indices: &[usize]) {
    let mut left = indices.iter().peekable();
    let mut index = 0;
    items.retain(|_| {
        let is_removed = left.next_if_eq(&&index).is_some();
        index += 1;
        !is_removed
    });
}

/// Corrects an ascending list of indices after the rule at `removed` was removed.
pub fn forget(indices: &mut Vec<usize>, removed: usize) {
    indices.retain(|&index| index != removed);
    indices.iter_mut().filter(|index| **index > removed).for_each(|index| *index -= 1);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(texts: &[&str]) -> MaskTable {
        MaskTable::of(texts.iter().enumerate().map(|(i, text)| (text.parse().unwrap(), i as u16)))
    }

    #[test]
    fn the_table_matches_as_the_conditions_do() {
        let mut table = table(&["00#", "###", "1##", "0#1"]);
        let mut matched = vec![7; 9];
        table.match_into(0b100, &mut matched);
        assert_eq!(matched, [0, 1, 3]);
        table.remove_all(&[1]);
        table.match_into(0b100, &mut matched);
        assert_eq!(matched, [0, 2]);
        assert_eq!(table.action(1), 2);
    }

    #[test]
    fn many_rules_match_as_they_do_one_by_one() {
        let texts: Vec<String> = (0..100_u32).map(|i| format!("{:06b}", i * 29 % 64)).collect();
        let texts: Vec<String> = texts.iter().map(|text| text.replace("01", "#1")).collect();
        let conditions: Vec<Condition> = texts.iter().map(|text| text.parse().unwrap()).collect();
        let table = MaskTable::of(conditions.iter().map(|&condition| (condition, 0)));
        let mut matched = Vec::new();
        for bits in 0..64 {
            table.match_into(bits, &mut matched);
            let expected: Vec<usize> =
                (0..100).filter(|&index: &usize| conditions[index].matches(bits)).collect();
            assert_eq!(matched, expected);
        }
    }

    #[test]
    fn several_rules_are_removed_at_once() {
        let mut items = vec![0, 1, 2, 3, 4, 5];
        remove_all(&mut items, &[0, 3, 5]);
        assert_eq!(items, [1, 2, 4]);
    }

    #[test]
    fn a_rule_is_found_by_condition_and_action() {
        let table = table(&["00#", "###", "00#"]);
        let condition = "00#".parse().unwrap();
        assert_eq!(table.find(&condition, 0), Some(0));
        assert_eq!(table.find(&condition, 2), Some(2));
        assert_eq!(table.find(&condition, 1), None);
    }

    #[test]
    fn indices_follow_a_removal() {
        let mut indices = vec![1, 4, 5, 9];
        forget(&mut indices, 4);
        assert_eq!(indices, [1, 4, 8]);
        forget(&mut indices, 0);
        assert_eq!(indices, [0, 3, 7]);
    }
}
