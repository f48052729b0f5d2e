//! A lexer for Rust source, enough to find items and paths: comments, literals and code for tests are skipped.

/// Returns the identifiers, `::` and punctuation of a source text, without items marked `#[cfg(test)]`.
pub fn tokens(text: &str) -> Vec<String> {
    without_tests(lexed(text))
}

fn lexed(text: &str) -> Vec<String> {
    let chars: Vec<char> = text.chars().collect();
    let at = |index: usize| chars.get(index).copied().unwrap_or('\0');
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let mut tokens = Vec::new();
    let mut index = 0;
    while index < chars.len() {
        let start = index;
        match (at(index), at(index + 1)) {
            ('/', '/') => index += chars[index..].iter().take_while(|c| **c != '\n').count(),
            ('/', '*') => {
                index += 2;
                while index < chars.len() && (at(index), at(index + 1)) != ('*', '/') {
                    index += 1;
                }
                index += 2;
            }
            ('r' | 'b' | 'c', '"' | '#' | 'r') if raw_string(&chars[index..]).is_some() => {
                index += raw_string(&chars[index..]).unwrap_or(1);
            }
            ('"', _) => index += quoted(&chars[index..], '"'),
            // This is a character literal, not a lifetime.
            ('\'', second) if second == '\\' || at(index + 2) == '\'' => {
                index += quoted(&chars[index..], '\'');
            }
            (':', ':') => {
                tokens.push("::".to_owned());
                index += 2;
            }
            (c, _) if is_word(c) => {
                index += chars[index..].iter().take_while(|c| is_word(**c)).count();
                tokens.push(chars[start..index].iter().collect());
            }
            (c, _) => {
                if !c.is_whitespace() {
                    tokens.push(c.to_string());
                }
                index += 1;
            }
        }
    }
    tokens
}

/// Returns the length of a quoted literal, including its quotes.
fn quoted(chars: &[char], quote: char) -> usize {
    let mut index = 1;
    while index < chars.len() && chars[index] != quote {
        index += if chars[index] == '\\' { 2 } else { 1 };
    }
    index + 1
}

/// Returns the length of a raw or byte string, or `None` if the text does not begin with one.
fn raw_string(chars: &[char]) -> Option<usize> {
    let prefix = chars.iter().take_while(|c| "rbc".contains(**c)).count();
    let hashes = chars[prefix..].iter().take_while(|c| **c == '#').count();
    if chars.get(prefix + hashes) != Some(&'"') {
        return None;
    }
    if !chars[..prefix].contains(&'r') {
        return (hashes == 0).then(|| prefix + quoted(&chars[prefix..], '"'));
    }
    let body = prefix + hashes + 1;
    let end = (body..chars.len()).find(|&index| {
        let closing = &chars[index + 1..];
        chars[index] == '"' && closing.iter().take(hashes).filter(|c| **c == '#').count() == hashes
    })?;
    Some(end + 1 + hashes)
}

fn without_tests(tokens: Vec<String>) -> Vec<String> {
    const TEST: [&str; 7] = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::new();
    let mut index = 0;
    while index < tokens.len() {
        if tokens[index..].iter().take(TEST.len()).eq(TEST.iter()) {
            index = end_of_item(&tokens, index + TEST.len());
        } else {
            kept.push(tokens[index].clone());
            index += 1;
        }
    }
    kept
}

/// Returns the index after the item, field or statement that begins at `index`.
fn end_of_item(tokens: &[String], mut index: usize) -> usize {
    let mut depth = 0;
    while index < tokens.len() {
        match tokens[index].as_str() {
            "{" | "(" | "[" => depth += 1,
            "}" | ")" | "]" => {
                depth -= 1;
                if depth < 0 {
                    return index;
                }
                if depth == 0 && tokens[index] == "}" {
                    return index + 1;
                }
            }
            ";" | "," if depth == 0 => return index + 1,
            _ => (),
        }
        index += 1;
    }
    index
}

#[test]
fn comments_literals_and_test_items_are_skipped() {
    let text = "use a::b; // c\n/* d */ fn e<'f>() { \"g\\\"\"; 'h'; r#\"i\"#; b\"j\"; }\n\
                #[cfg(test)]\nmod tests { k }\n#[cfg(test)]\nmod l;\nm";
    let expected =
        "use a :: b ; fn e < ' f > ( ) { ; ; ; ; } m".split_whitespace().collect::<Vec<_>>();
    assert_eq!(tokens(text), expected);
}
