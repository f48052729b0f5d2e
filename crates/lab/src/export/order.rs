//! Orders of an export: champions, a format, and the file to write.

use std::path::PathBuf;

use super::facts::{Fact, facts};
use super::format::ExportFormat;
use super::mjcf::mjcf;
use super::source::ExportSource;
use super::urdf::urdf;
use super::{ExportError, ExportProgress, gltf, page, table_file};
use snakes_core::save::store_text;
use snakes_core::world::WorldPlan;

/// An export to be carried out: champions, a format and a file.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportOrder {
    /// The champions, whose number is allowed in the format.
    pub source: ExportSource,
    format: ExportFormat,
    path: PathBuf,
}

/// Writes the model of a world with facts about the champion. The arguments are `(name, world, facts)`.
type ModelWriter = fn(&str, &WorldPlan, &[Fact]) -> std::io::Result<String>;

impl ExportOrder {
    /// Creates an export to a file whose ending decides the format.
    ///
    /// # Errors
    /// No format has this ending, or its files cannot hold this number of champions.
    pub fn new(source: ExportSource, path: PathBuf) -> Result<Self, ExportError> {
        let format = ExportFormat::of_path("--output", &path)?;
        let found = source.champions.len();
        match source.run {
            Some(_) => format.check_generations(found)?,
            None => format.check_champions(found)?,
        }
        Ok(Self { source, format, path })
    }

    /// Writes the file, unless the format is a film.
    ///
    /// # Errors
    /// The file cannot be written, the format is a film, or the user cancelled.
    pub fn carry_out(&self, progress: &ExportProgress) -> Result<(), ExportError> {
        let Self { source, format, path } = self;
        let champions = &source.champions;
        match format {
            ExportFormat::Csv => table_file::write_csv(champions, path, progress),
            ExportFormat::Html => page::write_page(source, path, progress),
            ExportFormat::Parquet => table_file::write_parquet(champions, path, progress),
            ExportFormat::Glb => gltf::write_glb(champions, path, progress),
            ExportFormat::Mjcf => self.write_models(mjcf, progress),
            ExportFormat::Urdf => self.write_models(urdf, progress),
            ExportFormat::Mp4 | ExportFormat::Gif | ExportFormat::Png => Err(ExportError::Film),
        }
    }

    /// Writes the model of the champion as text. Formats of models hold a single champion.
    fn write_models(
        &self,
        model: ModelWriter,
        progress: &ExportProgress,
    ) -> Result<(), ExportError> {
        progress.reach(0.0)?;
        self.source.champions.iter().try_for_each(|exported| {
            let champion = &exported.loaded.champion;
            let plan = champion.trial.world_plan(&champion.genome);
            let text = model(&exported.name, &plan, &facts(exported));
            Ok(store_text(&self.path, &text.map_err(ExportError::unwritable(&self.path))?)?)
        })
    }
}
