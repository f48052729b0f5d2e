//! A film as MP4. The frames go through a pipe to ffmpeg, which compresses them as H.264.

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};

use super::film_file::FilmFile;
use crate::export::ExportError;
use crate::run::BackgroundTask;
use snakes_core::check::Invalid;
use snakes_core::save::{Picture, UnfinishedFile};

/// Name of the program that writes the film, which must be in PATH.
const FFMPEG: &str = "ffmpeg";
/// Quality of H.264: 0 is lossless, 23 is the encoder's default. At 16, flat areas and letters show no artefacts.
const QUALITY: &str = "16";

/// A film that ffmpeg is writing. If it is dropped before it is finished, ffmpeg is ended and no file remains.
pub struct Video {
    /// Process that writes the film. It is dropped before the file, so that ffmpeg has stopped writing when the file is removed.
    ffmpeg: RunningFfmpeg,
    file: UnfinishedFile,
    path: PathBuf,
}

/// A running ffmpeg.
struct RunningFfmpeg {
    process: Child,
    frames: Option<BufWriter<ChildStdin>>,
    said: BackgroundTask<String>,
}

impl Drop for RunningFfmpeg {
    fn drop(&mut self) {
        // ffmpeg has ended already, unless the film was cancelled.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

impl Video {
    /// Creates the file and starts ffmpeg.
    ///
    /// # Errors
    /// The size does not suit a video, the file cannot be created, or ffmpeg cannot be started.
    pub fn begin(path: &Path, size: (u32, u32), fps: u32) -> Result<Self, ExportError> {
        check_video_size(size)?;
        let file = UnfinishedFile::create(path)?;
        let ffmpeg =
            RunningFfmpeg::start(file.temporary_path(), size, fps).map_err(|error| match error
                .kind()
            {
                io::ErrorKind::NotFound => ExportError::NoFfmpeg,
                _ => ExportError::Ffmpeg(error),
            })?;
        Ok(Self { ffmpeg, file, path: path.to_owned() })
    }

    /// Returns the reason why ffmpeg has ended early.
    fn failure(&mut self, error: io::Error) -> ExportError {
        let said = self.ffmpeg.last_words().unwrap_or_else(|| match self.ffmpeg.process.wait() {
            Ok(status) => format!("ffmpeg ended early: {status}"),
            Err(_) => error.to_string(),
        });
        ExportError::unwritable(&self.path)(io::Error::other(said))
    }
}

impl FilmFile for Video {
    fn add(&mut self, frame: &Picture) -> Result<(), ExportError> {
        let ended = || io::Error::from(io::ErrorKind::BrokenPipe);
        let frames = self.ffmpeg.frames.as_mut().ok_or_else(ended);
        let written = frames.and_then(|frames| frames.write_all(&frame.rgb));
        written.map_err(|error| self.failure(error))
    }

    fn finish(mut self: Box<Self>) -> Result<(), ExportError> {
        let frames = self.ffmpeg.frames.take();
        let flushed = frames.map_or(Ok(()), |mut frames| frames.flush());
        let ended = flushed.and_then(|()| self.ffmpeg.process.wait());
        let status = ended.map_err(|error| self.failure(error))?;
        // If the disk is full when the last bytes are written, some versions of ffmpeg report an error and yet exit with success.
        let failed = self.ffmpeg.last_words();
        if let Some(reason) = failed.or_else(|| (!status.success()).then(|| status.to_string())) {
            return Err(ExportError::unwritable(&self.path)(io::Error::other(reason)));
        }
        let Self { ffmpeg, file, path } = *self;
        drop(ffmpeg);
        // A film takes the place of an earlier one, so the word of ffmpeg is not enough.
        if file.is_empty() {
            let reason = "ffmpeg reports success, but has written nothing";
            return Err(ExportError::unwritable(&path)(io::Error::other(reason)));
        }
        Ok(file.finish()?)
    }
}

impl RunningFfmpeg {
    fn start(path: &Path, (width, height): (u32, u32), fps: u32) -> io::Result<Self> {
        let mut command = Command::new(FFMPEG);
        command
            .args(["-hide_banner", "-nostdin", "-loglevel", "error"])
            .args(["-f", "rawvideo", "-pixel_format", "rgb24"])
            .args(["-video_size", &format!("{width}x{height}"), "-framerate", &fps.to_string()])
            .args(["-i", "pipe:0", "-an"])
            // The colour space of high definition, stated explicitly so that players do not have to guess it.
            .args([
                "-vf",
                "scale=out_color_matrix=bt709:out_range=tv:flags=accurate_rnd,format=yuv420p",
            ])
            .args(["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"])
            .args(["-color_range", "tv"])
            .args(["-c:v", "libx264", "-preset", "medium", "-crf", QUALITY])
            // The film can play before it is completely loaded, and the same frames give the same bytes.
            .args(["-movflags", "+faststart", "-fflags", "+bitexact", "-f", "mp4", "-y"])
            .arg(path)
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        // ffmpeg gets its own process group, so that the interrupt key does not end it before the film is cancelled.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        let mut process = command.spawn()?;
        let gone = || io::Error::from(io::ErrorKind::BrokenPipe);
        let frames = process.stdin.take().ok_or_else(gone)?;
        let errors = process.stderr.take().ok_or_else(gone)?;
        let said = BackgroundTask::start_reading(errors)?;
        let frames = BufWriter::with_capacity(1 << 20, frames);
        Ok(Self { process, frames: Some(frames), said })
    }

    /// Waits for the end of ffmpeg. Returns the first line of its error messages, if any.
    fn last_words(&mut self) -> Option<String> {
        self.frames = None;
        let _ = self.process.wait();
        let said = self.said.wait().ok()?;
        let lines = || said.lines().map(str::trim).filter(|line| !line.is_empty());
        let known = "No space left on device";
        let line = if said.contains(known) { Some(known) } else { lines().next() };
        line.map(|line| format!("ffmpeg says: {line}"))
    }
}

/// Checks that the size in pixels suits H.264, in which each block of 2 by 2 pixels shares a colour.
///
/// # Errors
/// The width or the height is odd.
pub fn check_video_size((width, height): (u32, u32)) -> Result<(), Invalid> {
    let is_even = width.is_multiple_of(2) && height.is_multiple_of(2);
    let allowed = "an even width and an even height for a .mp4 film";
    if is_even { Ok(()) } else { Err(Invalid::new("--size", format!("{width}x{height}"), allowed)) }
}
