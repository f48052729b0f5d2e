//! Worksheets as pages that a browser prints on one sheet of A4.

/// Beginning of the page: its style, and the switch for the teacher's part, which is hidden at first and printed on a sheet of its own.
const HEAD: &str = "<meta charset=\"utf-8\">
<meta name=\"viewport\" content=\"width=device-width\">
<style>
@page { size: A4; margin: 16mm 18mm; }
body { font: 11pt/1.35 system-ui, sans-serif; max-width: 174mm; margin: 8mm auto; padding: 0 4mm; color: #111; }
h1 { font-size: 17pt; margin: 0 0 4mm; } h2 { font-size: 12.5pt; margin: 4mm 0 1.5mm; }
p { margin: 0 0 1.5mm; } .item { padding-left: 5mm; text-indent: -5mm; }
.write { display: flex; gap: 2mm; margin: 3mm 0; } .line { border-bottom: 0.3mm solid #555; height: 5mm; }
table { border-collapse: collapse; margin: 2mm 0; min-width: 60%; }
th, td { border: 0.3mm solid #888; padding: 1.2mm 2.5mm; text-align: left; min-width: 24mm; }
label { display: block; margin-top: 8mm; } .teacher { display: none; border-top: 0.3mm solid #888; padding-top: 3mm; }
body:has(input:checked) .teacher { display: block; }
@media print { body { margin: 0; padding: 0; } label { display: none; } .teacher { break-before: page; border: 0; } }
</style>
";

/// Converts a worksheet from the part of Markdown that worksheets use to a page in HTML.
pub fn worksheet_page(worksheet: &str) -> String {
    let text = worksheet.replace('&', "&amp;").replace('<', "&lt;");
    let title = text.lines().next().unwrap_or_default().trim_start_matches("# ");
    let blocks: String = text.split("\n\n").map(block).collect();
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<title>{title}</title>\n{HEAD}<body>\n{blocks}</div>\n</body>\n</html>\n"
    )
}

/// Converts a block between two blank lines.
fn block(block: &str) -> String {
    let block = block.trim();
    if let Some(heading) = block.strip_prefix("## ") {
        return format!("<h2>{heading}</h2>\n");
    }
    if let Some(heading) = block.strip_prefix("# ") {
        return format!("<h1>{heading}</h1>\n");
    }
    match block {
        "---" => "<label><input type=\"checkbox\"> Show and print the teacher's part</label>\n\
                  <div class=\"teacher\">\n"
            .to_owned(),
        table if table.starts_with('|') => {
            let rows = table.lines().filter(|line| !line.starts_with("| ---"));
            let rows: String = rows.enumerate().map(|(number, line)| row(number, line)).collect();
            format!("<table>\n{rows}</table>\n")
        }
        lines => lines.lines().map(paragraph).collect(),
    }
}

/// Converts a row of a table; row 0 is the head.
fn row(number: usize, line: &str) -> String {
    let tag = if number == 0 { "th" } else { "td" };
    let cells = line.trim_matches('|').split('|');
    let cells: String = cells.map(|cell| format!("<{tag}>{}</{tag}>", cell.trim())).collect();
    format!("<tr>{cells}</tr>\n")
}

/// Converts a line of text: an item of a list, a line to write on, or a paragraph with words in bold.
fn paragraph(line: &str) -> String {
    if line.contains("____") {
        let mut parts = String::new();
        for word in line.split_whitespace() {
            parts += &match word.starts_with('_') {
                true => format!("<span class=\"line\" style=\"flex: {}\"></span>", word.len()),
                false => format!("<span>{word}</span>"),
            };
        }
        return format!("<p class=\"write\">{parts}</p>\n");
    }
    let parts = line.split("**").enumerate();
    let parts: String = parts
        .map(|(number, part)| match number % 2 {
            0 => part.to_owned(),
            _ => format!("<b>{part}</b>"),
        })
        .collect();
    let is_numbered =
        line.split_once(". ").is_some_and(|(number, _)| number.parse::<u32>().is_ok());
    match parts.strip_prefix("- ") {
        Some(item) => format!("<p class=\"item\">•&ensp;{item}</p>\n"),
        None if is_numbered => format!("<p class=\"item\">{parts}</p>\n"),
        None => format!("<p>{parts}</p>\n"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blocks_become_headings_items_lines_and_tables() {
        for (text, html) in [
            ("## Predict", "<h2>Predict</h2>\n"),
            ("1. Begin", "<p class=\"item\">1. Begin</p>\n"),
            ("- a **b** c", "<p class=\"item\">•&ensp;a <b>b</b> c</p>\n"),
            (
                "Because: ________",
                "<p class=\"write\"><span>Because:</span><span class=\"line\" style=\"flex: 8\"></span></p>\n",
            ),
            (
                "| Run | Hash |\n| --- | --- |\n| a |   |\n",
                "<table>\n<tr><th>Run</th><th>Hash</th></tr>\n<tr><td>a</td><td></td></tr>\n</table>\n",
            ),
        ] {
            assert_eq!(block(text), html);
        }
    }
}
