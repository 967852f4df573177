//! Lists and tables of a batch as Parquet.

use super::content::{Cells, cannot_read};
use super::tables::{Line, Table, status, summary};
use crate::cli::data_error;
use crate::error::{Error, Result};
use crate::file::read_bytes;
use crate::limits::MAX_FILE_BYTES;
use crate::output::write_atomically;
use bytes::Bytes;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::Field;
use parquet::schema::types::Type;
use std::path::Path;
use std::sync::Arc;

/// Rows that are in memory as cells at once.
const GROUP_ROWS: usize = 1 << 16;
/// Columns whose cells are text, whatever they look like.
const TEXTS: [&str; 5] = ["id", "key", "status", "class", "message"];

/// The rows of a manifest, counted from 1.
///
/// # Errors
/// A file that cannot be read, or is no Parquet.
pub fn cells(path: &Path) -> anyhow::Result<Cells> {
    let bytes =
        read_bytes(path, MAX_FILE_BYTES).map_err(|error| anyhow::Error::new(error).context(cannot_read(path)))?;
    let broken =
        |error: &dyn std::fmt::Display| data_error(format!("`{}` is no Parquet file ({error})", path.display()));
    let reader = SerializedFileReader::new(Bytes::from(bytes)).map_err(|error| broken(&error))?;
    let mut found = Vec::new();
    for (index, row) in reader.get_row_iter(None).map_err(|error| broken(&error))?.enumerate() {
        let row = row.map_err(|error| broken(&error))?;
        let mut cells = Vec::new();
        for (name, field) in row.get_column_iter() {
            let Some(cell) = cell(field) else {
                return Ok(Err((index + 1, format!("`{name}` has to be a text, a number, true or false"))));
            };
            cells.push((name.clone(), cell));
        }
        found.push((index + 1, cells));
    }
    Ok(Ok(found))
}

fn cell(field: &Field) -> Option<String> {
    match field {
        Field::Null => Some(String::new()),
        Field::Str(text) => Some(text.clone()),
        Field::Group(_) | Field::ListInternal(_) | Field::MapInternal(_) | Field::Bytes(_) => None,
        // A column of whole numbers with a missing one has become one of floats.
        Field::Double(number) => Some(if number.is_nan() { String::new() } else { number.to_string() }),
        Field::Float(number) => Some(if number.is_nan() { String::new() } else { number.to_string() }),
        other => Some(other.to_string()),
    }
}

/// Writes both tables.
///
/// # Errors
/// A table that cannot be written.
pub fn write(lines: &[Line], status_path: &Path, summary_path: &Path) -> Result<()> {
    for (path, table) in [(status_path, status as Table), (summary_path, summary)] {
        let bytes = encode(lines, table)?;
        write_atomically(path, |file| Ok(file.write_all(&bytes)?))?;
    }
    Ok(())
}

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Kind {
    Boolean,
    Whole,
    Number,
    Text,
}

impl Kind {
    /// The narrowest kind that has `cell`.
    fn of(cell: &str) -> Self {
        match cell {
            "true" | "false" => Self::Boolean,
            _ if cell.parse::<i64>().is_ok() => Self::Whole,
            _ if cell.parse::<f64>().is_ok() => Self::Number,
            _ => Self::Text,
        }
    }

    fn physical(self) -> Physical {
        match self {
            Self::Boolean => Physical::BOOLEAN,
            Self::Whole => Physical::INT64,
            Self::Number => Physical::DOUBLE,
            Self::Text => Physical::BYTE_ARRAY,
        }
    }
}

fn encode(lines: &[Line], table: Table) -> Result<Vec<u8>> {
    let columns = columns(lines, table)?;
    let fields = columns.iter().map(|(name, kind)| {
        let logical = (*kind == Kind::Text).then_some(LogicalType::String);
        let field = Type::primitive_type_builder(name, kind.physical()).with_repetition(Repetition::OPTIONAL);
        Ok(Arc::new(field.with_logical_type(logical).build().map_err(Error::invalid)?))
    });
    let schema = Type::group_type_builder("schema").with_fields(fields.collect::<Result<_>>()?).build();
    let schema = Arc::new(schema.map_err(Error::invalid)?);
    let mut bytes = Vec::new();
    let mut writer = SerializedFileWriter::new(&mut bytes, schema, Arc::new(WriterProperties::builder().build()))
        .map_err(Error::invalid)?;
    let mut cells: Vec<Vec<String>> = vec![Vec::new(); columns.len()];
    let mut is_header = true;
    table(lines, &mut |row| {
        if std::mem::take(&mut is_header) {
            return Ok(());
        }
        for (column, cell) in cells.iter_mut().zip(row) {
            column.push(cell.to_string());
        }
        if cells[0].len() == GROUP_ROWS { write_group(&mut writer, &columns, &mut cells) } else { Ok(()) }
    })?;
    write_group(&mut writer, &columns, &mut cells)?;
    writer.close().map_err(Error::invalid)?;
    Ok(bytes)
}

