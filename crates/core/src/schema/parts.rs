//! Parts of the snake and the stairs that may have a value each.

/// The parts of the snake or the stairs that may have a value each, and their number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parts {
    /// No parts: there is one value.
    One,
    /// The limbs.
    Limbs(usize),
    /// The joints.
    Joints(usize),
    /// The steps of the stairs.
    Steps(usize),
}

impl Parts {
    /// The number of parts.
    pub fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Limbs(count) | Self::Joints(count) | Self::Steps(count) => count,
        }
    }

    /// One of them, in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::One => "value",
            Self::Limbs(_) => "limb",
            Self::Joints(_) => "joint",
            Self::Steps(_) => "step",
        }
    }

    /// The name of one of them; the first index is 0.
    pub fn name(self, index: usize) -> String {
        let (word, first) = match self {
            Self::One => return String::new(),
            Self::Limbs(_) => ("Limb", ", the head"),
            Self::Joints(_) => ("Joint", ""),
            Self::Steps(_) => ("Step", ", the lowest"),
        };
        format!("{word} {}{}", index + 1, if index == 0 { first } else { "" })
    }
}
