//! Tables of numbers with a header row, such as pairs of points and observers.

use std::borrow::Cow;
use std::io::{BufRead, Seek, SeekFrom, Write};
use std::path::Path;

use rayon::prelude::*;
use serde_json::{Map, Value};

use crate::files::output::Output;
use crate::files::source::{Input, Source, extension};
use crate::points::columns::{Column, ExtraColumn, check_lengths, to_column};
use crate::text::text_rows::TextRows;
use belvedere_data::report::{clock_time, rounded};
use belvedere_data::result_columns::{ResultColumn, ResultValues};
use belvedere_data::{Error, Result};

/// Rows printed by one task.
const ROWS_PER_TASK: usize = 1 << 13;
/// Tasks whose text is held in memory at a time.
const TASKS_PER_BLOCK: usize = 32;

/// A table of numbers.
#[derive(Clone, Debug, Default)]
pub struct Table {
    columns: Vec<Vec<f64>>,
    /// Row and text of the first cell of each column that is no number.
    not_numbers: Vec<Option<(usize, String)>>,
    text: TextRows,
}

impl Table {
    /// The rows as they were given.
    #[must_use]
    pub fn into_text(self) -> TextRows {
        self.text
    }

    /// Number of rows below the header.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.text.row_count()
    }

    /// Names of the columns as the file has them.
    #[must_use]
    pub fn names(&self) -> &[String] {
        self.text.names()
    }

    /// The column of that name, upper or lower case, (rows), NaN in empty cells; `None` where there is none.
    ///
    /// # Errors
    /// [`Error::Malformed`] where one of its cells holds text.
    pub fn column(&self, path: &Path, name: &str) -> Result<Option<&[f64]>> {
        let mut places = self.names().iter().enumerate().filter(|(_, own)| own.eq_ignore_ascii_case(name));
        let Some((index, _)) = places.next() else { return Ok(None) };
        if places.next().is_some() {
            return Err(Error::malformed(path, format!("there are two columns {name}; remove or rename one")));
        }
        if let Some(Some((row, text))) = self.not_numbers.get(index) {
            let has_comma = text.replacen(',', ".", 1).parse::<f64>().is_ok();
            let advice = if has_comma { "; write decimal points in place of commas" } else { "" };
            let text: String = text.chars().take(40).collect();
            let what = format!("row {row}: \"{text}\" in column {name} is not a number{advice}");
            return Err(Error::malformed(path, what));
        }
        Ok(self.columns.get(index).map(Vec::as_slice))
    }

    /// The column of that name, of which no cell may be empty.
    ///
    /// # Errors
    /// [`Error::Malformed`] where it is missing, or a cell is empty, text or not finite.
    pub fn full_column(&self, path: &Path, name: &str) -> Result<&[f64]> {
        let column = self.column(path, name)?.ok_or_else(|| {
            let header = Some(self.names().join(", ")).filter(|names| !names.is_empty());
            let header = header.map_or("the file is empty".to_owned(), |names| format!("the header has {names}"));
            Error::malformed(path, format!("there is no column {name}; {header}"))
        })?;
        if let Some(row) = column.iter().position(|v| !v.is_finite()) {
            return Err(Error::malformed(path, format!("row {}: {name} is empty or not finite", row + 1)));
        }
        Ok(column)
    }

    /// Columns of several names, as [`Table::full_column`].
    pub(crate) fn full_columns<const N: usize>(&self, path: &Path, names: [&str; N]) -> Result<[&[f64]; N]> {
        let mut columns = [&[][..]; N];
        for (column, name) in columns.iter_mut().zip(names) {
            *column = self.full_column(path, name)?;
        }
        Ok(columns)
    }

    /// Texts of the column of that name, upper or lower case, (rows); `None` where there is none.
    #[must_use]
    pub fn words(&self, name: &str) -> Option<Vec<&str>> {
        let mut columns = self.text.columns(0..self.row_count()).into_iter();
        columns.find(|(own, _)| own.eq_ignore_ascii_case(name)).map(|(_, words)| words)
    }
}

