//! Pages of `docs/` that the program generates.

use std::fs;
use std::path::Path;

use super::program::{folder, stdout_of};

#[test]
fn the_settings_page_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/settings.md");
    let page = fs::read_to_string(path).expect("docs/settings.md");
    let written = stdout_of(folder().path(), "settings --markdown");
    let differs = written.lines().zip(page.lines()).find(|(written, page)| written != page);
    let regenerate = "run `snakes settings --markdown > docs/settings.md`";
    assert_eq!(differs, None, "{regenerate}");
    assert_eq!(written.len(), page.len(), "{regenerate}");
}
