//! Formats of exports. The ending of a file's name chooses the format.

use std::path::Path;

use snakes_core::check::{Invalid, quoted};

/// A format in which champions are exported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportFormat {
    /// Table of motion as text.
    Csv,
    /// Table of motion in columns.
    Parquet,
    /// Web page that plays champions and evolves them further.
    Html,
    /// Animated 3D scene in binary glTF.
    Glb,
    /// A model of body and stairs for MuJoCo.
    Mjcf,
    /// Model of the body for ROS and other programs that read URDF.
    Urdf,
    /// Film for video players.
    Mp4,
    /// A film for web pages, messages and slides.
    Gif,
    /// Film as a folder of pictures.
    Png,
}

/// Facts about a format of exports.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FormatInfo {
    /// Ending of the format's files, without the dot, in lower case.
    pub ending: &'static str,
    /// Name of the format in menus.
    pub title: &'static str,
    /// One sentence on contents and use of the format.
    pub sentence: &'static str,
    /// Maximum number of champions in one file.
    pub most_champions: usize,
    /// Maximum number of generations of an exported run, each with its champion.
    pub most_generations: usize,
}

/// Maximum number of champions in a film, which race side by side.
const MOST_LANES: usize = 10;

impl ExportFormat {
    /// All formats, in the order of menus.
    pub const ALL: [Self; 9] = [
        Self::Html,
        Self::Mp4,
        Self::Gif,
        Self::Png,
        Self::Glb,
        Self::Csv,
        Self::Parquet,
        Self::Mjcf,
        Self::Urdf,
    ];

    /// Returns the facts about the format.
    pub const fn info(self) -> FormatInfo {
        match self {
            Self::Csv => FormatInfo {
                ending: "csv",
                title: "Table as text",
                sentence: "Motion, forces and senses of every block in every step, for spreadsheets and scripts.",
                most_champions: 100,
                most_generations: 1000,
            },
            Self::Parquet => FormatInfo {
                ending: "parquet",
                title: "Table for data tools",
                sentence: "The same table in columns, small and fast, for pandas, DuckDB and Polars.",
                most_champions: 100,
                most_generations: 1000,
            },
            Self::Html => FormatInfo {
                ending: "html",
                title: "Page for any browser",
                sentence: "One file that plays the climb in 3D, simulates it again, and needs no network.",
                most_champions: 6,
                most_generations: 500,
            },
            Self::Glb => FormatInfo {
                ending: "glb",
                title: "Animated scene",
                sentence: "The moving snakes on their stairs (glTF 2.0), for Blender, PowerPoint and 3D viewers.",
                most_champions: 10,
                most_generations: 1,
            },
            Self::Mjcf => FormatInfo {
                ending: "xml",
                title: "Model for MuJoCo",
                sentence: "Body, motors and stairs for MuJoCo (MJCF).",
                most_champions: 1,
                most_generations: 1,
            },
            Self::Urdf => FormatInfo {
                ending: "urdf",
                title: "Model for robotics",
                sentence: "The body for ROS, Gazebo, Drake, Pinocchio and PyBullet (URDF).",
                most_champions: 1,
                most_generations: 1,
            },
            Self::Mp4 => FormatInfo {
                ending: "mp4",
                title: "Film",
                sentence: "A film (H.264) for every player and slide program; needs ffmpeg.",
                most_champions: MOST_LANES,
                most_generations: MOST_LANES,
            },
            Self::Gif => FormatInfo {
                ending: "gif",
                title: "Film as GIF",
                sentence: "The climb as a film that plays by itself in web pages and messages, of at most 8 MB.",
                most_champions: MOST_LANES,
                most_generations: MOST_LANES,
            },
            Self::Png => FormatInfo {
                ending: "png",
                title: "Film as pictures",
                sentence: "A film as numbered pictures in a folder NAME-frames, for programs that cut films.",
                most_champions: MOST_LANES,
                most_generations: MOST_LANES,
            },
        }
    }

    /// Returns whether the format is a film, which the studio draws.
    pub const fn is_film(self) -> bool {
        matches!(self, Self::Mp4 | Self::Gif | Self::Png)
    }

    /// Checks that a file of this format can hold `found` champions.
    ///
    /// # Errors
    /// There are no champions, or too many.
    pub fn check_champions(self, found: usize) -> Result<(), Invalid> {
        let FormatInfo { ending, most_champions: most, .. } = self.info();
        let allowed = match most {
            1 => format!("a single champion in .{ending}; name one file"),
            _ => format!("1 to {most} champions in .{ending}; name fewer files"),
        };
        check_files((1..=most).contains(&found), format!("{found} champions"), allowed)
    }

    /// Checks that a file of this format can hold the champions of `found` generations of a run.
    ///
    /// # Errors
    /// There are no generations, or too many.
    pub fn check_generations(self, found: usize) -> Result<(), Invalid> {
        let FormatInfo { ending, most_generations: most, .. } = self.info();
        let allowed = match most {
            1 => format!(
                "the champion of one generation in .{ending}; name its file in the run's folder"
            ),
            _ => format!("a run of 1 to {most} generations in .{ending}"),
        };
        let value = format!("a run of {found} generations");
        check_files((1..=most).contains(&found), value, allowed)
    }

    /// Returns the format of a file, by the ending of its name.
    ///
    /// # Errors
    /// No format has this ending.
    pub fn of_path(field: &str, path: &Path) -> Result<Self, Invalid> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let has_ending = |format: &Self| ending.eq_ignore_ascii_case(format.info().ending);
        Self::ALL.into_iter().find(has_ending).ok_or_else(|| {
            let endings = Self::ALL.map(|format| format!(".{}", format.info().ending));
            let allowed = format!("a name that ends in {}", endings.join(", "));
            Invalid::new(field, quoted(&path.display().to_string()), allowed)
        })
    }
}

/// Returns an error about `value` if it is not allowed.
fn check_files(is_allowed: bool, value: String, allowed: String) -> Result<(), Invalid> {
    if is_allowed { Ok(()) } else { Err(Invalid::new("FILES", value, allowed)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ending_decides_and_case_does_not_matter() {
        for format in ExportFormat::ALL {
            let ending = format.info().ending;
            for name in [format!("a.{ending}"), format!("x/b.c.{}", ending.to_uppercase())] {
                assert_eq!(ExportFormat::of_path("--output", Path::new(&name)), Ok(format));
            }
        }
        let refused = ExportFormat::of_path("--output", Path::new("a.doc")).expect_err("unknown");
        let text = refused.to_string();
        assert!(
            text.starts_with("--output is \"a.doc\"; allowed: a name that ends in .html, "),
            "{text}"
        );
        assert!(ExportFormat::of_path("--output", Path::new("csv")).is_err());
    }
}