/// Reads a table with a header row, its cells parted by commas, semicolons or tabs, whichever the header has, in UTF-8
/// or UTF-16. Rows are counted from 1 below the header in messages.
///
/// # Errors
/// [`Error::Io`], and [`Error::Malformed`] for rows of different lengths and for text that is no UTF-8.
pub fn read_table<'a>(source: impl Into<Source<'a>>) -> Result<Table> {
    let Input { name, reader: mut file, .. } = source.into().open_text()?;
    let path = name.as_path();
    let mut header = String::new();
    // a file without line breaks must not fill the memory
    let mut start = std::io::Read::take(&mut file, 1 << 16);
    start.read_line(&mut header).map_err(Error::io(path))?;
    file.seek(SeekFrom::Start(0)).map_err(Error::io(path))?;
    let count = |separator: char| header.matches(separator).count();
    let separator = [';', '\t'].into_iter().find(|&s| count(s) > count(',')).unwrap_or(',');
    let failed = |error: csv::Error| match error.into_kind() {
        csv::ErrorKind::Io(source) => Error::io(path)(source),
        csv::ErrorKind::UnequalLengths { expected_len, len, pos } => {
            let row = pos.map_or(0, |pos| pos.record());
            Error::malformed(path, format!("row {row} has {len} cells, but the header {expected_len}"))
        }
        csv::ErrorKind::Utf8 { .. } => Error::malformed(path, "is no UTF-8 text; save it as CSV UTF-8"),
        other => Error::malformed(path, format!("cannot be read as a table: {other:?}")),
    };
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(u8::try_from(separator).unwrap_or(b','))
        .trim(csv::Trim::All)
        .from_reader(file);
    let names: Vec<String> =
        reader.headers().map_err(failed)?.iter().map(|name| name.trim_start_matches('\u{feff}').to_owned()).collect();
    let mut table = Table {
        columns: vec![Vec::new(); names.len()],
        not_numbers: vec![None; names.len()],
        text: TextRows::new(names),
    };
    let mut record = csv::StringRecord::new();
    while reader.read_record(&mut record).map_err(failed)? {
        table.text.push(&record);
        let number = table.text.row_count();
        for ((cell, column), not_number) in record.iter().zip(&mut table.columns).zip(&mut table.not_numbers) {
            let value = if cell.is_empty() { Some(f64::NAN) } else { cell.parse().ok() };
            if value.is_none() && not_number.is_none() {
                *not_number = Some((number, cell.to_owned()));
            }
            column.push(value.unwrap_or(f64::NAN));
        }
    }
    Ok(table)
}

fn length(values: &ResultValues) -> usize {
    match values {
        ResultValues::Real(values, _) | ResultValues::Clock(values) => values.len(),
        ResultValues::Whole(values) => values.len(),
        ResultValues::Words(values) => values.len(),
    }
}

/// The cell of a row as JSON; null where it is empty.
fn json_value(values: &ResultValues, row: usize) -> Value {
    match values {
        ResultValues::Real(values, decimals) => {
            let decimals = i32::try_from(*decimals).unwrap_or(i32::MAX);
            values.get(row).map_or(Value::Null, |value| rounded(*value, decimals).into())
        }
        ResultValues::Clock(values) => {
            values.get(row).filter(|hours| hours.is_finite()).map(|hours| clock_time(*hours)).into()
        }
        ResultValues::Whole(values) => values.get(row).copied().flatten().into(),
        ResultValues::Words(words) => words.get(row).cloned().into(),
    }
}

/// Prints the cell of a row: nothing where it has no value.
fn print(values: &ResultValues, row: usize, separator: char, text: &mut Vec<u8>) -> std::io::Result<()> {
    match values {
        ResultValues::Real(values, decimals) => match values.get(row) {
            Some(value) if value.is_finite() => write!(text, "{value:.decimals$}"),
            _ => Ok(()),
        },
        ResultValues::Clock(values) => match values.get(row) {
            Some(hours) if hours.is_finite() => write!(text, "{}", clock_time(*hours)),
            _ => Ok(()),
        },
        ResultValues::Whole(values) => match values.get(row) {
            Some(Some(value)) => write!(text, "{value}"),
            _ => Ok(()),
        },
        ResultValues::Words(words) => {
            text.write_all(quoted(words.get(row).map_or("", String::as_str), separator).as_bytes())
        }
    }
}

/// Returns the separator of the cells of a table of that name.
fn separator_of(path: &Path) -> char {
    if ["txt", "xyz"].contains(&extension(path).as_str()) { ' ' } else { ',' }
}

/// A word as a cell of a table.
fn quoted(word: &str, separator: char) -> Cow<'_, str> {
    let is_empty_between_blanks = separator == ' ' && word.is_empty();
    let is_plain = !word.contains([separator, '"', '\n', '\r']) && !is_empty_between_blanks;
    if is_plain { Cow::Borrowed(word) } else { Cow::Owned(format!("\"{}\"", word.replace('"', "\"\""))) }
}

