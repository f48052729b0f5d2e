//! The worksheet of a lesson as a page to print.

use std::path::PathBuf;

use super::LESSONS;
use snakes_core::save::SavesFolder;
use snakes_lab::export::worksheet_page;

/// Writes the worksheet of a lesson to the folder of exports under a free name. Returns the path of the page.
///
/// # Errors
/// The file cannot be written.
pub(crate) fn write_worksheet(saves: &SavesFolder, lesson: usize) -> Result<PathBuf, String> {
    let name = format!("worksheet-of-lesson-{}", lesson + 1);
    let text = LESSONS.get(lesson).map_or("", |lesson| lesson.worksheet);
    Ok(saves.exports().add_file(&name, "html", worksheet_page(text).as_bytes())?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_worksheet_becomes_a_page_with_all_its_texts_and_closed_tags() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        for (index, lesson) in LESSONS.iter().enumerate() {
            let path = write_worksheet(&saves, index).expect("written");
            let page = std::fs::read_to_string(&path).expect("read");
            for tag in ["html", "body", "h1", "h2", "p", "b", "table", "tr", "th", "td", "div"] {
                let opened = page.matches(&format!("<{tag}>")).count()
                    + page.matches(&format!("<{tag} ")).count();
                assert_eq!(opened, page.matches(&format!("</{tag}>")).count(), "{tag}: {page}");
            }
            let [student, teacher] = page.split("class=\"teacher\"").collect::<Vec<_>>()[..] else {
                panic!("two parts");
            };
            for text in [lesson.title, lesson.question, "Predict", "☐", "Because:", "Explain"] {
                assert!(student.contains(text), "{text}");
            }
            assert!(student.contains("size: A4") && !page.contains("____") && !page.contains("**"));
            let conclusion = lesson.conclusion.replace('&', "&amp;").replace('<', "&lt;");
            assert!(teacher.contains(&conclusion) && !student.contains(&conclusion));
        }
    }
}
