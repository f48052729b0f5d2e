//! Environment variables that decide whether a window can open and a picture can be drawn.
//!
//! Those of a desktop session may be missing or stale: after `su`, in containers, over some remote connections, and in a
//! terminal that outlives its session.

use std::ffi::OsString;

#[cfg(target_os = "linux")]
pub use linux::correct;

/// The environment is taken as it is: other systems have no such variables.
#[cfg(not(target_os = "linux"))]
pub fn correct(_say: impl Fn(&str)) {}

const WAYLAND_SOCKET: &str = "WAYLAND_SOCKET";
const WAYLAND_DISPLAY: &str = "WAYLAND_DISPLAY";
const X11_DISPLAY: &str = "DISPLAY";

/// The variables that lead to no display, in words.
pub(super) fn of_display() -> String {
    let names = [WAYLAND_SOCKET, WAYLAND_DISPLAY, X11_DISPLAY, "XAUTHORITY"];
    let set = names.map(|name| Some((OsString::from(name), std::env::var_os(name)?)));
    displays_in_words(set.into_iter().flatten())
}

/// The variables that may hide a graphics driver, in words; empty if there are none.
pub(super) fn of_graphics() -> String {
    let is_of_graphics = |name: &OsString| {
        ["WGPU_", "VK_"].iter().any(|start| name.as_encoded_bytes().starts_with(start.as_bytes()))
    };
    let set = in_words(std::env::vars_os().filter(|(name, _)| is_of_graphics(name)));
    if set.is_empty() { set } else { format!("; {set} may hide it") }
}

fn displays_in_words(set: impl Iterator<Item = (OsString, OsString)>) -> String {
    if !cfg!(target_os = "linux") {
        return String::new();
    }
    match in_words(set).as_str() {
        "" => format!(": neither {WAYLAND_DISPLAY} nor {X11_DISPLAY} is set"),
        set => format!(": no server answers with {set}"),
    }
}

/// Names and values, in the order of the names, without those that are empty.
fn in_words(set: impl Iterator<Item = (OsString, OsString)>) -> String {
    let set = set.filter(|(_, value)| !value.is_empty());
    let mut words: Vec<_> = set.map(|(name, of)| format!("{}={of:?}", name.display())).collect();
    words.sort();
    words.join(", ")
}

#[cfg(target_os = "linux")]
mod linux {
    use std::ffi::{OsStr, OsString};
    use std::os::unix::fs::MetadataExt;
    use std::os::unix::net::UnixStream;
    use std::os::unix::process::CommandExt;
    use std::path::{Path, PathBuf};

    use crate::studio::failure::variables::{WAYLAND_DISPLAY, WAYLAND_SOCKET, X11_DISPLAY};

    /// The variable that names the folder of a session's sockets. Without it, a layer of the Vulkan drivers (Mesa's device
    /// selection) writes the same error to standard error each time devices are listed, twice at every start.
    const RUNTIME_FOLDER: &str = "XDG_RUNTIME_DIR";

    /// A variable with a value that leads nowhere.
    #[derive(Debug, PartialEq)]
    struct Correction {
        variable: &'static str,
        /// The value to use instead, or `None` to remove the variable.
        value: Option<OsString>,
        /// Description of the fault, and of the value that is used instead.
        note: String,
    }

    /// Starts this program again with other variables, if those of the session lead nowhere and others do: winit takes the
    /// first that is set, and gives up if nothing answers there. Says each change in one line through `say`.
    pub fn correct(say: impl Fn(&str)) {
        // A process belongs to the user who started it, and so does its entry among the processes.
        let own = Path::new("/proc/self").metadata();
        let (Ok(program), Ok(own)) = (std::env::current_exe(), own) else { return };
        let corrections = corrections(|name| std::env::var_os(name), own.uid());
        if corrections.is_empty() {
            return;
        }
        let mut command = std::process::Command::new(program);
        for Correction { variable, value, note } in corrections {
            say(&format!("note: {note}"));
            match value {
                Some(value) => command.env(variable, value),
                None => command.env_remove(variable),
            };
        }
        // The process keeps its number. `exec` returns only on failure; then the errors are the same as before.
        let _ = command.args(std::env::args_os().skip(1)).exec();
    }

    fn corrections(of: impl Fn(&str) -> Option<OsString>, user: u32) -> Vec<Correction> {
        let set = |name: &str| of(name).filter(|value| !value.is_empty());
        let mut found = Vec::new();
        let runtime_folder = set(RUNTIME_FOLDER).map(PathBuf::from);
        let usable = runtime_folder.as_ref().filter(|folder| folder.is_absolute());
        let folder = usable.cloned().unwrap_or_else(|| format!("/run/user/{user}").into());
        if usable.is_none() {
            let fault = match &runtime_folder {
                Some(relative) => format!("is {relative:?}, which is no absolute path"),
                None => "is not set".to_owned(),
            };
            let note = format!("{RUNTIME_FOLDER} {fault}, so {} is used", folder.display());
            let value = Some(folder.clone().into());
            found.push(Correction { variable: RUNTIME_FOLDER, value, note });
        }
        let wayland = set(WAYLAND_DISPLAY);
        let answers =
            wayland.as_ref().is_some_and(|name| UnixStream::connect(folder.join(name)).is_ok());
        let x11 = set(X11_DISPLAY);
        let other = if answers { wayland.clone() } else { x11.clone() };
        let Some(other) = other else { return found };
        let other_name = if answers { WAYLAND_DISPLAY } else { X11_DISPLAY };
        let mut remove = |variable, fault: String| {
            let note = format!("{variable} is {fault}, so {other_name}={other:?} is used");
            found.push(Correction { variable, value: None, note });
        };
        // winit prefers an inherited socket, even one with an empty name.
        let inherited = of(WAYLAND_SOCKET);
        let has_socket = inherited.as_ref().is_some_and(|number| is_open_socket(number));
        if let Some(number) = inherited.filter(|_| !has_socket) {
            remove(WAYLAND_SOCKET, format!("{number:?}, which is no open socket"));
        }
        if let Some(name) = wayland.filter(|_| !answers && !has_socket) {
            remove(WAYLAND_DISPLAY, format!("{name:?}, where no Wayland server answers"));
        }
        found
    }

