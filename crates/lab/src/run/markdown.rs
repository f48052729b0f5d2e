//! Tables in Markdown.

/// Formats rows of cells as a Markdown table, the first row as its head. The first `left` columns are aligned to the left, the
/// others to the right. All cells of a column are padded to the same width, so that the source text is readable.
pub fn markdown_table(rows: &[Vec<String>], left: usize) -> String {
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
