//! Texts in all scripts: the characters that the embedded font lacks are drawn with fonts of the system, and letters take the forms that
//! their neighbours demand.

use std::borrow::Cow;
use std::sync::OnceLock;

use ab_glyph::{Font, GlyphId, Point, PxScale};
use plotters::style::FontTransform;
use plotters::style::text_anchor::Pos;
use plotters_backend::{BackendColor, BackendCoord, BackendTextStyle, FontFamily, FontStyle};
use unicode_bidi::{BidiClass, BidiInfo, Level, bidi_class};

use super::system_fonts::{SystemFont, system_font};

/// Returns a text with its characters in the order in which they stand from left to right, except that the letters of each word of
/// Hebrew or Arabic keep their order: whatever shapes such a word turns it round. The text as a whole runs from left to right, and so does
/// what follows a name: in a label with a name and a number, the number stays a number.
pub fn in_visual_order(text: &str) -> Cow<'_, str> {
    let mut visual = String::new();
    let mut rest = text;
    while let Some(start) = rest.find(is_right_to_left) {
        let (before, part) = rest.split_at(start);
        let end = end_of_part(part);
        visual += before;
        let order = BidiInfo::new(&part[..end], Some(Level::rtl()));
        for paragraph in &order.paragraphs {
            let (levels, runs) = order.visual_runs(paragraph, paragraph.range.clone());
            for run in runs {
                let words = &part[run.clone()];
                if levels[run.start].is_rtl() {
                    words_of(words).into_iter().rev().for_each(|word| visual += &word);
                } else {
                    visual += words;
                }
            }
        }
        rest = &part[end..];
    }
    if visual.is_empty() { Cow::Borrowed(text) } else { Cow::Owned(visual + rest) }
}

/// Returns where the part of a text ends that runs from right to left, as its beginning does: behind its last such letter, and behind the
/// brackets that close there.
fn end_of_part(text: &str) -> usize {
    let own = text.find(|letter| bidi_class(letter) == BidiClass::L).unwrap_or(text.len());
    let joins = |letter| is_right_to_left(letter) || bidi_class(letter) == BidiClass::NSM;
    let last = text[..own].rfind(joins).unwrap_or_default();
    let end = last + text[last..].chars().next().map_or(0, char::len_utf8);
    let is_bracket = |letter: char| [')', ']', '}', '»'].contains(&letter);
    text.len() - text[end..].trim_start_matches(is_bracket).len()
}

fn is_right_to_left(letter: char) -> bool {
    // The first such letter of all scripts is a Hebrew one.
    letter >= '\u{590}' && matches!(bidi_class(letter), BidiClass::R | BidiClass::AL)
}

/// The words of a text that runs from right to left, and the single characters between them, with brackets turned round.
fn words_of(text: &str) -> Vec<String> {
    let mut words: Vec<(bool, String)> = Vec::new();
    for letter in text.chars() {
        let class = bidi_class(letter);
        let joins = matches!(class, BidiClass::R | BidiClass::AL | BidiClass::NSM | BidiClass::BN);
        match words.last_mut() {
            Some((true, word)) if joins => word.push(letter),
            _ => words.push((joins, mirrored(letter).to_string())),
        }
    }
    words.into_iter().map(|(_, word)| word).collect()
}

fn mirrored(letter: char) -> char {
    let pairs = [('(', ')'), ('[', ']'), ('{', '}'), ('<', '>'), ('«', '»')];
    let other = |(left, right)| match letter {
        of if of == left => Some(right),
        of if of == right => Some(left),
        _ => None,
    };
    pairs.into_iter().find_map(other).unwrap_or(letter)
}

/// A style of the plotting library whose texts may be in any script. Texts that the embedded font has are drawn as without it.
pub(super) struct InAllScripts<'s, S>(pub &'s S);

