//! Exports and imports: copies out of and into the folder of saves that never overwrite a file.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::change::FileStep;
use super::details::{text_of_champion, text_of_file};
use super::moving::{move_new, taken};
use super::name::{ENDING, free_path, plain_name};
use super::notes::add_copy;
use super::place::SavePlace;
use crate::save::files::read_bytes;
use crate::save::lock::{LOCK_FILE, Lock, OWNER_FILE};
use crate::save::plan::{RUN_FILE, load_plan};
use crate::save::replaced::{ANYONES_FOLDER, create_copy, mode_of_copy};
use crate::save::whole_file::prepare_folder;
use crate::save::whole_folder::TemporaryFolder;
use crate::save::{
    KnownFiles, NamedStairs, SaveError, SavedProgress, SavesFolder, is_stairs_file, parse_champion,
    parse_stairs, run_name,
};

/// Name of the folder for exported copies within a folder of saves, unless another folder is given.
pub const EXPORTS: &str = "exports";

/// Maximum size of a copied file, in MiB. Checkpoints are the largest files of a run, and are smaller.
const LARGEST_MIB: u64 = 64;
/// Maximum depth of copied folders: a run has its files in one folder, and figures in a folder below.
const DEEPEST: u32 = 1;

/// Copies an entry out of the folder of saves; of a run, its whole folder. `to` is a folder, which is created if it does not exist, or for
/// a champion a file with the extension ".ron". None: the folder `EXPORTS` within the saves.
///
/// # Errors
/// Fails if a program writes into the run's folder, if a file cannot be read or written, or if the file's name is taken.
pub fn export(
    saves: &SavesFolder,
    place: &SavePlace,
    to: Option<&Path>,
) -> Result<FileStep, SaveError> {
    let exports = saves.path().join(EXPORTS);
    let to = to.unwrap_or(&exports);
    let text = match place {
        SavePlace::Run(run) => return export_run(run, to),
        SavePlace::Champion(_) | SavePlace::Shipped(_) => text_of_champion(place)?,
    };
    let is_file = !to.is_dir() && to.extension().is_some_and(|ending| ending == ENDING);
    let path = if is_file {
        if to.symlink_metadata().is_ok() {
            return Err(taken(to));
        }
        to.to_owned()
    } else {
        prepare_folder(to)?;
        free_path(to, &place.name(), Some(ENDING))
    };
    add_copy(&text, place.path(), path)
}

fn export_run(run: &Path, to: &Path) -> Result<FileStep, SaveError> {
    // A folder that cannot be written needs no lock. If another program holds the lock, the error is reported.
    let lock = match Lock::take(run, "the library") {
        Err(error @ SaveError::InUse { .. }) => return Err(error),
        other => other.ok(),
    };
    prepare_folder(to)?;
    let name = run.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let copied = copy_folder(run, to)?;
    drop(lock);
    let path = free_path(to, &name, None);
    rename_copy(copied, &path)
}

/// Returns the entry at a path. A folder is a run, and so is the file `run.ron` in it, because file dialogs cannot choose folders. Any
/// other file is a champion.
pub fn run_of_plan(path: &Path) -> SavePlace {
    let folder = path.parent().filter(|_| path.file_name().is_some_and(|name| name == RUN_FILE));
    match folder {
        // A path without a folder lies in the working directory.
        Some(folder) if folder.as_os_str().is_empty() => SavePlace::Run(PathBuf::from(".")),
        Some(folder) => SavePlace::Run(folder.to_owned()),
        None if path.is_dir() && !path.is_symlink() => SavePlace::Run(path.to_owned()),
        None => SavePlace::Champion(path.to_owned()),
    }
}

/// Copies a champion, a run or stairs from any path into the folder of saves, after reading and checking it completely. A run may be given
/// as its file `run.ron`; stairs are added to the user's own stairs.
///
/// # Errors
/// Fails if the entry is unreadable, damaged, a link or of another kind, if the run exists already, or if the copy cannot be written.
pub fn import(saves: &SavesFolder, from: &Path) -> Result<FileStep, SaveError> {
    fs::symlink_metadata(from).map_err(SaveError::unreadable(from))?;
    if let SavePlace::Run(run) = run_of_plan(from) {
        return import_run(saves, &run);
    }
    let text = text_of_file(from)?;
    if is_stairs_file(&text) {
        return import_stairs(saves, from, &text);
    }
    parse_champion(from, &text)?;
    saves.prepare()?;
    let name = from.file_stem().unwrap_or_default().to_string_lossy();
    let path = free_path(saves.path(), &plain_name(&name), Some(ENDING));
    add_copy(&text, Some(from), path)
}

fn import_stairs(saves: &SavesFolder, from: &Path, text: &str) -> Result<FileStep, SaveError> {
    let stairs = parse_stairs(from, text)?;
    let name = KnownFiles::<NamedStairs>::read(saves).allowed_name(&stairs.name);
    let path = saves.store_own(&NamedStairs { name, ..stairs })?;
    Ok(FileStep::Added { path })
}

