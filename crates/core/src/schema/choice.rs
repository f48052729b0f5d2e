//! Settings that are one of some names.

use crate::check::Invalid;

/// One of the names that a setting may have.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The name in files and flags.
    pub name: &'static str,
    /// The name in panels.
    pub title: &'static str,
    /// A sentence about it.
    pub sentence: String,
}

impl Choice {
    /// A choice with its sentence.
    pub fn new(name: &'static str, title: &'static str, sentence: impl Into<String>) -> Self {
        Self { name, title, sentence: sentence.into() }
    }
}

/// A type whose values all have names.
pub trait Choices: Copy + 'static {
    /// Its values, in the order of lists.
    const OPTIONS: &'static [Self];

    /// The name of a value, its title and its sentence.
    fn choice(self) -> Choice;

    /// All names.
    fn names() -> Vec<&'static str> {
        Self::OPTIONS.iter().map(|option| option.choice().name).collect()
    }

    /// The value with this name; - and _ are the same in it.
    ///
    /// # Errors
    /// There is none; `field` is what the error calls the value.
    fn named(field: &str, text: &str) -> Result<Self, Invalid> {
        let plain = |name: &str| name.replace('-', "_");
        let named = Self::OPTIONS.iter().find(|option| plain(option.choice().name) == plain(text));
        let unknown = || Invalid::new(field, format!("{text:?}"), Self::names().join(", "));
        named.copied().ok_or_else(unknown)
    }

    /// All names with their titles and sentences.
    fn choices() -> Vec<Choice> {
        Self::OPTIONS.iter().map(|option| option.choice()).collect()
    }
}
