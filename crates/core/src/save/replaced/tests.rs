//! Links, modes and owners of files that are replaced or copied.
#![cfg(unix)]

use super::*;
use crate::save::files::names_in;
use crate::save::library::fixtures::{champion_in, run_in, saves};
use crate::save::library::{FileStep, duplicate, export, import};
use crate::save::whole_file::write_whole;
use crate::save::{
    ExistingRun, Picture, Preferences, PreferencesFile, RunFolder, UnfinishedFile,
    UnfinishedFolder, load_champion, load_plan, store_exam,
};
use std::io::Write;
use std::os::unix::fs::{MetadataExt, PermissionsExt, chown, symlink};

fn mode_at(path: &Path) -> u32 {
    fs::metadata(path).expect("there").mode() & 0o777
}

fn set_mode(path: &Path, mode: u32) {
    fs::set_permissions(path, PermissionsExt::from_mode(mode)).expect("changed");
}

/// Replaces a file with the text "new", once at once and once piece by piece.
fn replace(path: &Path) -> [std::result::Result<(), String>; 2] {
    let in_pieces = UnfinishedFile::create(path).and_then(|mut file| {
        file.write_all(b"new").expect("written");
        file.finish()
    });
    [write_whole(path, b"new"), in_pieces].map(|done| done.map_err(|error| error.to_string()))
}

#[test]
fn f6_the_file_to_which_links_lead_is_replaced_and_the_links_stay() {
    let around = tempfile::tempdir().expect("a folder");
    let at = |name: &str| around.path().join(name);
    fs::create_dir(at("store")).expect("created");
    fs::create_dir(at("view")).expect("created");
    fs::write(at("store/mine.ron"), "old").expect("written");
    symlink("../store/mine.ron", at("view/mine.ron")).expect("linked");
    symlink(at("view"), at("linked folder")).expect("linked");
    symlink("mine.ron", at("view/again.ron")).expect("linked");
    symlink("../store/not yet.ron", at("view/new.ron")).expect("linked");
    for (link, target) in [
        ("view/mine.ron", "store/mine.ron"),
        ("linked folder/again.ron", "store/mine.ron"),
        ("view/new.ron", "store/not yet.ron"),
    ] {
        assert_eq!(replace(&at(link)), [Ok(()), Ok(())], "{link}");
        assert!(at(link).is_symlink(), "{link}");
        assert_eq!(fs::read_to_string(at(target)).expect("there"), "new", "{link}");
        fs::write(at(target), "old").expect("written");
    }
    assert_eq!(names_in(&at("view")), ["again.ron", "mine.ron", "new.ron"]);
    symlink("circle.ron", at("circle.ron")).expect("linked");
    for refused in replace(&at("circle.ron")) {
        let error = refused.expect_err("a circle");
        assert!(error.contains("circle.ron: cannot be written: "), "{error}");
    }
    // Links of folders are followed, too.
    fs::create_dir(at("frames")).expect("created");
    set_mode(&at("frames"), 0o700);
    symlink("frames", at("a-frames")).expect("linked");
    let folder = UnfinishedFolder::create(&at("a-frames")).expect("empty");
    folder.store_picture("1.png", &Picture::new(2, 2)).expect("written");
    folder.finish().expect("named");
    assert!(at("a-frames").is_symlink() && at("frames/1.png").exists());
    assert_eq!(mode_at(&at("frames")), 0o700);
}

#[test]
fn f6_a_replaced_file_keeps_its_mode_and_its_owner() {
    let around = tempfile::tempdir().expect("a folder");
    let path = around.path().join("mine.ron");
    for mode in [0o600, 0o640, 0o664, 0o755] {
        fs::write(&path, "old").expect("written");
        set_mode(&path, mode);
        assert_eq!(replace(&path), [Ok(()), Ok(())]);
        assert_eq!(mode_at(&path), mode, "{mode:o}");
    }
    // Only an administrator can give a file away.
    if chown(&path, Some(12_345), Some(12_346)).is_ok() {
        assert_eq!(replace(&path), [Ok(()), Ok(())]);
        let about = fs::metadata(&path).expect("there");
        assert_eq!((about.uid(), about.gid(), mode_at(&path)), (12_345, 12_346, 0o755));
    }
}

