//! `snakes man`: the manual pages.

use std::path::Path;

use super::args;
use super::error::CliError;
use super::output::{print, print_line};
use snakes_core::save::{SavesFolder, store_text};

/// Prints the program's manual page, or writes the pages of all commands into the folder `named`.
pub fn manual(named: Option<&Path>) -> Result<(), CliError> {
    let pages = args::manual();
    let Some(named) = named else {
        return pages.first().map_or(Ok(()), |page| print(&page.text));
    };
    let folder = SavesFolder::find(Some(named));
    folder.prepare()?;
    for page in &pages {
        store_text(&folder.path().join(&page.file), &page.text)?;
    }
    print_line(&format!("saved to {}", folder.path().display()))
}
