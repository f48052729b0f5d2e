//! File dialogs of the operating system, and its programs that open folders and pages.

use std::io;
use std::path::{Path, PathBuf};
use std::pin::Pin;
use std::time::Duration;

use bevy::tasks::block_on;
use rfd::{AsyncFileDialog, FileHandle};

use super::portal;
use crate::studio::commands::files::FileQuestion;
use snakes_lab::run::BackgroundTask;

/// Paths that the user chose in a dialog, none if it was cancelled, or the reason why there is no dialog.
pub type DialogAnswer = Result<Vec<PathBuf>, String>;

/// Time after which a program that is still starting counts as opened.
const OPENED_AFTER: Duration = Duration::from_secs(10);

/// Opens the file dialog for a question. The window keeps running meanwhile. Must be called on the main thread.
///
/// # Errors
/// No thread can be started to wait for the answer.
pub fn ask(question: &FileQuestion) -> io::Result<BackgroundTask<DialogAnswer>> {
    let dialog = AsyncFileDialog::new();
    let champions_or_runs =
        |dialog: AsyncFileDialog| dialog.add_filter("Champions, and run.ron of a run", &["ron"]);
    let answer: Pin<Box<dyn Future<Output = Vec<FileHandle>> + Send>> = match question {
        FileQuestion::Open => {
            let dialog =
                champions_or_runs(dialog).set_title("Open a champion, or run.ron of a run");
            let file = dialog.pick_file();
            Box::pin(async { file.await.into_iter().collect() })
        }
        FileQuestion::Import => {
            let dialog =
                champions_or_runs(dialog).set_title("Import champions, or run.ron of a run");
            let files = dialog.pick_files();
            Box::pin(async { files.await.unwrap_or_default() })
        }
        FileQuestion::Share(format, name, _) => {
            let info = format.info();
            let named = dialog
                .set_title(format!("{} of {name}", info.title))
                .set_file_name(format!("{name}.{}", info.ending));
            let file = named.add_filter(info.title, &[info.ending]).save_file();
            Box::pin(async { file.await.into_iter().collect() })
        }
        FileQuestion::Export(_) => {
            let folder = dialog.set_title("Export to a folder").pick_folder();
            Box::pin(async { folder.await.into_iter().collect() })
        }
    };
    BackgroundTask::start(move || {
        portal::check()?;
        let chosen = block_on(answer);
        Ok(chosen.iter().map(|file| file.path().to_owned()).collect())
    })
}

/// Opens a folder in the operating system's file manager, or a page in its browser.
///
/// # Errors
/// The path does not exist, or no program can open it.
pub fn open(path: &Path) -> Result<(), String> {
    let why = |error: io::Error| format!("{}: cannot be opened: {error}", path.display());
    if !path.exists() {
        return Err(why(io::ErrorKind::NotFound.into()));
    }
    open::that_detached_with_timeout(path, OPENED_AFTER).map_err(why)
}
