//! Markup for the parts of a page that are readable without scripts.

use super::data::PageChampion;
use crate::export::source::ExportSource;

/// Escapes every character with a meaning in markup, and replaces control characters by spaces.
pub fn escaped(text: &str) -> String {
    let mut result = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => result += "&amp;",
            '<' => result += "&lt;",
            '>' => result += "&gt;",
            '"' => result += "&quot;",
            '\'' => result += "&#39;",
            _ if letter.is_control() => result.push(' '),
            _ => result.push(letter),
        }
    }
    result
}

/// Returns tables of facts: of each champion, folded if several race, or of the last champion of a run.
pub fn facts(source: &ExportSource, champions: &[PageChampion]) -> String {
    let table = |champion: &PageChampion| {
        let row = |(label, text): &(&str, String)| {
            format!(
                "<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n",
                escaped(label),
                escaped(text)
            )
        };
        let rows: String = champion.facts.iter().map(row).collect();
        format!("<table>\n{rows}</table>")
    };
    let heading = |champion: &PageChampion| format!("About {}", escaped(&champion.name));
    match champions {
        [.., last] if source.run.is_some() || champions.len() == 1 => {
            format!("<section id=\"facts\"><h2>{}</h2>\n{}</section>\n", heading(last), table(last))
        }
        all => {
            let folded = |champion| {
                let (heading, table) = (heading(champion), table(champion));
                format!("<details><summary>{heading}</summary>\n{table}</details>\n")
            };
            let folded: String = all.iter().map(folded).collect();
            format!("<section><h2>The champions</h2>\n{folded}</section>\n")
        }
    }
}