#[test]
fn f6_a_write_protected_file_and_a_pipe_are_refused_and_stay() {
    let (folder, saves) = saves();
    let place = champion_in(&saves, "mine");
    let path = place.path().expect("a file");
    let before = fs::read(path).expect("there");
    set_mode(path, 0o444);
    let loaded = load_champion(path).expect("readable");
    let error = store_exam(path, &loaded, &[]).expect_err("refused").to_string();
    assert!(error.ends_with("mine.ron: cannot be written: it is write-protected"), "{error}");
    for refused in replace(path) {
        assert_eq!(refused, Err(error.clone()));
    }
    assert_eq!((fs::read(path).expect("there"), mode_at(path)), (before, 0o444));
    let pipe = folder.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|made| made.success()));
    for refused in replace(&pipe) {
        let error = refused.expect_err("refused");
        assert!(error.ends_with("pipe: cannot be written: it is not a regular file"), "{error}");
    }
    assert_eq!(names_in(folder.path()), ["mine.ron", "pipe"]);
}

#[test]
fn f6_links_in_a_runs_folder_are_not_followed_when_it_is_written() {
    let (folder, saves) = saves();
    let run = run_in(&saves, 1);
    let path = run.path().expect("a folder");
    let secret = folder.path().join("secret");
    fs::write(&secret, "do not touch").expect("written");
    let champion = load_champion(&path.join("generation-1.ron")).expect("whole").champion;
    symlink(&secret, path.join("crashed-1-0.ron")).expect("linked");
    let plan = load_plan(path).expect("whole");
    let (run, _) = RunFolder::open(path, &plan, ExistingRun::Keep, "a test").expect("opened");
    let error = run.keep_crashed(&champion).expect_err("refused").to_string();
    assert!(error.ends_with("crashed-1-0.ron: cannot be written: it is a link"), "{error}");
    assert_eq!(fs::read_to_string(&secret).expect("there"), "do not touch");
}

#[test]
fn f6_copies_of_private_champions_and_runs_are_private_and_can_be_changed() {
    let (folder, saves) = saves();
    let elsewhere = tempfile::tempdir().expect("a folder");
    let champion = champion_in(&saves, "mine");
    let run = run_in(&saves, 1);
    let run_path = run.path().expect("a folder");
    set_mode(champion.path().expect("a file"), 0o400);
    set_mode(&run_path.join("log.jsonl"), 0o400);
    set_mode(run_path, 0o700);
    let copied = |step: FileStep| match step {
        FileStep::Added { path } => path,
        other => panic!("{other:?}"),
    };
    let twin = copied(duplicate(&saves, &champion).expect("copied"));
    let out = copied(export(&saves, &run, Some(elsewhere.path())).expect("exported"));
    let (_other, others) = super::super::library::fixtures::saves();
    let back = copied(import(&others, &out).expect("imported"));
    for (path, mode) in [
        (twin, 0o600),
        (out.clone(), 0o700),
        (out.join("log.jsonl"), 0o600),
        (back.clone(), 0o700),
        (back.join("log.jsonl"), 0o600),
    ] {
        assert_eq!(mode_at(&path), mode, "{}", path.display());
    }
    drop(folder);
}

#[test]
fn f6_preferences_behind_a_link_are_written_and_put_aside_where_they_are() {
    let around = tempfile::tempdir().expect("a folder");
    let (link, target) = (around.path().join("studio.ron"), around.path().join("kept.ron"));
    fs::write(&target, "(").expect("written");
    symlink(&target, &link).expect("linked");
    let file = PreferencesFile::at(&link);
    assert_eq!(file.put_aside(), Some(around.path().join("kept.ron.unreadable")));
    file.store(&Preferences::default()).expect("written");
    assert!(link.is_symlink() && target.is_file());
    assert_eq!(file.load().expect("read"), Some(Preferences::default()));
}