/// Names and kinds of the columns.
fn columns(lines: &[Line], table: Table) -> Result<Vec<(String, Kind)>> {
    let mut columns: Vec<(String, Option<Kind>)> = Vec::new();
    table(lines, &mut |row| {
        if columns.is_empty() {
            let kind = |name: &str| TEXTS.contains(&name).then_some(Kind::Text);
            columns.extend(row.iter().map(|name| (name.to_string(), kind(name))));
            return Ok(());
        }
        for ((_, kind), cell) in columns.iter_mut().zip(row).filter(|(_, cell)| !cell.is_empty()) {
            let found = Kind::of(cell);
            // Words among numbers are text.
            let is_mixed = kind.is_some_and(|kind| (kind == Kind::Boolean) != (found == Kind::Boolean));
            *kind = Some(if is_mixed { Kind::Text } else { kind.map_or(found, |kind| kind.max(found)) });
        }
        Ok(())
    })?;
    Ok(columns.into_iter().map(|(name, kind)| (name, kind.unwrap_or(Kind::Number))).collect())
}

fn write_group<W: std::io::Write + Send>(
    writer: &mut SerializedFileWriter<W>,
    columns: &[(String, Kind)],
    cells: &mut [Vec<String>],
) -> Result<()> {
    let mut group = writer.next_row_group().map_err(Error::invalid)?;
    for ((_, kind), cells) in columns.iter().zip(cells) {
        let Some(mut column) = group.next_column().map_err(Error::invalid)? else { break };
        // An empty text is one; an empty number is missing.
        let is_there = |cell: &&String| *kind == Kind::Text || !cell.is_empty();
        let levels: Vec<i16> = cells.iter().map(|cell| i16::from(is_there(&cell))).collect();
        let some = || cells.iter().filter(is_there);
        let levels = Some(levels.as_slice());
        let written = match column.untyped() {
            ColumnWriter::BoolColumnWriter(column) => {
                column.write_batch(&some().map(|cell| cell == "true").collect::<Vec<_>>(), levels, None)
            }
            ColumnWriter::Int64ColumnWriter(column) => {
                column.write_batch(&some().filter_map(|cell| cell.parse().ok()).collect::<Vec<_>>(), levels, None)
            }
            ColumnWriter::DoubleColumnWriter(column) => {
                column.write_batch(&some().filter_map(|cell| cell.parse().ok()).collect::<Vec<_>>(), levels, None)
            }
            ColumnWriter::ByteArrayColumnWriter(column) => {
                column.write_batch(&some().map(|cell| ByteArray::from(cell.as_str())).collect::<Vec<_>>(), levels, None)
            }
            _ => Ok(0),
        };
        written.map_err(Error::invalid)?;
        column.close().map_err(Error::invalid)?;
        cells.clear();
    }
    group.close().map_err(Error::invalid)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::manifest;
    use super::super::store::{Ended, Failure};
    use super::super::tables::Outcome;
    use super::*;
    use serde_json::json;

    #[test]
    fn tables_come_back_as_rows_and_a_list_as_recordings() {
        let ended = |answer, failure| Some(Outcome::of(Ended { seconds: 0.5, attempts: 1, failure, answer }, false));
        let failure = Failure { class: "data".into(), message: "no".into() };
        let answer = json!({ "summary": { "cadence_per_min": 55.5, "frames": 3, "complete": true } });
        let lines = [
            Line { id: "1".into(), key: "k".into(), ended: ended(answer, None) },
            Line { id: "b".into(), key: "l".into(), ended: ended(json!(null), Some(failure)) },
            Line { id: "c".into(), key: String::new(), ended: None },
        ];
        let folder = tempfile::tempdir().unwrap();
        let [status, summary] = ["status.parquet", "summary.parquet"].map(|name| folder.path().join(name));
        write(&lines, &status, &summary).unwrap();
        let row = |path: &Path, index: usize| -> Vec<String> {
            cells(path).unwrap().unwrap()[index].1.iter().map(|(_, cell)| cell.clone()).collect()
        };
        assert_eq!(row(&status, 0), ["1", "k", "ok", "", "", "0.5", "1"]);
        assert_eq!(row(&status, 2), ["c", "", "open", "", "", "", ""]);
        // The names of an answer are sorted.
        assert_eq!(row(&summary, 0), ["1", "55.5", "true", "3"]);
        // A list has other columns.
        assert!(manifest::read(&status, None).unwrap_err().to_string().contains("status.parquet:1: needs an `input`"));
        std::fs::write(&status, "PAR1").unwrap();
        assert!(manifest::read(&status, None).unwrap_err().to_string().contains("is no Parquet file"));
    }
}