impl<S: BackendTextStyle> BackendTextStyle for InAllScripts<'_, S> {
    type FontError = S::FontError;

    fn color(&self) -> BackendColor {
        self.0.color()
    }

    fn size(&self) -> f64 {
        self.0.size()
    }

    fn transform(&self) -> FontTransform {
        self.0.transform()
    }

    fn style(&self) -> FontStyle {
        self.0.style()
    }

    fn anchor(&self) -> Pos {
        self.0.anchor()
    }

    fn family(&self) -> FontFamily<'_> {
        self.0.family()
    }

    fn layout_box(&self, text: &str) -> Result<((i32, i32), (i32, i32)), Self::FontError> {
        let (from, to) = self.0.layout_box(text)?;
        let width = shaped(text, self.size() as f32).map(|line| line.width as i32);
        Ok((from, (width.map_or(to.0, |width| from.0 + width), to.1)))
    }

    fn draw<E, DrawFunc: FnMut(i32, i32, BackendColor) -> Result<(), E>>(
        &self,
        text: &str,
        at: BackendCoord,
        mut draw: DrawFunc,
    ) -> Result<Result<(), E>, Self::FontError> {
        let Some(line) = shaped(text, self.size() as f32) else {
            return self.0.draw(text, at, draw);
        };
        let color = self.color();
        let mut drawn = Ok(());
        for ShapedGlyph { font, glyph, scale, place } in line.glyphs {
            let glyph = glyph.with_scale_and_position(scale, place);
            let Some(outline) = font.outlines.outline_glyph(glyph) else { continue };
            let corner = outline.px_bounds().min;
            outline.draw(|x, y, coverage| {
                let (x, y) = (at.0 + x as i32 + corner.x as i32, at.1 + y as i32 + corner.y as i32);
                let alpha = color.alpha * f64::from(coverage.clamp(0.0, 1.0));
                if drawn.is_ok() {
                    drawn = draw(x, y, BackendColor { alpha, ..color });
                }
            });
        }
        Ok(drawn)
    }
}

/// A line of text as glyphs with places.
struct ShapedLine {
    glyphs: Vec<ShapedGlyph>,
    /// Width, in pixels.
    width: f32,
}

struct ShapedGlyph {
    font: &'static SystemFont,
    glyph: GlyphId,
    scale: PxScale,
    /// Origin from the upper left corner of the text, in pixels.
    place: Point,
}

/// Returns a line whose text is `height` pixels high; `None` if the embedded font has all its characters, or no font has those that it
/// lacks.
fn shaped(text: &str, height: f32) -> Option<ShapedLine> {
    let embedded = embedded()?;
    let is_lacking = |letter: &char| !letter.is_control() && !embedded.has(*letter);
    text.chars().filter(|letter| !letter.is_ascii()).find(is_lacking)?;
    let visual = in_visual_order(text);
    let parts = parts(&visual, embedded);
    if parts.iter().all(|(font, _)| std::ptr::eq(*font, embedded)) {
        return None;
    }
    // All fonts get the size of the embedded one, whose scale is the height from the lowest to the highest character.
    let pixels_per_em = height * units_per_em(embedded) / embedded.outlines.height_unscaled();
    let mut line = ShapedLine { glyphs: Vec::new(), width: 0.0 };
    for (font, part) in parts {
        let shaped = font.shape(part);
        let pixels = pixels_per_em / units_per_em(font);
        let scale = PxScale::from(font.outlines.height_unscaled() * pixels);
        for (info, position) in shaped.glyph_infos().iter().zip(shaped.glyph_positions()) {
            let aside = line.width + position.x_offset as f32 * pixels;
            let place = ab_glyph::point(aside, height / 2.0 - position.y_offset as f32 * pixels);
            let glyph = GlyphId(u16::try_from(info.glyph_id).unwrap_or_default());
            line.glyphs.push(ShapedGlyph { font, glyph, scale, place });
            line.width += position.x_advance as f32 * pixels;
        }
    }
    Some(line)
}

/// Splits a text into parts that one font draws.
fn parts<'t>(text: &'t str, embedded: &'static SystemFont) -> Vec<(&'static SystemFont, &'t str)> {
    let mut starts: Vec<(usize, &'static SystemFont)> = Vec::new();
    for (at, letter) in text.char_indices() {
        let last = starts.last().map(|(_, font)| *font);
        let font = if embedded.has(letter) {
            embedded
        } else {
            let same = last.filter(|font| font.has(letter));
            same.or_else(|| system_font(letter)).or(last).unwrap_or(embedded)
        };
        if !last.is_some_and(|last| std::ptr::eq(last, font)) {
            starts.push((at, font));
        }
    }
    let ends = starts.iter().skip(1).map(|(at, _)| *at).chain([text.len()]);
    starts.iter().zip(ends).map(|((at, font), end)| (*font, &text[*at..end])).collect()
}

