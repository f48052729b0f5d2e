//! Parts of the snake and the stairs for which a setting may have separate values.

/// The kind and number of parts for which a setting may have separate values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parts {
    /// No parts: the setting has a single value.
    One,
    /// One value for each limb of the snake; the number of limbs.
    Limbs(usize),
    /// One value for each joint of the snake; the number of joints.
    Joints(usize),
    /// One value for each step of the stairs; the number of steps.
    Steps(usize),
}

impl Parts {
    /// Returns the number of parts; 1 for a single value.
    pub fn count(self) -> usize {
        match self {
            Self::One => 1,
            Self::Limbs(count) | Self::Joints(count) | Self::Steps(count) => count,
        }
    }

    /// Returns the word for one part.
    pub fn word(self) -> &'static str {
        match self {
            Self::One => "value",
            Self::Limbs(_) => "block",
            Self::Joints(_) => "joint",
            Self::Steps(_) => "step",
        }
    }

    /// Returns the title of the part with an index from 0, such as "Block 1, the head"; empty for a single value.
    pub fn name(self, index: usize) -> String {
        let (word, first) = match self {
            Self::One => return String::new(),
            Self::Limbs(_) => ("Block", ", the head"),
            Self::Joints(_) => ("Joint", ""),
            Self::Steps(_) => ("Step", ", the lowest"),
        };
        format!("{word} {}{}", index + 1, if index == 0 { first } else { "" })
    }
}
