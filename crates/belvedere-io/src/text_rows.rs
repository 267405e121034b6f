//! The rows of a table as they were given, so that results stand behind the very numbers and names that they belong to.

use std::borrow::Cow;

use crate::columns::{Column, check_lengths};
use crate::columns::{ExtraColumn, to_column};
use crate::output::Output;
use crate::table::{TableCells, quoted, separator_of};
use belvedere_data::{Error, Result};

/// Cells of a table as text, with the names of their columns.
#[derive(Clone, Debug, Default)]
pub struct TextRows {
    names: Vec<String>,
    /// All cells, row after row.
    text: String,
    /// End of each cell.
    ends: Vec<usize>,
}

impl TextRows {
    pub(crate) fn new(names: Vec<String>) -> Self {
        Self { names, ..Self::default() }
    }

    /// Appends a row. Cells that it lacks are empty; those beyond the last name are left out.
    pub(crate) fn push<T: AsRef<str>>(&mut self, cells: impl IntoIterator<Item = T>) {
        let mut cells = cells.into_iter();
        for _ in 0..self.names.len() {
            self.text.push_str(cells.next().as_ref().map_or("", T::as_ref));
            self.ends.push(self.text.len());
        }
    }

    /// Names of the columns.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of rows.
    #[must_use]
    pub fn row_count(&self) -> usize {
        self.ends.len().checked_div(self.names.len()).unwrap_or(0)
    }

    fn cell(&self, row: usize, column: usize) -> &str {
        let index = row * self.names.len() + column;
        let start = index.checked_sub(1).and_then(|before| self.ends.get(before)).copied().unwrap_or(0);
        self.ends.get(index).and_then(|&end| self.text.get(start..end)).unwrap_or_default()
    }

    /// Name and cells of each column, of these rows only.
    #[must_use]
    pub fn columns(&self, rows: impl IntoIterator<Item = usize> + Clone) -> Vec<(&str, Vec<&str>)> {
        let cells = |column: usize| rows.clone().into_iter().map(|row| self.cell(row, column)).collect();
        self.names.iter().enumerate().map(|(column, name)| (name.as_str(), cells(column))).collect()
    }
}

/// Combines the columns of a table of `results` with rows that were `read` from a table ([`TextRows::columns`]).
/// Results that are among the `given` names are written as they were read, with their number only where nothing was.
/// The other columns read follow behind them, unless a result has their name.
#[must_use]
pub fn with_columns_read<'a>(
    read: &'a [(&'a str, Vec<&'a str>)],
    given: &[&str],
    results: &[(&'a str, TableCells<'a>)],
) -> Vec<(&'a str, TableCells<'a>)> {
    let is_among = |names: &[&str], name: &str| names.iter().any(|own| own.eq_ignore_ascii_case(name));
    let (given, others): (Vec<_>, Vec<_>) = results.iter().partition(|(name, _)| is_among(given, name));
    let result_names: Vec<&str> = results.iter().map(|(name, _)| *name).collect();
    let as_read = |(name, cells): (&'a str, TableCells<'a>)| {
        let texts = read.iter().find(|(own, _)| own.eq_ignore_ascii_case(name)).map(|(_, texts)| texts.as_slice());
        match (texts, cells) {
            (Some(texts), TableCells::Real(values, decimals)) => (name, TableCells::Given(texts, values, decimals)),
            _ => (name, cells),
        }
    };
    let carried = read.iter().filter(|(name, _)| !is_among(&result_names, name));
    let carried = carried.map(|(name, texts)| (*name, TableCells::Words(texts.as_slice())));
    given.into_iter().map(as_read).chain(carried).chain(others).collect()
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
    let kept: Vec<usize> = (0..rows.names.len()).filter(|&i| !is_replaced(&rows.names[i])).collect();
    output.into().write(|path, output| {
        let separator = separator_of(path);
        let names = kept.iter().map(|&i| quoted(&rows.names[i], separator));
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
