//! Counts how often a snake chose each wave of its library.

use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};
use crate::genome::MOST_LIBRARY_WAVES;

/// For each wave of a library, the number of decisions that chose it. Each decision counts once per half of the joints. Files store it as
/// a list of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "Vec<u32>", try_from = "Vec<u32>")]
pub struct WaveUses {
    waves: usize,
    counts: [u32; MOST_LIBRARY_WAVES],
}

impl WaveUses {
    /// Creates counts of zero for this number of waves, at least one.
    pub fn new(waves: usize) -> Self {
        Self { waves: waves.clamp(1, MOST_LIBRARY_WAVES), counts: [0; MOST_LIBRARY_WAVES] }
    }

    /// Counts a decision for a wave; the first wave is 0.
    pub fn count(&mut self, wave: usize) {
        if let Some(count) = self.counts.get_mut(wave) {
            *count = count.saturating_add(1);
        }
    }

    /// Returns the counts, one for each wave.
    pub fn counts(&self) -> &[u32] {
        self.counts.get(..self.waves).unwrap_or_default()
    }

    /// Returns the index of the wave that was chosen most often, the lowest among equal ones.
    pub fn most_used(&self) -> usize {
        self.first_by(|count, best| count > best)
    }

    /// Returns the index of the wave that was chosen least often, the lowest among equal ones.
    pub fn least_used(&self) -> usize {
        self.first_by(|count, best| count < best)
    }

    fn first_by(&self, is_better: impl Fn(u32, u32) -> bool) -> usize {
        let better = |best: usize, index: usize| {
            if is_better(self.counts[index], self.counts[best]) { index } else { best }
        };
        (1..self.waves).fold(0, better)
    }
}

impl From<WaveUses> for Vec<u32> {
    fn from(uses: WaveUses) -> Self {
        uses.counts().to_vec()
    }
}

impl TryFrom<Vec<u32>> for WaveUses {
    type Error = Invalid;

    fn try_from(counts: Vec<u32>) -> Result<Self, Invalid> {
        within("number of wave uses", counts.len(), 1..=MOST_LIBRARY_WAVES)?;
        let mut uses = Self::new(counts.len());
        uses.counts[..counts.len()].copy_from_slice(&counts);
        Ok(uses)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uses(counts: &[u32]) -> WaveUses {
        counts.to_vec().try_into().expect("allowed")
    }

    #[test]
    fn of_equally_used_waves_the_lowest_counts() {
        for (counts, most, least) in [
            (vec![3, 5, 5, 0, 0], 1, 3),
            (vec![2, 2, 2], 0, 0),
            (vec![7], 0, 0),
            (vec![0, 1, 2, 3, 4, 5, 6, 7], 7, 0),
        ] {
            let uses = uses(&counts);
            assert_eq!((uses.most_used(), uses.least_used()), (most, least), "{counts:?}");
        }
    }

    #[test]
    fn uses_are_a_list_in_files_and_one_of_the_wrong_length_is_refused() {
        let mut counted = WaveUses::new(3);
        [2, 0, 2, 9].into_iter().for_each(|wave| counted.count(wave));
        assert_eq!(ron::to_string(&counted).expect("written"), "[1,0,2]");
        assert_eq!(ron::from_str::<WaveUses>("[1,0,2]").expect("read"), counted);
        for text in ["[]", "[1,2,3,4,5,6,7,8,9]", "[-1]", "[4294967296]"] {
            assert!(ron::from_str::<WaveUses>(text).is_err(), "{text}");
        }
    }
}
