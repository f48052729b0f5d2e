//! Pages of `docs/` that the program generates.

use std::fs;
use std::path::Path;

use super::program::{folder, stdout_of};

#[test]
fn the_settings_page_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/settings.md");
    let page = fs::read_to_string(path).expect("docs/settings.md");
    let written = stdout_of(folder().path(), "show settings --markdown");
    let differs = written.lines().zip(page.lines()).find(|(written, page)| written != page);
    let regenerate = "run `snakes show settings --markdown > docs/settings.md`";
    assert_eq!(differs, None, "{regenerate}");
    assert_eq!(written.len(), page.len(), "{regenerate}");
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn the_citation_names_the_version_of_the_program() {
    let citation = fs::read_to_string(root().join("CITATION.cff")).expect("CITATION.cff");
    let version = format!("\nversion: {}\n", env!("CARGO_PKG_VERSION"));
    assert!(citation.contains(&version), "CITATION.cff does not have the line {version:?}");
}

#[test]
fn the_page_of_studies_lists_every_value() {
    let page = fs::read_to_string(root().join("docs/studies.md")).expect("a page");
    let (_, listed) = page.split_once("## Values\n\n").expect("a section");
    let regenerate = "the section Values is what `snakes study --markdown` prints";
    assert_eq!(listed, snakes_lab::study::values_as_markdown(), "{regenerate}");
}

/// Returns the names of functions in the walks of the architecture page, such as `set_field`.
fn functions_named(page: &str) -> Vec<&str> {
    let walks = page.split("\n## From ").skip(1);
    let sections = walks.map(|walk| walk.split("\n## ").next().unwrap_or_default());
    let quoted = sections.flat_map(|section| section.split('`').skip(1).step_by(2));
    let is_function = |name: &&str| name.chars().all(|c| c.is_ascii_lowercase() || c == '_');
    quoted.filter(is_function).collect()
}

#[test]
fn the_walks_through_the_architecture_name_functions_that_exist() {
    fn texts(folder: &Path, all: &mut String) {
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            match path.is_dir() {
                true => texts(&path, all),
                false => *all += &fs::read_to_string(&path).unwrap_or_default(),
            }
        }
    }
    let page = fs::read_to_string(root().join("docs/architecture.md")).expect("a page");
    let mut source = String::new();
    ["crates", "src"].iter().for_each(|folder| texts(&root().join(folder), &mut source));
    let named = functions_named(&page);
    assert!(named.len() > 10, "{named:?}");
    for name in named {
        assert!(
            source.contains(&format!("fn {name}(")) || source.contains(&format!("fn {name}<")),
            "{name}"
        );
    }
}

#[test]
fn every_link_between_documents_leads_to_a_file() {
    let docs =
        fs::read_dir(root().join("docs")).expect("docs").map(|entry| entry.expect("a page").path());
    let pages = docs.filter(|path| path.extension().is_some_and(|extension| extension == "md"));
    let others = ["README.md", "CONTRIBUTING.md", "python/README.md"].map(|name| root().join(name));
    for page in pages.chain(others) {
        let text = fs::read_to_string(&page).expect("a page");
        let links = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        for link in
            links.filter(|link| !link.contains("://") && !link.contains(char::is_whitespace))
        {
            let (file, _) = link.split_once('#').unwrap_or((link, ""));
            let target = page.parent().expect("a folder").join(file);
            assert!(file.is_empty() || target.exists(), "{} links to {link}", page.display());
        }
    }
}
