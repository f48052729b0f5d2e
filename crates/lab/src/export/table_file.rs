//! Tables of motion as CSV and Parquet.

use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as PhysicalType};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, FloatType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;

use super::columns::{KEYS, RowReader, RowValues, VALUES, columns};
use super::facts::facts_as_json;
use super::motion::follow;
use super::{ExportError, ExportProgress, ExportedChampion};
use snakes_core::check::no_formula;
use snakes_core::save::UnfinishedFile;
use snakes_core::score::Rollout;

/// Number of rows that are held in memory and become one group of a Parquet file.
const ROWS_PER_GROUP: usize = 100_000;

/// The columns that identify a row: see [`KEYS`].
#[derive(Debug, Clone, Copy)]
struct RowKey<'n> {
    champion: &'n str,
    seed: u64,
    generation: u32,
    step: u32,
    time_s: f64,
    /// Number of the limb; the head is 1.
    limb: u32,
}

/// Simulates all champions, one after the other, and calls `send_row` with each row.
fn send_rows(
    champions: &[ExportedChampion],
    progress: &ExportProgress,
    mut send_row: impl FnMut(&RowKey, &RowValues) -> Result<(), ExportError>,
) -> Result<(), ExportError> {
    let mut reader = RowReader::default();
    for (index, ExportedChampion { name, loaded, .. }) in champions.iter().enumerate() {
        let (seed, generation) = (loaded.champion.origin.seed, loaded.champion.origin.generation);
        let steps_per_s = f64::from(loaded.champion.trial.physics.steps_per_s);
        let send = |rollout: &Rollout| {
            let step = rollout.step();
            let time_s = f64::from(step) / steps_per_s;
            let rows = reader.rows(rollout);
            (1..).zip(&rows).try_for_each(|(limb, values)| {
                let key = RowKey { champion: name, seed, generation, step, time_s, limb };
                send_row(&key, values)
            })
        };
        follow(&loaded.champion, &progress.part(index, champions.len()), send)?;
    }
    Ok(())
}

/// Writes a table as CSV. Numbers have as many digits as their bits need. A missing value is an empty cell. No name is a formula.
pub(super) fn write_csv(
    champions: &[ExportedChampion],
    path: &Path,
    progress: &ExportProgress,
) -> Result<(), ExportError> {
    let failed = of_csv(path);
    let mut file = UnfinishedFile::create(path)?;
    let mut writer = csv::Writer::from_writer(&mut file);
    writer.write_record(columns().map(|column| column.name)).map_err(&failed)?;
    send_rows(champions, progress, |key, values| {
        let numbers = [
            key.seed.to_string(),
            key.generation.to_string(),
            key.step.to_string(),
            key.time_s.to_string(),
            key.limb.to_string(),
        ];
        let values = values.iter().map(|value| value.map(|value| value.to_string()));
        let cells = [no_formula(key.champion).into_owned()].into_iter().chain(numbers);
        writer.write_record(cells.chain(values.map(Option::unwrap_or_default))).map_err(&failed)
    })?;
    writer.flush().map_err(ExportError::unwritable(path))?;
    drop(writer);
    Ok(file.finish()?)
}

/// Returns a function that turns a CSV error into the error that the file at `path` cannot be written.
fn of_csv(path: &Path) -> impl Fn(csv::Error) -> ExportError {
    move |error| {
        let text = error.to_string();
        match error.into_kind() {
            csv::ErrorKind::Io(system) => ExportError::unwritable(path)(system),
            _ => ExportError::unwritable(path)(text),
        }
    }
}

/// Key of the file's metadata that has the facts about each champion as JSON.
const CHAMPIONS: &str = "champions";

/// Writes a table as Parquet: columns of 32-bit floats, in groups of [`ROWS_PER_GROUP`] rows. The file's metadata has the meanings
/// of the columns and facts about the champions.
pub(super) fn write_parquet(
    champions: &[ExportedChampion],
    path: &Path,
    progress: &ExportProgress,
) -> Result<(), ExportError> {
    let failed = of_parquet(path);
    let meanings =
        columns().map(|column| KeyValue::new(column.name.to_owned(), column.meaning.to_owned()));
    let about = KeyValue::new(CHAMPIONS.to_owned(), facts_as_json(champions).to_string());
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        // Name and version of this program. The library's own text would change with each update of the library.
        .set_created_by(concat!("snakes-and-stairs version ", env!("CARGO_PKG_VERSION")).to_owned())
        .set_key_value_metadata(Some(meanings.chain([about]).collect()))
        // Splitting floats by bytes compresses better, because neighbouring steps differ in few bits.
        .set_encoding(Encoding::BYTE_STREAM_SPLIT)
        .set_dictionary_enabled(false)
        .set_column_dictionary_enabled(KEYS[0].name.into(), true)
        .set_column_encoding(KEYS[0].name.into(), Encoding::PLAIN);
    let whole_numbers = [1, 2, 3, 5].map(|index: usize| KEYS[index].name);
    let properties = whole_numbers
        .into_iter()
        .fold(properties, |properties, name| {
            properties.set_column_encoding(name.into(), Encoding::DELTA_BINARY_PACKED)
        })
        .build();
    let schema = Arc::new(schema().map_err(&failed)?);
    let file = UnfinishedFile::create(path)?;
    let writer = SerializedFileWriter::new(file, schema, Arc::new(properties));
    let mut table =
        ParquetTable { writer: writer.map_err(&failed)?, path, group: RowGroup::default() };
    send_rows(champions, progress, |key, values| table.row(key, values))?;
    table.write_group()?;
    Ok(table.writer.into_inner().map_err(&failed)?.finish()?)
}

