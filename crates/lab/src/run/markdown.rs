//! Tables in Markdown.

use snakes_core::check::printable;

/// Formats rows of cells as a Markdown table, the first row as its head. The first `left` columns are aligned to the left, the
/// others to the right. All cells of a column are padded to the same width, so that the source text is readable. A name in a cell can
/// neither end the cell nor the row.
pub fn markdown_table(rows: impl IntoIterator<Item = Vec<String>>, left: usize) -> String {
    let in_cell = |text: &String| printable(text).replace('\\', "\\\\").replace('|', "\\|");
    let in_cells = |row: Vec<String>| row.iter().map(in_cell).collect();
    let rows: Vec<Vec<String>> = rows.into_iter().map(in_cells).collect();
    let Some((head, body)) = rows.split_first() else { return String::new() };
    let width = |column: usize| {
        let widths = rows.iter().filter_map(|row| Some(row.get(column)?.chars().count()));
        widths.max().unwrap_or(0)
    };
    let line = |row: &Vec<String>| {
        let cells = row.iter().enumerate().map(|(column, cell)| {
            let width = width(column);
            if column < left { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        format!("| {} |\n", cells.collect::<Vec<_>>().join(" | "))
    };
    let rule: Vec<String> = (0..head.len())
        .map(|column| {
            let dashes = "-".repeat(width(column) + 1);
            if column < left { format!(":{dashes}") } else { format!("{dashes}:") }
        })
        .collect();
    let mut text = line(head);
    text += &format!("|{}|\n", rule.join("|"));
    body.iter().for_each(|row| text += &line(row));
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f9_a_name_with_a_bar_or_a_line_break_stays_in_its_cell() {
        let row = |name: &str| vec![name.to_owned(), "1".to_owned()];
        let rows = ["champion", "a|b", "a\\|b", "a\nb", "\u{1b}[31mred"].map(row);
        let expected = "\
| champion       | 1 |
|:---------------|--:|
| a\\|b           | 1 |
| a\\\\\\|b         | 1 |
| a b            | 1 |
| \\\\u001b[31mred | 1 |
";
        assert_eq!(markdown_table(rows, 1), expected);
    }
}
