//! Checks whether a file dialog can be shown. On Linux the desktop's portal shows it, which not every desktop has.
//! Without the portal, a failed dialog could not be distinguished from a cancelled one.

#[cfg(target_os = "linux")]
pub use linux::check;

/// Always succeeds, because Windows and macOS have file dialogs.
#[cfg(not(target_os = "linux"))]
pub fn check() -> Result<(), String> {
    Ok(())
}

#[cfg(target_os = "linux")]
mod linux {
    use std::env;
    use std::ffi::OsStr;
    use std::time::Duration;

    use bevy::tasks::block_on;

    /// Maximum time that a portal may take to answer. The bus may have to start the portal first.
    const TIMEOUT: Duration = Duration::from_secs(5);
    /// Program that shows file dialogs where there is no portal.
    const SUBSTITUTE: &str = "zenity";

    /// Checks that file dialogs can be shown. May take some seconds.
    ///
    /// # Errors
    /// Nothing can show file dialogs; the error is a sentence for the user.
    pub fn check() -> Result<(), String> {
        if block_on(portal_version()).is_ok()
            || is_installed(SUBSTITUTE, env::var_os("PATH").as_deref())
        {
            return Ok(());
        }
        Err("This desktop offers no dialog for files (no xdg-desktop-portal answers), so type the path here."
            .to_owned())
    }

    /// Returns the version of the portal's file dialogs, or an error if there is no such portal.
    async fn portal_version() -> zbus::Result<u32> {
        let session = zbus::connection::Builder::session()?.method_timeout(TIMEOUT);
        let connection = session.build().await?;
        let portal = zbus::Proxy::new(
            &connection,
            "org.freedesktop.portal.Desktop",
            "/org/freedesktop/portal/desktop",
            "org.freedesktop.portal.FileChooser",
        );
        portal.await?.get_property("version").await
    }

    fn is_installed(program: &str, path: Option<&OsStr>) -> bool {
        let folders = path.map(env::split_paths).into_iter().flatten();
        folders.into_iter().any(|folder| folder.join(program).is_file())
    }

    #[cfg(test)]
    mod tests {
        use super::*;

        #[test]
        fn a_program_is_found_in_the_folders_of_the_path() {
            let folder = tempfile::tempdir().expect("a folder");
            let path = env::join_paths([std::path::Path::new("/nowhere"), folder.path()]);
            let path = path.expect("a path");
            assert!(!is_installed("zenity", Some(&path)));
            std::fs::write(folder.path().join("zenity"), "").expect("written");
            assert!(is_installed("zenity", Some(&path)));
            assert!(!is_installed("zenity", None));
        }
    }
}
