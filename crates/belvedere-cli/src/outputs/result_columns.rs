//! Columns of results as tables.

use anyhow::Result;
use belvedere::apps::result_columns::{ResultColumn, ResultValues};
use belvedere::io::{TableCells, write_table};
use std::path::Path;

/// Writes columns as a table, behind one of numbers if it is given.
pub(crate) fn write_columns(
    output: &Path,
    numbers: Option<(&str, &[Option<u64>])>,
    columns: &[ResultColumn],
) -> Result<()> {
    let texts: Vec<Vec<&str>> =
        columns.iter().map(|column| words_of(&column.values).iter().map(String::as_str).collect()).collect();
    let mut table: Vec<(&str, TableCells<'_>)> =
        numbers.into_iter().map(|(name, cells)| (name, TableCells::Whole(cells))).collect();
    table.extend(columns.iter().zip(&texts).map(|(column, texts)| {
        let cells = match &column.values {
            ResultValues::Real(values, decimals) => TableCells::Real(values, *decimals),
            ResultValues::Clock(values) => TableCells::Clock(values),
            ResultValues::Whole(values) => TableCells::Whole(values),
            ResultValues::Words(_) => TableCells::Words(texts),
        };
        (&column.name[..], cells)
    }));
    Ok(write_table(output, &table)?)
}

fn words_of(values: &ResultValues) -> &[String] {
    if let ResultValues::Words(words) = values { words } else { &[] }
}