/// Writes `columns` as a table with a header row, cells parted by commas. Numbers that are not finite are empty cells.
///
/// # Errors
/// [`Error::LengthMismatch`] unless all columns are equally long, [`Error::Io`].
pub fn write_table<'a>(output: impl Into<Output<'a>>, columns: &[ResultColumn]) -> Result<()> {
    let mut lengths = columns.iter().map(|column| length(&column.values));
    let expected = lengths.next().unwrap_or(0);
    if let Some(found) = lengths.find(|length| *length != expected) {
        return Err(Error::LengthMismatch { what: "cells of a column", expected, found });
    }
    let print = |start: usize| {
        let mut text = Vec::new();
        for row in start..expected.min(start + ROWS_PER_TASK) {
            for (i, column) in columns.iter().enumerate() {
                if i > 0 {
                    text.push(b',');
                }
                print(&column.values, row, ',', &mut text)?;
            }
            text.push(b'\n');
        }
        Ok(text)
    };
    output.into().write(|path, output| {
        let names: Vec<Cow<'_, str>> = columns.iter().map(|column| quoted(&column.name, ',')).collect();
        writeln!(output, "{}", names.join(",")).map_err(Error::io(path))?;
        let starts: Vec<usize> = (0..expected).step_by(ROWS_PER_TASK).collect();
        for block in starts.chunks(TASKS_PER_BLOCK) {
            let texts: Vec<std::io::Result<Vec<u8>>> = block.par_iter().map(|&start| print(start)).collect();
            for text in texts {
                output.write_all(&text.map_err(Error::io(path))?).map_err(Error::io(path))?;
            }
        }
        Ok(())
    })
}

/// Properties of the GeoJSON feature of a row.
#[must_use]
pub fn row_properties(columns: &[ResultColumn], row: usize) -> Map<String, Value> {
    columns.iter().map(|column| (column.name.clone(), json_value(&column.values, row))).collect()
}

/// Combines the columns of a table of `results` with rows that were `read` from a table ([`TextRows::columns`]).
/// Results that are among the `given` names are written as they were read, with their number only where nothing was.
/// The other columns read follow behind them, unless a result has their name.
#[must_use]
pub fn with_columns_read(read: &[(&str, Vec<&str>)], given: &[&str], results: Vec<ResultColumn>) -> Vec<ResultColumn> {
    let is_result = |name: &str| results.iter().any(|own| own.name.eq_ignore_ascii_case(name));
    let carried: Vec<_> = read.iter().filter(|(name, _)| !is_result(name)).collect();
    let is_given = |column: &ResultColumn| given.iter().any(|name| name.eq_ignore_ascii_case(&column.name));
    let (given, others): (Vec<_>, Vec<_>) = results.into_iter().partition(is_given);
    let as_read = |ResultColumn { name, values }: ResultColumn| {
        let texts = read.iter().find(|(own, _)| own.eq_ignore_ascii_case(&name)).map(|(_, texts)| texts);
        let values = match (texts, values) {
            (Some(texts), ResultValues::Real(values, decimals)) => ResultValues::Words(
                texts.iter().enumerate().map(|(row, text)| given_text(text, values.get(row), decimals)).collect(),
            ),
            (_, values) => values,
        };
        ResultColumn { name, values }
    };
    let carried = carried.into_iter().map(|(name, texts)| ResultColumn::words(*name, texts.iter().copied()));
    given.into_iter().map(as_read).chain(carried).chain(others).collect()
}

/// A cell as it was read; where it is empty, the number with so many decimals.
fn given_text(text: &str, value: Option<&f64>, decimals: usize) -> String {
    match value.filter(|value| text.is_empty() && value.is_finite()) {
        Some(value) => format!("{value:.decimals$}"),
        None => text.to_owned(),
    }
}

/// Writes rows as they were given, with `results` behind them, as a table: cells parted by commas (.csv) or blanks
/// (.txt .xyz). A given column that has the name of a result is replaced by it.
///
/// # Errors
/// [`Error::LengthMismatch`] where a result does not have a value for each row, [`Error::Io`].
pub fn write_text_rows<'a>(output: impl Into<Output<'a>>, rows: &TextRows, results: &[ExtraColumn<'_>]) -> Result<()> {
    let results: Vec<Column<'_>> = results.iter().map(to_column).collect();
    check_lengths(&results, rows.row_count())?;
    let is_replaced = |name: &str| results.iter().any(|result| result.name.eq_ignore_ascii_case(name));
    let kept: Vec<usize> = (0..rows.names().len()).filter(|&i| !is_replaced(&rows.names()[i])).collect();
    output.into().write(|path, output| {
        let separator = separator_of(path);
        let names = kept.iter().map(|&i| quoted(&rows.names()[i], separator));
        let names: Vec<Cow<'_, str>> = names.chain(results.iter().map(|result| Cow::Borrowed(&*result.name))).collect();
        writeln!(output, "{}", names.join(&separator.to_string())).map_err(Error::io(path))?;
        let between = if separator == ' ' { b' ' } else { b',' };
        let mut line = Vec::new();
        for row in 0..rows.row_count() {
            line.clear();
            for &column in &kept {
                line.extend(quoted(rows.cell(row, column), separator).bytes());
                line.push(between);
            }
            for result in &results {
                result.values.print(row, &mut line).map_err(Error::io(path))?;
                line.push(between);
            }
            line.pop();
            line.push(b'\n');
            output.write_all(&line).map_err(Error::io(path))?;
        }
        Ok(())
    })
}