/// A Parquet file in progress.
struct ParquetTable<'p> {
    writer: SerializedFileWriter<UnfinishedFile>,
    path: &'p Path,
    group: RowGroup,
}

/// Rows that are not written yet, column by column.
#[derive(Debug)]
struct RowGroup {
    champions: Vec<ByteArray>,
    seeds: Vec<i64>,
    generations: Vec<i32>,
    steps: Vec<i32>,
    times_s: Vec<f64>,
    limbs: Vec<i32>,
    /// For each column its present values, and for each row 1 if the value is present, else 0.
    values: Vec<(Vec<f32>, Vec<i16>)>,
}

impl Default for RowGroup {
    fn default() -> Self {
        Self {
            champions: Vec::new(),
            seeds: Vec::new(),
            generations: Vec::new(),
            steps: Vec::new(),
            times_s: Vec::new(),
            limbs: Vec::new(),
            values: vec![Default::default(); VALUES.len()],
        }
    }
}

impl ParquetTable<'_> {
    /// Adds a row, and writes the held rows once they make a group.
    fn row(&mut self, key: &RowKey, values: &RowValues) -> Result<(), ExportError> {
        let group = &mut self.group;
        group.champions.push(key.champion.into());
        group.seeds.push(key.seed.cast_signed());
        group.generations.push(key.generation.cast_signed());
        group.steps.push(key.step.cast_signed());
        group.times_s.push(key.time_s);
        group.limbs.push(key.limb.cast_signed());
        for ((present, levels), value) in group.values.iter_mut().zip(values) {
            levels.push(value.is_some().into());
            present.extend(value);
        }
        if group.steps.len() >= ROWS_PER_GROUP { self.write_group() } else { Ok(()) }
    }

    /// Writes the held rows as a group.
    fn write_group(&mut self) -> Result<(), ExportError> {
        let group = std::mem::take(&mut self.group);
        let mut write = || {
            let mut row_group = self.writer.next_row_group()?;
            write_column::<ByteArrayType>(&mut row_group, &group.champions, None)?;
            write_column::<Int64Type>(&mut row_group, &group.seeds, None)?;
            write_column::<Int32Type>(&mut row_group, &group.generations, None)?;
            write_column::<Int32Type>(&mut row_group, &group.steps, None)?;
            write_column::<DoubleType>(&mut row_group, &group.times_s, None)?;
            write_column::<Int32Type>(&mut row_group, &group.limbs, None)?;
            for (present, levels) in &group.values {
                write_column::<FloatType>(&mut row_group, present, Some(levels))?;
            }
            row_group.close().map(drop)
        };
        write().map_err(of_parquet(self.path))
    }
}

fn write_column<T: parquet::data_type::DataType>(
    group: &mut SerializedRowGroupWriter<'_, UnfinishedFile>,
    values: &[T::T],
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let missing = || ParquetError::General("a column is missing".to_owned());
    let mut column = group.next_column()?.ok_or_else(missing)?;
    column.typed::<T>().write_batch(values, levels, None)?;
    column.close()
}

/// Returns the types of all columns.
fn schema() -> Result<Type, ParquetError> {
    let field = |name, physical, logical, repetition| {
        let builder = Type::primitive_type_builder(name, physical);
        builder.with_logical_type(logical).with_repetition(repetition).build().map(Arc::new)
    };
    let key = |index: usize, physical, logical| {
        field(KEYS[index].name, physical, logical, Repetition::REQUIRED)
    };
    let mut fields = vec![
        key(0, PhysicalType::BYTE_ARRAY, Some(LogicalType::String))?,
        key(1, PhysicalType::INT64, Some(LogicalType::integer(64, false)))?,
        key(2, PhysicalType::INT32, None)?,
        key(3, PhysicalType::INT32, None)?,
        key(4, PhysicalType::DOUBLE, None)?,
        key(5, PhysicalType::INT32, None)?,
    ];
    for column in VALUES {
        fields.push(field(column.name, PhysicalType::FLOAT, None, Repetition::OPTIONAL)?);
    }
    Type::group_type_builder("motion").with_fields(fields).build()
}

/// Returns a function that turns a Parquet error into the error that the file at `path` cannot be written.
fn of_parquet(path: &Path) -> impl Fn(ParquetError) -> ExportError {
    move |error| match error {
        ParquetError::External(reason) => ExportError::unwritable(path)(reason),
        other => ExportError::unwritable(path)(other),
    }
}
