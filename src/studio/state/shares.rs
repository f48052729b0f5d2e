//! Writing files of other formats from the champions on the stage, one file at a time.
//!
//! A second process of the same program writes the file. Drawing a film there does not slow the window down, and a crash there does not
//! end the studio. The process ends when its standard input is closed, so it never outlives the studio.

mod writer;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use bevy::prelude::*;

use super::new_file::offer_path;
use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::commands::overlay::Overlay;
use crate::studio::commands::{FilmSize, SMALL_GIF_MB};
use crate::studio::schedule::FrameSet;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::ui::decimals::in_percent;
use crate::studio::ui::notifications::Notices;
use crate::studio::ui::theme::Theme;
use snakes_core::check::printable;
use snakes_core::evolve::Champion;
use snakes_core::score::evaluate;
use snakes_lab::export::ExportFormat;
use snakes_lab::run::BackgroundTask;

use writer::{Leash, written};

/// The file that is being written, if any.
#[derive(Resource, Debug, Default)]
pub(crate) struct Shares {
    under_way: Option<ShareUnderWay>,
    /// Champions for which the user was asked where to save their file, by the number of the question. The stage may show others by the time
    /// of the answer.
    asked: BTreeMap<u32, (Vec<StagedChampion>, StageLook, FilmSize)>,
    /// Number of questions so far.
    questions: u32,
}

/// A file that is being written. Dropping the value cancels the file.
#[derive(Debug)]
struct ShareUnderWay {
    path: PathBuf,
    leash: Arc<Leash>,
    work: BackgroundTask<Result<PathBuf, String>>,
}

/// Look of the stage, of a picture or of a film.
#[derive(Debug, Clone, PartialEq)]
pub struct StageLook {
    /// Camera mode: follow, side or top; on the stage also free.
    pub camera: CameraMode,
    /// Theme of the scene.
    pub theme: Theme,
    /// Overlays that are drawn over the scene.
    pub overlays: Vec<Overlay>,
}

/// Progress of the file that is being written.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct ShareProgress {
    /// Name of the file.
    pub name: String,
    /// Finished share of the file, from 0 to 1.
    pub share: f32,
    /// Expected size of the file, in bytes, if it is known.
    pub expected_bytes: Option<u64>,
    /// Estimated time until the file is finished, if it is known.
    pub left: Option<Duration>,
}

impl ShareProgress {
    /// Describes the progress: "climb.gif  42 %, about 20 s left, about 6.1 MB".
    pub fn in_words(&self) -> String {
        let mut words = format!("{}  {}", self.name, in_percent(self.share));
        if self.share == 0.0 {
            words += ", preparing";
        }
        if let Some(left) = self.left {
            words += &match left.as_secs() {
                seconds @ ..90 => format!(", about {seconds} s left"),
                seconds => format!(", about {} min left", (seconds + 30) / 60),
            };
        }
        if let Some(bytes) = self.expected_bytes {
            words += &format!(", about {:.1} MB", bytes as f64 / 1.0e6);
        }
        words
    }
}

/// Maximum number of questions whose champions are kept: that of an open dialog, and later ones in the library.
const MOST_ASKED: usize = 4;
/// Subject of messages about shared files, which replace each other.
const SUBJECT: &str = "share";
/// Number of parts in which progress is counted.
const PARTS: usize = 1000;

impl Drop for ShareUnderWay {
    fn drop(&mut self) {
        self.leash.cut();
    }
}

impl Shares {
    /// Keeps champions until the user has chosen where to save their file. Returns the number of the question. The last [`MOST_ASKED`] are
    /// kept, because a dialog that was closed sends no answer.
    pub fn ask(&mut self, champions: Vec<StagedChampion>, look: StageLook, size: FilmSize) -> u32 {
        self.questions += 1;
        self.asked.insert(self.questions, (champions, look, size));
        if self.asked.len() > MOST_ASKED {
            self.asked.pop_first();
        }
        self.questions
    }

    /// Begins to write the champions of a question.
    ///
    /// # Errors
    /// See [`Self::begin`]; or the champions are not kept any more.
    pub fn begin_asked(
        &mut self,
        format: ExportFormat,
        path: &Path,
        question: u32,
    ) -> Result<(), String> {
        let asked = self.asked.remove(&question);
        let (champions, look, size) =
            asked.ok_or("Its snake is not kept any more; share it again.")?;
        self.begin(format, path, &champions, (&look, size))
    }

    /// Begins to write champions to a file.
    ///
    /// # Errors
    /// Another file is being written, or the champions cannot be shared in this format.
    pub fn begin(
        &mut self,
        format: ExportFormat,
        path: &Path,
        champions: &[StagedChampion],
        (look, size): (&StageLook, FilmSize),
    ) -> Result<(), String> {
        self.busy().map_or(Ok(()), Err)?;
        refuse_number(format, champions.len())?;
        let shared = champions.iter().map(shared).collect::<Result<Vec<_>, _>>()?;
        let named = with_ending(path, format);
        // The dialog asked whether to replace the file with the chosen name, not the one with the added extension.
        if named != path && named.exists() {
            return Err(format!("{} exists already; choose another name.", name_of(&named)));
        }
        let path = named;
        let leash = Arc::new(Leash::default());
        let arguments = arguments(format, &path, (look, size));
        let held = Arc::clone(&leash);
        let failed = |error| format!("{} could not be written: {error}.", path.display());
        let work = BackgroundTask::start_counted(PARTS, move |control| {
            let champions: Vec<_> = shared.into_iter().map(|evaluated| evaluated()).collect();
            written((&held, &arguments), &champions, |share| {
                control.set_done((share * PARTS as f64) as u32);
            })
        });
        let work = work.map_err(failed)?;
        self.under_way = Some(ShareUnderWay { path, leash, work });
        Ok(())
    }