    /// Whether this process has an open socket with this number.
    fn is_open_socket(number: &OsStr) -> bool {
        let number = number.to_str().and_then(|text| text.parse::<u32>().ok());
        let file = number.map(|number| Path::new("/proc/self/fd").join(number.to_string()));
        let target = file.and_then(|file| file.read_link().ok());
        target.is_some_and(|target| target.as_os_str().as_encoded_bytes().starts_with(b"socket:"))
    }

    #[cfg(test)]
    mod tests {
        use super::*;
        use std::os::fd::AsRawFd;
        use std::os::unix::net::UnixListener;

        /// The corrections of variables, each with its new value, or an empty one if it is removed.
        fn corrected(set: &[(&str, &str)]) -> Vec<(&'static str, String)> {
            let of = |name: &str| {
                set.iter().find(|(of, _)| *of == name).map(|(_, value)| OsString::from(value))
            };
            let of_one = |correction: Correction| {
                let value = correction.value.unwrap_or_default();
                assert!(correction.note.starts_with(correction.variable), "{}", correction.note);
                (correction.variable, value.into_string().expect("UTF-8"))
            };
            corrections(of, 1000).into_iter().map(of_one).collect()
        }

        #[test]
        fn f2_a_stale_wayland_display_gives_way_to_x11_and_one_that_answers_stays() {
            let folder = tempfile::tempdir().expect("a folder");
            let at = folder.path().to_str().expect("UTF-8");
            let _server = UnixListener::bind(folder.path().join("wayland-1")).expect("bound");
            let with = |others: &[(&'static str, &'static str)]| {
                corrected(&[&[(RUNTIME_FOLDER, at)], others].concat())
            };
            let gone = |name| vec![(name, String::new())];
            let x11 = (X11_DISPLAY, ":0");
            assert_eq!(with(&[(WAYLAND_DISPLAY, "wayland-9"), x11]), gone(WAYLAND_DISPLAY));
            assert_eq!(with(&[(WAYLAND_DISPLAY, "wayland-1"), x11]), []);
            assert_eq!(with(&[(WAYLAND_DISPLAY, ""), x11]), []);
            // Without another display, the error names the variable.
            assert_eq!(with(&[(WAYLAND_DISPLAY, "wayland-9")]), []);
            // A socket that the process does not have.
            let socket = |number| (WAYLAND_SOCKET, number);
            for number in ["", "four", "99999", "-1"] {
                assert_eq!(with(&[socket(number), x11]), gone(WAYLAND_SOCKET), "{number}");
                let both = [socket(number), (WAYLAND_DISPLAY, "wayland-1")];
                assert_eq!(with(&both), gone(WAYLAND_SOCKET), "{number}");
            }
            let path = folder.path().join("wayland-1");
            let absolute = [(WAYLAND_DISPLAY, path.to_str().expect("UTF-8")), x11];
            assert_eq!(corrected(&[&[(RUNTIME_FOLDER, "/nowhere")], &absolute[..]].concat()), []);
            let open = UnixStream::connect(&path).expect("connected").as_raw_fd().to_string();
            assert!(!is_open_socket(OsStr::new(&open)), "closed again");
        }

        #[test]
        fn f2_an_inherited_socket_stays() {
            let (own, _other) = UnixStream::pair().expect("a pair");
            let number = own.as_raw_fd().to_string();
            let set = [
                (RUNTIME_FOLDER, "/nowhere"),
                (WAYLAND_SOCKET, number.as_str()),
                (WAYLAND_DISPLAY, "wayland-9"),
                (X11_DISPLAY, ":0"),
            ];
            assert_eq!(corrected(&set), []);
        }

        #[test]
        fn f2_a_runtime_folder_that_is_no_absolute_path_is_replaced() {
            let usual = vec![(RUNTIME_FOLDER, "/run/user/1000".to_owned())];
            assert_eq!(corrected(&[]), usual);
            assert_eq!(corrected(&[(RUNTIME_FOLDER, "")]), usual);
            assert_eq!(corrected(&[(RUNTIME_FOLDER, "run/user")]), usual);
            assert_eq!(corrected(&[(RUNTIME_FOLDER, "/tmp")]), []);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn f2_an_error_names_the_variables_that_led_nowhere_with_their_values() {
        let said = |set: &[(&str, &str)]| {
            let owned = |(name, value): &(&str, &str)| (name.into(), value.into());
            displays_in_words(set.iter().map(owned))
        };
        if cfg!(target_os = "linux") {
            assert_eq!(said(&[]), ": neither WAYLAND_DISPLAY nor DISPLAY is set");
            assert_eq!(said(&[("DISPLAY", "")]), said(&[]));
            let both = said(&[("WAYLAND_DISPLAY", "wayland-9"), ("DISPLAY", ":94")]);
            let expected =
                ": no server answers with DISPLAY=\":94\", WAYLAND_DISPLAY=\"wayland-9\"";
            assert_eq!(both, expected);
        }
    }
}
