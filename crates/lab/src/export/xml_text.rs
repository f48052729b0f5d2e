//! XML, written element by element. The library escapes attributes.

use std::borrow::Cow;
use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, BytesEnd, BytesStart, BytesText, Event};

/// An XML document in memory.
pub(super) struct XmlText(Writer<Vec<u8>>);

/// Attributes of an element, in their order.
pub(super) type Attributes<'a> = &'a [(&'a str, String)];

impl XmlText {
    /// Makes a document: its declaration, then what `write` adds.
    ///
    /// # Errors
    /// The XML library failed.
    pub fn document(write: impl FnOnce(&mut Self) -> io::Result<()>) -> io::Result<String> {
        let mut text = Self(Writer::new_with_indent(Vec::new(), b' ', 2));
        text.0.write_event(Event::Decl(BytesDecl::new("1.0", Some("utf-8"), None)))?;
        write(&mut text)?;
        let mut bytes = text.0.into_inner();
        bytes.push(b'\n');
        String::from_utf8(bytes).map_err(io::Error::other)
    }

    /// Adds an element without content.
    pub fn leaf(&mut self, name: &str, attributes: Attributes<'_>) -> io::Result<()> {
        let element = self.0.create_element(name).with_attributes(pairs(attributes));
        element.write_empty().map(drop)
    }

    /// Adds an element whose content `inside` adds.
    pub fn element(
        &mut self,
        name: &str,
        attributes: Attributes<'_>,
        inside: impl FnOnce(&mut Self) -> io::Result<()>,
    ) -> io::Result<()> {
        self.open(name, attributes)?;
        inside(self)?;
        self.close(name)
    }

    /// Begins an element that [`Self::close`] ends, for nesting to a depth that varies.
    pub fn open(&mut self, name: &str, attributes: Attributes<'_>) -> io::Result<()> {
        let element = BytesStart::new(name).with_attributes(pairs(attributes));
        self.0.write_event(Event::Start(element))
    }

    /// Ends an element.
    pub fn close(&mut self, name: &str) -> io::Result<()> {
        self.0.write_event(Event::End(BytesEnd::new(name)))
    }

    /// Adds elements that are equal in every document, as XML that is already indented.
    pub fn fixed(&mut self, elements: &str) {
        self.0.get_mut().extend(elements.trim_end().bytes());
    }

    /// Adds a comment. XML comments have no escapes, and two hyphens are not allowed in them.
    pub fn comment(&mut self, text: &str) -> io::Result<()> {
        let text = format!(" {} ", printable(text).replace("--", "-\u{2010}"));
        self.0.write_event(Event::Comment(BytesText::from_escaped(text)))
    }
}

fn pairs<'a>(attributes: Attributes<'a>) -> impl Iterator<Item = (&'a str, Cow<'a, str>)> + 'a {
    attributes.iter().map(|(name, value)| (*name, printable(value)))
}

/// Replaces characters that XML does not allow, such as control characters, by question marks.
fn printable(text: &str) -> Cow<'_, str> {
    let is_allowed =
        |character: char| !character.is_control() && !matches!(character, '\u{fffe}' | '\u{ffff}');
    if text.chars().all(is_allowed) {
        Cow::Borrowed(text)
    } else {
        let kept =
            text.chars().map(|character| if is_allowed(character) { character } else { '?' });
        Cow::Owned(kept.collect())
    }
}

/// Joins numbers with spaces. Each has the fewest digits that give its bits back.
pub(super) fn spaced<N: ToString>(numbers: impl IntoIterator<Item = N>) -> String {
    let texts: Vec<String> = numbers.into_iter().map(|number| number.to_string()).collect();
    texts.join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_escaped_and_comments_cannot_end_early() {
        let name = "a\"b<c>&'\u{1}--><d/>";
        let text = XmlText::document(|xml| {
            xml.comment(name)?;
            xml.element("e", &[("name", name.to_owned())], |xml| xml.leaf("f", &[]))
        });
        let text = text.expect("in memory");
        assert_eq!(text.matches("-->").count(), 1, "{text}");
        assert!(text.contains("name=\"a&quot;b&lt;c&gt;&amp;&apos;?--&gt;&lt;d/&gt;\""), "{text}");
        assert!(
            text.ends_with(
                "<e name=\"a&quot;b&lt;c&gt;&amp;&apos;?--&gt;&lt;d/&gt;\">\n  <f/>\n</e>\n"
            ),
            "{text}"
        );
    }

    #[test]
    fn negative_numbers_in_comments_are_numbers() {
        let text = XmlText::document(|xml| {
            xml.comment("at -3.23 m, ---")?;
            xml.leaf("e", &[])
        });
        assert!(text.expect("in memory").contains("<!-- at -3.23 m, -\u{2010}- -->"));
    }

    #[test]
    fn numbers_give_their_bits_back() {
        assert_eq!(spaced([0.1_f32, -2.0, 1.0 / 3.0]), "0.1 -2 0.33333334");
    }
}
