//! Champions and runs to be exported, read from files.

use std::path::{Path, PathBuf};

use super::ExportError;
use snakes_core::Engine;
use snakes_core::check::{Invalid, printable};
use snakes_core::evolve::{GenerationRecord, RunPlan};
use snakes_core::save::{LoadedChampion, load_champion_and_note, load_log, load_run};
use snakes_core::score::evaluate;

/// A champion, and the name under which it appears in the export.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportedChampion {
    /// Name of the champion's file without its ending, or of its generation in a run.
    pub name: String,
    /// File from which the champion was read.
    pub file: PathBuf,
    /// The champion as it was loaded.
    pub loaded: LoadedChampion,
    /// Comment of the user in the champion's file.
    pub note: Option<String>,
}

impl ExportedChampion {
    /// Simulates the champion and replaces its record by the result: for records of other engines.
    pub fn take_result_of_this_engine(&mut self) {
        let LoadedChampion { champion, engine, recording, exam } = &mut self.loaded;
        champion.evaluation = evaluate(&champion.genome, &champion.trial);
        // Engine, recording and exam belong to the replaced record.
        (*engine, *recording) = (Engine::THIS, None);
        exam.clear();
    }
}

/// The run from which all exported champions come.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportedRun {
    /// Plan of the run after all its changes.
    pub plan: RunPlan,
    /// Records of the finished generations.
    pub records: Vec<GenerationRecord>,
    /// Generation of each champion; the first generation is 1.
    pub generations: Vec<u32>,
}

/// Champions to be exported, and their run if they were read from its folder.
#[derive(Debug, Clone, PartialEq)]
pub struct ExportSource {
    /// The champions, in the order of the export.
    pub champions: Vec<ExportedChampion>,
    /// The run of the champions; `None` if they come from single files.
    pub run: Option<ExportedRun>,
}

impl ExportSource {
    /// Reads champions from files, or from the folder of a run the champions of all its generations.
    ///
    /// # Errors
    /// A file cannot be used, or a folder is given together with something else.
    pub fn read(files: &[PathBuf]) -> Result<Self, ExportError> {
        if let Some(folder) = files.iter().find(|file| file.is_dir()) {
            if files.len() > 1 {
                let value = format!("{} files and folders", files.len());
                return Err(
                    Invalid::new("FILES", value, "champions, or one folder of a run").into()
                );
            }
            return Self::read_run(folder);
        }
        let mut champions: Vec<ExportedChampion> = Vec::with_capacity(files.len());
        for file in files {
            let stem = file.file_stem().unwrap_or_default().to_string_lossy();
            let stem = printable(&stem);
            // Tables are grouped by name, so equal names of files in different folders get numbers.
            let is_free = |name: &String| champions.iter().all(|other| other.name != *name);
            let numbered = (2..=files.len() + 1).map(|number| format!("{stem} ({number})"));
            let name = std::iter::once(stem.to_string()).chain(numbered).find(is_free);
            let name = name.unwrap_or_else(|| stem.to_string());
            let (loaded, note) = load_champion_and_note(file)?;
            champions.push(ExportedChampion { name, file: file.clone(), loaded, note });
        }
        Ok(Self { champions, run: None })
    }

    fn read_run(folder: &Path) -> Result<Self, ExportError> {
        let (plan, records) = load_log(folder)?;
        let (generations, loaded): (Vec<u32>, Vec<LoadedChampion>) =
            load_run(folder)?.into_iter().unzip();
        let champion = |(number, loaded): (&u32, LoadedChampion)| ExportedChampion {
            name: format!("generation {number}"),
            file: folder.join(format!("generation-{number}.ron")),
            loaded,
            note: None,
        };
        let champions = generations.iter().zip(loaded).map(champion).collect();
        Ok(Self { champions, run: Some(ExportedRun { plan, records, generations }) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn champions_of_equal_names_are_told_apart() {
        let file = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../saves/climber.ron"));
        let source = ExportSource::read(&[file.clone(), file.clone(), file]).expect("read");
        let names: Vec<&str> = source.champions.iter().map(|of| of.name.as_str()).collect();
        assert_eq!(names, ["climber", "climber (2)", "climber (3)"]);
    }
}