fn import_run(saves: &SavesFolder, from: &Path) -> Result<FileStep, SaveError> {
    // The plan is read before anything is copied, because the user may have chosen a wrong folder.
    let path = saves.path().join(run_name(&load_plan(from)?));
    if path.symlink_metadata().is_ok() {
        return Err(taken(&path));
    }
    saves.prepare()?;
    let copied = copy_folder(from, saves.path())?;
    // The copy is checked, because the original may have changed meanwhile.
    let plan = load_plan(copied.folder.path())?;
    SavedProgress::read(copied.folder.path(), &plan)?;
    rename_copy(copied, &path)
}

/// Gives a completely copied folder its final name.
fn rename_copy(copied: TemporaryFolder, path: &Path) -> Result<FileStep, SaveError> {
    move_new(copied.folder.path(), path)?;
    // The temporary folder has been renamed, so dropping it removes nothing.
    drop(copied);
    Ok(FileStep::Added { path: path.to_owned() })
}

/// Copies a run's folder into another folder under a temporary name. The copy is as private as the original, and is removed when dropped.
/// Links, hidden files and the lock are omitted.
fn copy_folder(from: &Path, into: &Path) -> Result<TemporaryFolder, SaveError> {
    let copy = TemporaryFolder::within(into, mode_of_copy(Some(from), ANYONES_FOLDER));
    let copy = copy.map_err(SaveError::unwritable(into))?;
    copy_files(from, copy.folder.path(), DEEPEST)?;
    Ok(copy)
}

