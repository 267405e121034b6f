//! `belvedere difference` of two tables: rows of the same places, before and after a plan.

use crate::arguments::{DifferenceArguments, refuse, refuse_given};
use crate::outputs::formats::extension;
use crate::run::CommandContext;
use anyhow::{Result, bail};
use belvedere::apps::difference::{Difference, DifferenceReport, difference};
use belvedere::apps::result_columns::ResultColumn;
use belvedere::io::{Table, TextRows, read_table, write_table};
use belvedere::vector::to_f32;
use serde_json::{Map, Value, json};
use std::collections::HashMap;
use std::path::Path;

/// Columns that name a row, the first that both tables have.
const KEYS: [&str; 6] = ["id", "fid", "window", "object", "face", "name"];
/// Columns that name the place of a row.
const PLACE: [&str; 3] = ["x", "y", "z"];
/// Decimals of changes.
const DECIMALS: usize = 4;
/// Maximum number of columns in the summary.
const MAX_LISTED: usize = 5;

/// A table, with the text of its cells.
struct Rows {
    table: Table,
    text: TextRows,
}

/// A column of numbers that both tables have, of the rows that both have: before, after, and the change.
struct Compared {
    name: String,
    ends: [Vec<f64>; 2],
    change: Difference,
}

/// Compares the rows of two tables, and writes the change of each column of numbers.
///
/// # Errors
/// Files that cannot be read, and tables with two equal rows or nothing in common.
pub(super) fn run(arguments: &DifferenceArguments, run: &mut CommandContext) -> Result<()> {
    let flags = [("--relief", arguments.relief.is_some()), ("--title", arguments.title.is_some())];
    refuse_given(&flags, "applies only to rasters")?;
    if let Some(other) = arguments.output.iter().find(|output| extension(output) != "csv") {
        return refuse(format!("-o {}: the difference of tables is a table (.csv)", other.display()));
    }
    let paths = [&arguments.before, &arguments.after].map(|path| path.as_path());
    let [before, after] = [Rows::read(paths[0], run)?, Rows::read(paths[1], run)?];
    let key = key_of(&before, &after, paths)?;
    let [first, second] = [before.keys(&key, paths[0])?, after.keys(&key, paths[1])?];
    let place_after: HashMap<&str, usize> = second.iter().enumerate().map(|(row, key)| (key.as_str(), row)).collect();
    let pairs: Vec<[usize; 2]> =
        first.iter().enumerate().filter_map(|(row, key)| Some([row, *place_after.get(key.as_str())?])).collect();
    if pairs.is_empty() {
        bail!("{}: no row has the {} of a row of {}", paths[1].display(), key.join(", "), paths[0].display());
    }
    let changed = changed(&before, &after, paths, &pairs, &key)?;
    summarise(&changed, pairs.len(), [first.len(), second.len()].map(|count| count - pairs.len()), run);
    for output in &arguments.output {
        run.stage("writing", 0, |_| write(output, &before, &pairs, &changed))?;
    }
    run.summary.add_paths("written", &arguments.output);
    Ok(())
}

impl Rows {
    fn read(path: &Path, run: &CommandContext) -> Result<Self> {
        let table = run.stage("reading", 0, |_| read_table(path))?;
        Ok(Self { text: table.clone().into_text(), table })
    }

    fn has(&self, name: &str) -> bool {
        self.table.names().iter().any(|own| own.eq_ignore_ascii_case(name))
    }

    /// The cells of columns of each row, joined.
    fn keys(&self, names: &[&str], path: &Path) -> Result<Vec<String>> {
        let columns = self.text.columns(0..self.table.row_count());
        let of_key: Vec<&Vec<&str>> = names
            .iter()
            .filter_map(|name| columns.iter().find(|(own, _)| own.eq_ignore_ascii_case(name)).map(|(_, cells)| cells))
            .collect();
        let mut keys = Vec::with_capacity(self.table.row_count());
        let mut seen = HashMap::new();
        for row in 0..self.table.row_count() {
            let key = of_key.iter().map(|cells| cells[row].trim()).collect::<Vec<_>>().join(",");
            if let Some(other) = seen.insert(key.clone(), row) {
                let names = names.join(", ");
                bail!("{}: rows {} and {} have the same {names}: {key}", path.display(), other + 1, row + 1);
            }
            keys.push(key);
        }
        Ok(keys)
    }
}

/// The columns by which rows are found again.
fn key_of(before: &Rows, after: &Rows, paths: [&Path; 2]) -> Result<Vec<&'static str>> {
    let is_in_both = |name: &&&str| before.has(name) && after.has(name);
    if let Some(name) = KEYS.iter().find(is_in_both) {
        // faces of a mesh are numbered within their object
        let beside = if *name == "object" { ["face"].iter().find(is_in_both) } else { None };
        return Ok([*name].into_iter().chain(beside.copied()).collect());
    }
    let place: Vec<&str> = PLACE.iter().filter(is_in_both).copied().collect();
    match place.len() {
        0 | 1 => bail!(
            "{} and {} have no column in common that names their rows; give both a column id",
            paths[0].display(),
            paths[1].display()
        ),
        _ => Ok(place),
    }
}

