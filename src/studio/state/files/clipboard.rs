//! Copies pictures and paths to the clipboard, on a separate thread, because the desktop can be slow.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use arboard::{Clipboard, ImageData};
use bevy::platform::cell::SyncCell;

use snakes_core::save::{Picture, load_picture};
use snakes_lab::run::BackgroundTask;

/// Content to copy to the clipboard.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Copied {
    /// The picture that this file contains.
    Picture(PathBuf),
    /// This path itself, as text.
    Path(PathBuf),
}

/// The clipboard, which must be kept: on X11 the copied content is lost when the clipboard is dropped.
type KeptClipboard = SyncCell<Option<Clipboard>>;

/// The clipboard, and whether copying succeeded.
type CopyResult = (KeptClipboard, Result<(), String>);

/// Copies to the clipboard in the background, one content at a time.
#[derive(Default)]
pub struct CopyTask {
    kept: Option<KeptClipboard>,
    running: Option<(Copied, BackgroundTask<CopyResult>)>,
}

impl CopyTask {
    /// Starts to copy a content.
    ///
    /// # Errors
    /// Another content is still being copied, or no thread can be started.
    pub fn start(&mut self, copied: Copied) -> Result<(), String> {
        if self.running.is_some() {
            return Err("The clipboard is still busy with the last copy.".to_owned());
        }
        let (kept, of) = (self.kept.take(), copied.clone());
        let task = BackgroundTask::start(move || {
            let mut clipboard = kept.and_then(SyncCell::to_inner);
            let result = copy(&mut clipboard, &of);
            (SyncCell::new(clipboard), result)
        });
        let task = task.map_err(|error| format!("The clipboard cannot be used: {error}"))?;
        self.running = Some((copied, task));
        Ok(())
    }

    /// Returns the copied content and the result when copying has finished.
    pub fn poll(&mut self) -> Option<(Copied, Result<(), String>)> {
        let result = self.running.as_ref()?.1.poll()?;
        let (copied, _) = self.running.take()?;
        let result = result.and_then(|(kept, result)| {
            self.kept = Some(kept);
            result
        });
        Some((copied, result))
    }
}

fn copy(clipboard: &mut Option<Clipboard>, copied: &Copied) -> Result<(), String> {
    let clipboard = match clipboard {
        Some(clipboard) => clipboard,
        None => clipboard.insert(Clipboard::new().map_err(|error| error.to_string())?),
    };
    match copied {
        Copied::Picture(path) => clipboard.set_image(rgba(path)?),
        Copied::Path(path) => clipboard.set_text(path.to_string_lossy()),
    }
    .map_err(|error| error.to_string())
}

/// Reads the picture in a file, and adds an opaque alpha channel.
fn rgba(path: &Path) -> Result<ImageData<'static>, String> {
    let Picture { width, height, rgb } = load_picture(path)?;
    let opaque = |&[red, green, blue]: &[u8; 3]| [red, green, blue, u8::MAX];
    let bytes: Vec<u8> = rgb.as_chunks::<3>().0.iter().flat_map(opaque).collect();
    Ok(ImageData { width: width as usize, height: height as usize, bytes: Cow::Owned(bytes) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::save::store_picture;

    #[test]
    fn a_picture_is_copied_with_its_colours_and_opaque() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("picture.png");
        let picture = Picture { width: 2, height: 1, rgb: vec![1, 2, 3, 40, 50, 60] };
        store_picture(&path, &picture).expect("written");
        let copied = rgba(&path).expect("read");
        assert_eq!((copied.width, copied.height), (2, 1));
        assert_eq!(*copied.bytes, [1, 2, 3, 255, 40, 50, 60, 255]);
        let missing = rgba(&folder.path().join("gone.png")).expect_err("not there");
        assert!(missing.contains("gone.png: cannot be read"), "{missing}");
    }
}
