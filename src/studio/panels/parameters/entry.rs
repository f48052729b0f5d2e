//! What there is to say of a setting: its words, its unit, its range, its kind of control.

/// Settings that belong together, under a title.
#[derive(Debug)]
pub struct Section {
    /// Its title.
    pub title: &'static str,
    /// What it is about, in a sentence.
    pub about: &'static str,
    /// How the full names of its settings begin.
    pub prefix: &'static str,
    /// Its settings, in the order in which they are shown.
    pub entries: &'static [Entry],
}

/// One setting.
#[derive(Debug, Clone, Copy)]
pub struct Entry {
    /// The last part of its name: with the section's prefix it is that of [`crate::evolve::with_field`].
    pub field: &'static str,
    /// What it is called.
    pub label: &'static str,
    /// Its unit; empty if it has none.
    pub unit: &'static str,
    /// What it does to the snake or the search.
    pub hint: &'static str,
    /// How it is shown and changed.
    pub kind: Kind,
}

/// How a setting is shown and changed.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// A number, or one for each part of the snake.
    Number(Range),
    /// Several numbers, of which each snake gets one.
    List(Range),
    /// One of some names.
    Choice(fn() -> Vec<Choice>),
    /// On or off.
    OnOff,
}

/// Which numbers a setting may have.
#[derive(Debug, Clone, Copy)]
pub struct Range {
    /// What may be typed.
    pub allowed: [f32; 2],
    /// What the slider shows; none: there is no slider.
    pub slider: Option<[f32; 2]>,
    /// From this value up the slider goes by ratio; none: it is even.
    pub by_ratio_from: Option<f32>,
    /// Whether only whole numbers are allowed.
    pub is_whole: bool,
    /// How many of them there may be.
    pub parts: Parts,
    /// What it begins with where it is given; none: it always has a value.
    pub begins_with: Option<&'static str>,
}

/// What may have a value of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parts {
    /// Nothing: there is one value.
    One,
    /// Every limb.
    Limbs,
    /// Every joint.
    Joints,
}

/// One of the names that a setting may have.
#[derive(Debug, Clone, PartialEq)]
pub struct Choice {
    /// The name in files.
    pub name: &'static str,
    /// The name for people.
    pub title: &'static str,
    /// What it does, as a sentence.
    pub sentence: String,
}

impl Choice {
    /// A choice with its sentence.
    pub fn new(name: &'static str, title: &'static str, sentence: impl Into<String>) -> Self {
        Self { name, title, sentence: sentence.into() }
    }
}

/// A number without a slider.
pub const fn number(
    field: &'static str,
    label: &'static str,
    unit: &'static str,
    hint: &'static str,
    allowed: [f32; 2],
) -> Entry {
    let range = Range {
        allowed,
        slider: None,
        by_ratio_from: None,
        is_whole: false,
        parts: Parts::One,
        begins_with: None,
    };
    Entry { field, label, unit, hint, kind: Kind::Number(range) }
}

/// A choice among names.
pub const fn choice(
    field: &'static str,
    label: &'static str,
    hint: &'static str,
    choices: fn() -> Vec<Choice>,
) -> Entry {
    Entry { field, label, unit: "", hint, kind: Kind::Choice(choices) }
}

/// A box to tick.
pub const fn on_off(field: &'static str, label: &'static str, hint: &'static str) -> Entry {
    Entry { field, label, unit: "", hint, kind: Kind::OnOff }
}

/// Several numbers, of which each snake gets one.
pub const fn list(
    field: &'static str,
    label: &'static str,
    unit: &'static str,
    hint: &'static str,
    allowed: [f32; 2],
) -> Entry {
    let entry = number(field, label, unit, hint, allowed);
    match entry.kind {
        Kind::Number(range) => Entry { kind: Kind::List(range), ..entry },
        _ => entry,
    }
}

impl Entry {
    const fn with(self, range: Range) -> Self {
        Self { kind: Kind::Number(range), ..self }
    }

    /// With a slider between these ends.
    pub const fn slider(self, least: f32, most: f32) -> Self {
        match self.kind {
            Kind::Number(range) => self.with(Range { slider: Some([least, most]), ..range }),
            _ => self,
        }
    }

    /// With a slider that goes by ratio from this value up.
    pub const fn by_ratio_from(self, value: f32) -> Self {
        match self.kind {
            Kind::Number(range) => self.with(Range { by_ratio_from: Some(value), ..range }),
            _ => self,
        }
    }

    /// Of whole numbers only.
    pub const fn whole(self) -> Self {
        match self.kind {
            Kind::Number(range) => self.with(Range { is_whole: true, ..range }),
            _ => self,
        }
    }

    /// With a value for each part, if a person wants that.
    pub const fn for_each(self, parts: Parts) -> Self {
        match self.kind {
            Kind::Number(range) => self.with(Range { parts, ..range }),
            _ => self,
        }
    }

    /// Without a value unless it is given; it begins with this one.
    pub const fn unless_given(self, begins_with: &'static str) -> Self {
        match self.kind {
            Kind::Number(range) => self.with(Range { begins_with: Some(begins_with), ..range }),
            _ => self,
        }
    }

    /// What it is called, with its unit.
    pub fn title(&self) -> String {
        match self.unit {
            "" => self.label.to_owned(),
            unit => format!("{}, {unit}", self.label),
        }
    }

    /// What may stand in it, in words; nothing where it is a choice.
    pub fn allowed(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        match &self.kind {
            Kind::Number(range) => {
                let [least, most] = range.allowed;
                let whole = if range.is_whole { ", whole numbers" } else { "" };
                format!("{least} to {most}{unit}{whole}")
            }
            Kind::List(range) => {
                let [least, most] = range.allowed;
                format!("numbers from {least} to {most}{unit}, with commas between them")
            }
            Kind::Choice(_) | Kind::OnOff => String::new(),
        }
    }

    /// Whether a word that somebody looks for occurs in what is said of it.
    pub fn is_about(&self, words: &str) -> bool {
        let mut said = format!("{} {} {}", self.title(), self.field.replace('_', " "), self.hint);
        if let Kind::Choice(choices) = &self.kind {
            for choice in choices() {
                said += &format!(" {} {}", choice.title, choice.name.replace('_', " "));
            }
        }
        let said = said.to_lowercase();
        words.to_lowercase().split_whitespace().all(|word| said.contains(word))
    }
}
