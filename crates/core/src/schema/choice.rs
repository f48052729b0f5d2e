//! Settings whose value is one of a list of names.

use crate::check::Invalid;

/// A name that a setting may have as its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// Name in files and flags.
    pub name: &'static str,
    /// Name in panels.
    pub title: &'static str,
    /// Sentence that describes the choice.
    pub sentence: String,
}

impl Choice {
    /// Makes a choice from its name, title and sentence.
    pub fn new(name: &'static str, title: &'static str, sentence: impl Into<String>) -> Self {
        Self { name, title, sentence: sentence.into() }
    }
}

/// A type whose values all have a name, a title and a sentence.
pub trait Choices: Copy + 'static {
    /// All values of the type, in the order of lists.
    const OPTIONS: &'static [Self];

    /// Returns the name, title and sentence of a value.
    fn choice(self) -> Choice;

    /// Returns the names of all values.
    fn names() -> Vec<&'static str> {
        Self::OPTIONS.iter().map(|option| option.choice().name).collect()
    }

    /// Returns the value with the name `text`, in which - and _ mean the same.
    ///
    /// # Errors
    /// Fails if no value has the name; the error calls the value `field`.
    fn named(field: &str, text: &str) -> Result<Self, Invalid> {
        let plain = |name: &str| name.replace('-', "_");
        let named = Self::OPTIONS.iter().find(|option| plain(option.choice().name) == plain(text));
        let unknown = || Invalid::new(field, format!("{text:?}"), Self::names().join(", "));
        named.copied().ok_or_else(unknown)
    }

    /// Returns the name, title and sentence of all values.
    fn choices() -> Vec<Choice> {
        Self::OPTIONS.iter().map(|option| option.choice()).collect()
    }
}
