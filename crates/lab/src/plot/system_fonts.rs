//! Fonts of the system, for characters that the embedded font lacks.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::{Mutex, PoisonError};

use ab_glyph::{Font, FontRef};

use snakes_core::save::read_bytes;

/// A font of the system. It is read once and stays in memory.
pub struct SystemFont {
    /// Path of the font's file, with its index in the file.
    pub name: String,
    /// Content of the file.
    pub bytes: &'static [u8],
    /// Index of the font in the file.
    pub index: u32,
    /// The font as a list of outlines.
    pub(super) outlines: FontRef<'static>,
    tables: harfrust::FontRef<'static>,
    shaping: harfrust::ShaperData,
}

/// Largest file of a font that is read, in MiB. Those with all Chinese characters have about 20.
const LARGEST_FONT_MIB: u64 = 128;
/// Number of characters without a font after which the system is not asked again.
const MOST_MISSES: usize = 50;

/// Files of systems without fontconfig, which name no font for a character: few files that have most scripts.
const KNOWN_FILES: &[&str] = if cfg!(windows) {
    &[
        r"C:\Windows\Fonts\segoeui.ttf",
        r"C:\Windows\Fonts\msyh.ttc",
        r"C:\Windows\Fonts\YuGothM.ttc",
        r"C:\Windows\Fonts\malgun.ttf",
        r"C:\Windows\Fonts\LeelawUI.ttf",
        r"C:\Windows\Fonts\Nirmala.ttf",
        r"C:\Windows\Fonts\Nirmala.ttc",
        r"C:\Windows\Fonts\seguisym.ttf",
    ]
} else if cfg!(target_os = "macos") {
    &[
        "/System/Library/Fonts/Supplemental/Arial Unicode.ttf",
        "/Library/Fonts/Arial Unicode.ttf",
        "/System/Library/Fonts/Apple Symbols.ttf",
    ]
} else {
    &[]
};

/// The fonts that were read, and the answers that were found.
struct Known {
    fonts: Vec<&'static SystemFont>,
    answers: BTreeMap<char, Option<&'static SystemFont>>,
}

static KNOWN: Mutex<Known> = Mutex::new(Known { fonts: Vec::new(), answers: BTreeMap::new() });

/// Returns a font, usually one of the system, that can draw a character, if there is one. On Linux fontconfig's `fc-match` chooses it by the user's
/// settings. The first call for a script takes some hundredths of a second, because it starts that program and reads a file.
pub fn system_font(letter: char) -> Option<&'static SystemFont> {
    let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(answer) = known.answers.get(&letter) {
        return *answer;
    }
    if known.fonts.is_empty() {
        // The second font that is part of the program: pictures in one colour, which few systems have.
        known.keep("emoji".to_owned(), epaint_default_fonts::NOTO_EMOJI_REGULAR, 0);
    }
    let with_letter = |known: &Known| known.fonts.iter().find(|font| font.has(letter)).copied();
    let mut answer = with_letter(&known);
    let misses = known.answers.values().filter(|answer| answer.is_none()).count();
    if answer.is_none() && misses < MOST_MISSES {
        for (path, index) in places_of(letter) {
            known.read(&path, index);
            answer = with_letter(&known);
            if answer.is_some() {
                break;
            }
        }
    }
    known.answers.insert(letter, answer);
    answer
}

impl Known {
    /// Reads a font, unless it is known, missing or damaged.
    fn read(&mut self, path: &Path, index: u32) {
        let name = format!("{} {index}", path.display());
        if self.fonts.iter().any(|font| font.name == name) {
            return;
        }
        if let Ok(bytes) = read_bytes(path, LARGEST_FONT_MIB) {
            self.keep(name, bytes.leak(), index);
        }
    }

    fn keep(&mut self, name: String, bytes: &'static [u8], index: u32) {
        if let Some(font) = SystemFont::of_bytes(name, bytes, index) {
            self.fonts.push(Box::leak(Box::new(font)));
        }
    }
}

/// Returns files, each with an index, in which there may be a font for a character, the best first.
fn places_of(letter: char) -> Vec<(PathBuf, u32)> {
    let pattern = format!("sans-serif:outline=true:color=false:charset={:x}", u32::from(letter));
    let asked = Command::new("fc-match")
        .args(["--format", "%{file}\n%{index}\n", &pattern])
        .stdin(Stdio::null())
        .stderr(Stdio::null())
        .output();
    let text = asked.map(|output| String::from_utf8(output.stdout).unwrap_or_default());
    let text = text.unwrap_or_default();
    let mut lines = text.lines();
    let best = lines.next().zip(lines.next().and_then(|index| index.parse().ok()));
    let best = best.map(|(file, index)| (PathBuf::from(file), index));
    best.into_iter().chain(KNOWN_FILES.iter().map(|file| (PathBuf::from(file), 0))).collect()
}

impl SystemFont {
    /// Returns the font in these bytes; `None` if they are damaged. Both readers of fonts have to understand it.
    pub fn of_bytes(name: String, bytes: &'static [u8], index: u32) -> Option<Self> {
        let tables = harfrust::FontRef::from_index(bytes, index).ok()?;
        let outlines = FontRef::try_from_slice_and_index(bytes, index).ok()?;
        let shaping = harfrust::ShaperData::new(&tables);
        Some(Self { name, bytes, index, outlines, tables, shaping })
    }

    /// Returns the glyphs of a text in one script, from left to right.
    pub(super) fn shape(&self, text: &str) -> harfrust::GlyphBuffer {
        let mut buffer = harfrust::UnicodeBuffer::new();
        buffer.push_str(text);
        buffer.guess_segment_properties();
        let shaper = self.shaping.shaper(&self.tables).build();
        shaper.shape(buffer, harfrust::ShapeOptions::new())
    }

    /// Returns whether the font can draw a character. A font of coloured pictures has characters without an outline.
    pub(super) fn has(&self, letter: char) -> bool {
        let glyph = self.outlines.glyph_id(letter);
        glyph.0 != 0 && (letter.is_whitespace() || self.outlines.outline(glyph).is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f11_a_font_that_is_damaged_or_lacks_a_character_is_not_taken() {
        let embedded = epaint_default_fonts::UBUNTU_LIGHT;
        let font = SystemFont::of_bytes("Ubuntu".to_owned(), embedded, 0).expect("a font");
        assert!(font.has('a') && font.has('Ж') && !font.has('中') && !font.has('א'));
        assert!(SystemFont::of_bytes("short".to_owned(), &embedded[..40], 0).is_none());
        assert!(SystemFont::of_bytes("no second".to_owned(), embedded, 1).is_none());
        // A noncharacter is in no font.
        assert!(system_font('\u{fffff}').is_none());
    }
}