/// The columns of numbers that both tables have and that differ in one of the `pairs` of rows.
fn changed(
    before: &Rows,
    after: &Rows,
    paths: [&Path; 2],
    pairs: &[[usize; 2]],
    key: &[&str],
) -> Result<Vec<Compared>> {
    let is_named = |name: &str| key.iter().chain(&PLACE).any(|own| own.eq_ignore_ascii_case(name));
    let (mut changed, mut compared) = (Vec::new(), 0);
    for name in before.table.names().iter().filter(|name| !is_named(name)) {
        if !after.has(name) {
            continue;
        }
        let [first, second] = [(before, paths[0]), (after, paths[1])].map(|(rows, path)| rows.table.column(path, name));
        // what is text in both tables is not compared
        if first.is_err() && second.is_err() {
            continue;
        }
        let (Some(first), Some(second)) = (first?, second?) else { continue };
        compared += 1;
        let of_rows = |values: &[f64], end: usize| -> Vec<f64> { pairs.iter().map(|pair| values[pair[end]]).collect() };
        let ends = [of_rows(first, 0), of_rows(second, 1)];
        let [first, second] = [0, 1].map(|end| ends[end].iter().map(|&value| to_f32(value)).collect::<Vec<f32>>());
        let change = difference(&first, &second, 1.0)?;
        let DifferenceReport { cells_gain, cells_loss, cells_only_before, cells_only_after, .. } = change.report;
        if cells_gain + cells_loss + cells_only_before + cells_only_after > 0 {
            changed.push(Compared { name: name.clone(), ends, change });
        }
    }
    if compared == 0 {
        bail!(
            "{} and {} have no column of numbers in common, beside {}",
            paths[0].display(),
            paths[1].display(),
            key.join(", ")
        );
    }
    Ok(changed)
}

fn summarise(changed: &[Compared], rows: usize, [only_before, only_after]: [usize; 2], run: &mut CommandContext) {
    let mut columns = Map::new();
    for (number, Compared { name, change: Difference { report, .. }, .. }) in changed.iter().enumerate() {
        let DifferenceReport { mean_before, mean_after, cells_gain, cells_loss, .. } = *report;
        let (gain, loss) = (report.largest_gain, report.largest_loss);
        if number < MAX_LISTED {
            let gone = report.cells_only_before + report.cells_only_after;
            let one_sided = if gone > 0 { format!("; {gone} with a value in one table only") } else { String::new() };
            run.summary.answer(&format!(
                "{name}: mean {mean_before} before, {mean_after} after; of {rows} rows {cells_gain} gain (at most \
                 {gain}), {cells_loss} lose (at most {}){one_sided}",
                loss.abs()
            ));
        }
        let figures = json!({
            "mean_before": mean_before, "mean_after": mean_after, "rows_gain": cells_gain, "rows_loss": cells_loss,
            "rows_only_before": report.cells_only_before, "rows_only_after": report.cells_only_after,
            "largest_gain": gain, "largest_loss": loss,
        });
        columns.insert(name.clone(), figures);
    }
    match changed.len() {
        0 => run.summary.answer(&format!("nothing changes in {rows} rows")),
        count if count > MAX_LISTED => run.summary.answer(&format!("{} further columns change", count - MAX_LISTED)),
        _ => {}
    }
    if only_before + only_after > 0 {
        let text = format!("rows that one table has alone are left out: {only_before} before, {only_after} after");
        run.summary.warn("rows-left-out", text);
    }
    run.summary.add("difference", json!({ "rows": rows, "columns": Value::Object(columns) }));
}

/// The rows of the table before, with the values before and after of what changes, and their change.
fn write(output: &Path, before: &Rows, pairs: &[[usize; 2]], changed: &[Compared]) -> belvedere::Result<()> {
    let texts = before.text.columns(pairs.iter().map(|pair| pair[0]));
    let carried = texts.iter().filter(|(name, _)| changed.iter().all(|column| column.name != *name));
    let mut columns: Vec<ResultColumn> =
        carried.map(|(name, cells)| ResultColumn::words(*name, cells.iter().copied())).collect();
    for Compared { name, ends: [before, after], change } in changed {
        let column =
            |end: &str, values: &[f64]| ResultColumn::real(format!("{name}_{end}"), values.iter().copied(), DECIMALS);
        let change: Vec<f64> = change.values.iter().map(|&change| f64::from(change)).collect();
        columns.extend([column("before", before), column("after", after), column("change", &change)]);
    }
    write_table(output, &columns)
}