fn copy_files(from: &Path, to: &Path, deeper: u32) -> Result<(), SaveError> {
    let unreadable = SaveError::unreadable(from);
    for found in fs::read_dir(from).map_err(unreadable)? {
        let found = found.map_err(unreadable)?;
        let (kind, name) = (found.file_type().map_err(unreadable)?, found.file_name());
        let copy: PathBuf = to.join(&name);
        let unwritable = SaveError::unwritable(&copy);
        let is_of_lock = name == LOCK_FILE || name == OWNER_FILE;
        if is_of_lock || name.as_encoded_bytes().starts_with(b".") {
            continue;
        }
        if kind.is_file() {
            let bytes = read_bytes(&found.path(), LARGEST_MIB)?;
            let created = create_copy(&copy, &found.path());
            created.and_then(|mut file| file.write_all(&bytes)).map_err(unwritable)?;
        } else if kind.is_dir() && deeper > 0 {
            fs::create_dir(&copy).map_err(unwritable)?;
            copy_files(&found.path(), &copy, deeper - 1)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::files::names_in;
    use crate::save::library::fixtures::{champion_in, names, run_in, saves};
    use crate::save::library::{list, read_entry};

    fn own(saves: &SavesFolder) -> Vec<String> {
        names(&list(saves).expect("readable"), |place| place.path().is_some())
    }

    #[test]
    fn a_champion_is_exported_to_the_default_folder_or_to_a_given_path() {
        let (folder, saves) = saves();
        let place = champion_in(&saves, "a");
        let elsewhere = tempfile::tempdir().expect("a folder");
        let new = elsewhere.path().join("new/folder");
        let file = elsewhere.path().join("mine.ron");
        for (to, expected) in [
            (None, folder.path().join("exports/a.ron")),
            (None, folder.path().join("exports/a 2.ron")),
            (Some(new.as_path()), new.join("a.ron")),
            (Some(file.as_path()), file.clone()),
        ] {
            let step = export(&saves, &place, to).expect("exported");
            assert_eq!(step, FileStep::Added { path: expected });
        }
        let refusal = export(&saves, &place, Some(&file)).expect_err("taken").to_string();
        assert!(refusal.contains("not taken yet"), "{refusal}");
        export(&saves, &SavePlace::Shipped("fast"), Some(&new)).expect("exported");
        assert_eq!(names_in(&new), ["a.ron", "fast.ron"]);
        assert_eq!(own(&saves), ["a"], "copies are not listed");
        let in_a_file = file.join("below");
        let refusal = export(&saves, &place, Some(&in_a_file)).expect_err("no folder").to_string();
        assert!(refusal.contains("below: cannot be written"), "{refusal}");
    }

    #[test]
    fn a_run_is_exported_and_imported_completely_but_not_while_in_use() {
        let (_folder, saves) = saves();
        let run = run_in(&saves, 1);
        let path = run.path().expect("a folder");
        fs::create_dir(path.join("figures")).expect("created");
        fs::write(path.join("figures/one.csv"), "1").expect("written");
        let elsewhere = tempfile::tempdir().expect("a folder");
        let lock = Lock::take(path, "the studio").expect("free");
        let refusal = export(&saves, &run, Some(elsewhere.path())).expect_err("in use");
        assert!(refusal.to_string().contains("in use by"), "{refusal}");
        drop(lock);
        let FileStep::Added { path: copy } =
            export(&saves, &run, Some(elsewhere.path())).expect("exported")
        else {
            panic!("not a copy");
        };
        assert!(!copy.join(LOCK_FILE).exists());
        assert_eq!(fs::read_to_string(copy.join("figures/one.csv")).expect("there"), "1");
        let again = import(&saves, &copy).expect_err("it is there already").to_string();
        assert!(again.contains("not taken yet"), "{again}");
        let (_other, others) = super::super::fixtures::saves();
        // A file dialog chooses the file `run.ron`.
        let step = import(&others, &copy.join("run.ron")).expect("imported");
        let imported = step.place().expect("there");
        assert_eq!(imported.name(), run.name());
        assert_eq!(read_entry(&imported).expect("whole"), read_entry(&run).expect("whole"));
        assert_eq!(names_in(others.path()).len(), 1, "nothing unfinished is left");
    }

    #[test]
    fn a_damaged_entry_is_not_imported_and_leaves_no_files() {
        let (_folder, saves) = saves();
        let elsewhere = tempfile::tempdir().expect("a folder");
        let bad = elsewhere.path().join("bad.ron");
        fs::write(&bad, "(kind: \"snakes-and-stairs champion\", format: 5").expect("written");
        let error = import(&saves, &bad).expect_err("damaged").to_string();
        assert!(error.contains("bad.ron: damaged or incomplete"), "{error}");
        let error = import(&saves, elsewhere.path()).expect_err("no run").to_string();
        assert!(error.contains("it contains no run.ron"), "{error}");
        let other = SavesFolder::find(Some(&elsewhere.path().join("runs")));
        let run = run_in(&other, 1);
        let champion = run.path().expect("a folder").join("generation-1.ron");
        fs::write(champion, "(").expect("written");
        let error = import(&saves, run.path().expect("a folder")).expect_err("damaged").to_string();
        assert!(error.contains("generation-1.ron: damaged or incomplete"), "{error}");
        assert!(names_in(saves.path()).is_empty());
    }

    #[test]
    fn an_imported_file_gets_a_free_name() {
        let (_folder, saves) = saves();
        let (elsewhere, others) = super::super::fixtures::saves();
        champion_in(&others, "a");
        let file = elsewhere.path().join("a.ron");
        fs::rename(&file, elsewhere.path().join("a.txt")).expect("renamed");
        let file = elsewhere.path().join("a.txt");
        for _ in 0..2 {
            import(&saves, &file).expect("imported");
        }
        assert_eq!(own(&saves), ["a 2", "a"]);
        let step = import(&saves, &file).expect("imported");
        step.undo(&saves).expect("undone");
        assert_eq!(own(&saves), ["a 2", "a"]);
    }

    #[test]
    fn imported_stairs_join_the_users_own_under_a_free_name() {
        let (_folder, saves) = saves();
        let shipped =
            Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../assets/stairs/ramps.ron"));
        for expected in ["ramps-2", "ramps-3"] {
            let step = import(&saves, shipped).expect("imported");
            let path = saves.path().join(format!("stairs/{expected}.ron"));
            assert_eq!(step, FileStep::Added { path });
        }
        let stairs = KnownFiles::<NamedStairs>::read(&saves);
        let imported = stairs.find("ramps-3").expect("whole").expect("there");
        let built_in = stairs.find("ramps").expect("whole").expect("built in");
        assert_eq!(imported.stairs, built_in.stairs);
        assert!(own(&saves).is_empty(), "they are no champions");
        let elsewhere = tempfile::tempdir().expect("a folder");
        let steep = elsewhere.path().join("steep.ron");
        let text = fs::read_to_string(shipped).expect("shipped").replace("rise_m: ", "rise_m: 1");
        fs::write(&steep, text).expect("written");
        let error = import(&saves, &steep).expect_err("too steep").to_string();
        assert!(
            error.contains("steep.ron: stairs.rise_m is 10.5; allowed: -5 to -0.01 or 0.01 to 5"),
            "{error}"
        );
    }

    #[cfg(unix)]
    #[test]
    fn links_are_not_followed_on_import_or_export() {
        use std::os::unix::fs::symlink;
        let (folder, saves) = saves();
        let (elsewhere, others) = super::super::fixtures::saves();
        champion_in(&others, "secret");
        let secret = elsewhere.path().join("secret.ron");
        let link = folder.path().join("link.ron");
        symlink(&secret, &link).expect("linked");
        let place = SavePlace::Champion(link.clone());
        for result in [import(&saves, &link), export(&saves, &place, None)] {
            let message = result.expect_err("refused").to_string();
            assert!(message.contains("it is a link"), "{message}");
        }
        let run = run_in(&others, 1);
        symlink(&secret, run.path().expect("a folder").join("link.ron")).expect("linked");
        let imported = import(&saves, run.path().expect("a folder")).expect("imported");
        let copy = imported.place().expect("there");
        assert!(!copy.path().expect("a folder").join("link.ron").is_symlink());
    }
}
