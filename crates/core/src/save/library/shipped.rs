//! Champions that are part of the program.

/// Pairs the names of champions with the texts of their files.
macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!("../../../../../saves/", $name, ".ron")))),*]
    };
}

/// Names and file texts of the champions that are part of the program.
pub const SHIPPED: &[(&str, &str)] = shipped![
    "by-heart",
    "climber",
    "crawler",
    "fast",
    "feeler",
    "first-climber",
    "floppy",
    "foam",
    "four",
    "generalist",
    "learner",
    "paddler",
    "rearer",
    "reflexes",
    "rigid",
    "robust",
    "six",
    "sponge",
    "strong",
    "tapered",
    "thrifty",
    "twister"
];

/// Returns the file text of a champion that is part of the program. None if no such champion has the name.
pub fn shipped_text(name: &str) -> Option<&'static str> {
    SHIPPED.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