fn units_per_em(font: &SystemFont) -> f32 {
    font.outlines.units_per_em().unwrap_or(1000.0)
}

/// The embedded font.
fn embedded() -> Option<&'static SystemFont> {
    static EMBEDDED: OnceLock<Option<SystemFont>> = OnceLock::new();
    let read =
        || SystemFont::of_bytes("embedded".to_owned(), epaint_default_fonts::UBUNTU_LIGHT, 0);
    EMBEDDED.get_or_init(read).as_ref()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{FilmBand, film_band};
    use snakes_core::save::Picture;

    #[test]
    fn f11_words_from_right_to_left_are_put_into_their_visual_order() {
        for (text, expected) in [
            ("climber 3", "climber 3"),
            ("ж 中", "ж 中"),
            ("שלום", "שלום"),
            ("שלום עולם", "עולם שלום"),
            ("نحش 12 سريع", "سريع 12 نحش"),
            ("نحش سريع  -3.7 m", "سريع نحش  -3.7 m"),
            ("1. שלום: 2.0 m", "1. שלום: 2.0 m"),
            ("a שלום עולם b", "a עולם שלום b"),
            ("שלום (עולם)", "(עולם) שלום"),
        ] {
            assert_eq!(in_visual_order(text), expected);
        }
    }

    /// A film's band with a name.
    fn named(name: &str) -> Vec<u8> {
        let mut picture = Picture::new(640, 360);
        let band = FilmBand { name: name.to_owned(), ..FilmBand::default() };
        film_band(&mut picture, &band).expect("drawn");
        picture.rgb
    }

    /// Whether the system lacks a font for a character. The test is skipped then, unless it is required.
    fn lacks_font(letter: char) -> bool {
        let is_missing = system_font(letter).is_none();
        if is_missing {
            let required =
                std::env::var("SNAKES_PEER_TESTS").is_ok_and(|value| value == "required");
            assert!(
                !required,
                "no font has {letter:?}: install fonts-noto-core and fonts-noto-cjk"
            );
            eprintln!("skipped: no font of this system has {letter:?}");
        }
        is_missing
    }

    #[test]
    fn f11_names_of_every_script_are_drawn_and_differ() {
        for [one, other] in [
            ["长蛇", "短梯"],
            ["ثعبان", "سلم"],
            ["נחש", "סולם"],
            ["งูยาว", "บันได"],
            ["साँप", "सीढ़ी"],
            ["ヘビ", "階段"],
            ["뱀", "계단"],
        ] {
            let first = one.chars().next().expect("a letter");
            if lacks_font(first) {
                continue;
            }
            let glyphs = shaped(one, 20.0).expect("shaped").glyphs;
            assert!(glyphs.iter().all(|glyph| glyph.glyph.0 != 0), "{one} has a box");
            assert!(named(one) != named(other), "{one} and {other} look alike");
            assert!(named(one) != named(""), "{one} is invisible");
        }
    }

    #[test]
    fn f11_arabic_letters_join_and_run_from_right_to_left() {
        if lacks_font('ب') {
            return;
        }
        let ids = |text: &str| -> Vec<u16> {
            shaped(text, 20.0).expect("shaped").glyphs.iter().map(|of| of.glyph.0).collect()
        };
        let (alone, three) = (ids("ب"), ids("ببب"));
        assert!(!three.contains(&alone[0]), "the letters keep the form that they have alone");
        // The last letter stands at the left: of a word of two letters, the first glyph is the second letter.
        let (dal, word) = (ids("د"), ids("اد"));
        assert_eq!(word.first(), dal.first());
    }

    #[test]
    fn f11_a_text_of_the_embedded_font_is_drawn_as_before() {
        for text in ["climber", "Größe ß é", "Змея", "Φίδι", "−3.5 m · °"] {
            assert!(shaped(text, 20.0).is_none(), "{text}");
        }
    }
}
