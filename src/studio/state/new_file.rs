//! Messages about files that were written for the user, with buttons for the next action.

use std::path::Path;

use crate::studio::commands::Command;
use crate::studio::commands::files::FileCommand;
use crate::studio::ui::notifications::Notices;

/// Shows a message about a new file, with buttons that open its folder and copy its path.
pub(crate) fn offer_path(notices: &mut Notices, subject: &'static str, text: String, path: &Path) {
    let copy = Command::File(FileCommand::CopyPath(path.to_owned()));
    notices.offer(subject, text, [("Open folder", open_folder(path)), ("Copy path", copy)]);
}

/// Shows a message about a new picture, with buttons that open its folder and copy the picture.
pub(crate) fn offer_picture(notices: &mut Notices, text: String, path: &Path) {
    let copy = Command::File(FileCommand::CopyPicture(path.to_owned()));
    notices.offer("picture", text, [("Open folder", open_folder(path)), ("Copy", copy)]);
}

fn open_folder(path: &Path) -> Command {
    Command::File(FileCommand::OpenFolder(path.parent().unwrap_or(path).to_owned()))
}