    /// Returns the reason why no other file can be written now, if there is one.
    pub fn busy(&self) -> Option<String> {
        let under_way = self.under_way.as_ref()?;
        let name = name_of(&under_way.path);
        Some(format!("{name} is being written: wait for it, or cancel it."))
    }

    /// Cancels the file that is being written.
    ///
    /// # Errors
    /// No file is being written.
    pub fn cancel(&mut self) -> Result<(), String> {
        let under_way = self.under_way.as_ref().ok_or("No file is being written.")?;
        under_way.leash.cut();
        Ok(())
    }

    /// Returns the progress of the file that is being written, if any.
    pub fn progress(&self) -> Option<ShareProgress> {
        self.under_way.as_ref().map(|of| {
            let share = of.work.done() as f32 / PARTS as f32;
            let left = of.leash.time_left(f64::from(share));
            let expected_bytes = of.leash.expected_bytes();
            ShareProgress { name: name_of(&of.path), share, expected_bytes, left }
        })
    }

    /// Shows a message about a file that was finished, cancelled or failed.
    fn take_in(&mut self, notices: &mut Notices) {
        let Some(result) = self.under_way.as_ref().and_then(|of| of.work.poll()) else { return };
        let Some(ended) = self.under_way.take() else { return };
        match result.flatten() {
            Ok(saved) => {
                let text = format!("Saved to {}", saved.display());
                offer_path(notices, SUBJECT, text, &saved);
            }
            Err(_) if ended.leash.is_cut() => {
                let name = name_of(&ended.path);
                notices.update(SUBJECT, format!("{name} was cancelled; nothing was written."));
            }
            Err(problem) => notices.problem(problem),
        }
    }
}

/// Checks the number of snakes that a file of this format can hold.
///
/// # Errors
/// There are no snakes, or too many; the error is a sentence for the user.
pub(crate) fn refuse_number(format: ExportFormat, found: usize) -> Result<(), String> {
    let info = format.info();
    match (found, info.most_champions) {
        (0, _) => Err("There is no snake on the stage.".to_owned()),
        (_, 1) if found > 1 => Err(format!(
            "A .{} file holds one snake, and {found} are on the stage. Leave the race with the one that you want.",
            info.ending
        )),
        (_, most) if found > most => Err(format!(
            "A .{} file holds up to {most} snakes, and {found} are on the stage. Race fewer.",
            info.ending
        )),
        _ => Ok(()),
    }
}

fn name_of(path: &Path) -> String {
    printable(&path.file_name().unwrap_or_default().to_string_lossy()).into_owned()
}

/// Adds the extension of a format to a path if it is missing.
fn with_ending(path: &Path, format: ExportFormat) -> PathBuf {
    let ending = format.info().ending;
    let has_it = path.extension().is_some_and(|of| of.eq_ignore_ascii_case(ending));
    if has_it { path.to_owned() } else { path.with_added_extension(ending) }
}

/// Returns the arguments of the program that writes the file, apart from the champions.
fn arguments(
    format: ExportFormat,
    path: &Path,
    (look, size): (&StageLook, FilmSize),
) -> Vec<OsString> {
    let mut arguments: Vec<OsString> = vec!["--output".into(), path.into()];
    if format.is_film() {
        // A free camera would not follow the snake.
        let camera = match look.camera {
            CameraMode::Free => CameraMode::Follow,
            following => following,
        };
        arguments.extend(["--camera".into(), camera.name().to_lowercase().into()]);
        arguments.extend(["--theme".into(), look.theme.name().into()]);
        let overlays: Vec<&str> = look.overlays.iter().filter_map(|of| of.short_name()).collect();
        if !overlays.is_empty() {
            arguments.extend(["--show".into(), overlays.join(",").into()]);
        }
        if size == FilmSize::Small {
            arguments.extend(["--speed", "2", "--most-mb"].map(OsString::from));
            arguments.push(SMALL_GIF_MB.to_string().into());
        }
    }
    arguments
}

/// Converts the champion of a lane for a file. Returns the work that gives its name and the champion, with its result in the
/// world in which it is shown. Fails with a reason if no file can represent it.
pub(super) fn shared(
    staged: &StagedChampion,
) -> Result<impl FnOnce() -> (String, Champion) + Send + use<>, String> {
    let name = staged.label().to_owned();
    if let Some(engine) = staged.other_engine().filter(|_| staged.recording().is_some()) {
        return Err(format!(
            "{name} was recorded by engine {engine}; \"Simulate again\" makes it move by this one, and then it can be shared or saved."
        ));
    }
    if staged.changes_at_step().is_some() {
        return Err(format!(
            "{name}: its world changes while it moves, which no file can hold; try the change from the start."
        ));
    }
    let mut champion = Champion { trial: staged.trial().clone(), ..staged.champion().clone() };
    // A recorded result from another world or engine does not count here.
    let is_to_evaluate = !staged.must_match_record();
    Ok(move || {
        if is_to_evaluate {
            champion.evaluation = evaluate(&champion.genome, &champion.trial);
        }
        (name, champion)
    })
}

fn take_in(mut shares: ResMut<Shares>, mut notices: ResMut<Notices>) {
    // The resource is accessed mutably only if necessary, because the menu bar reacts to its changes.
    if shares.under_way.is_some() {
        shares.take_in(&mut notices);
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Shares>().add_systems(Update, take_in.in_set(FrameSet::TakeIn));
}

#[cfg(test)]
mod tests;
