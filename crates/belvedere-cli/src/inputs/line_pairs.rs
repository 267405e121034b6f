//! Ends of lines of sight: typed, random, or from a file.

use crate::arguments::{LinesArguments, MapPosition, refuse};
use crate::outputs::formats::extension;
use crate::run::CommandContext;
use anyhow::{Result, bail};
use belvedere::Frame;
use belvedere::apps::ask::{Scene, Standing};
use belvedere::io::{FEATURE_EXTENSIONS, FeatureShape, MapFeature, TextRows, property, read_features, read_table};
use belvedere::query::random_pairs;
use serde_json::Value;
use std::path::Path;

/// Columns of a table of pairs.
pub(crate) const ENDS: [&str; 6] = ["ax", "ay", "az", "bx", "by", "bz"];
/// Columns or properties of the heights of observer and target above the ground, as ArcGIS names them, in the unit of
/// the file.
const HEIGHTS: [&str; 2] = ["OFFSETA", "OFFSETB"];

/// Observer and target of each line, and the rows of the table they are from.
pub(crate) fn pairs(
    lines: &LinesArguments,
    scene: &Scene,
    run: &CommandContext,
) -> Result<(Vec<[Standing; 2]>, TextRows)> {
    let frame = scene.frame();
    if let (Some(from), Some(to)) = (&lines.from, &lines.to) {
        let bounds = scene.model().bounds();
        let local = |&MapPosition(place, z): &MapPosition| Standing::on_map(place, z, frame, &bounds);
        return Ok((vec![[local(from)?, local(to)?]], TextRows::default()));
    }
    if let Some(count) = lines.random {
        let bounds = scene.model().bounds();
        let pairs = random_pairs(bounds.low, bounds.high, count, run.seed);
        return Ok((pairs.into_iter().map(|ends| ends.map(standing)).collect(), TextRows::default()));
    }
    let Some(path) = &lines.pairs else {
        return refuse("lines of sight are missing: give --pairs, --random, or --observer and --target");
    };
    if FEATURE_EXTENSIONS.contains(&extension(path).as_str()) {
        let features = run.stage("reading pairs", 0, |_| read_features(path, &frame.crs))?;
        return Ok((ends_of_lines(path, &features, frame)?, TextRows::default()));
    }
    let table = run.stage("reading pairs", 0, |_| read_table(path))?;
    let mut columns: [&[f64]; 6] = [&[]; 6];
    for (column, name) in columns.iter_mut().zip(ENDS) {
        let is_height = name.ends_with('z');
        *column = if is_height { table.column(path, name)?.unwrap_or(&[]) } else { table.full_column(path, name)? };
    }
    let heights = HEIGHTS.map(|name| table.column(path, name));
    let [above_observer, above_target] = heights;
    let heights = [above_observer?.unwrap_or(&[]), above_target?.unwrap_or(&[])];
    let unit = frame.crs.metres_per_unit_xyz()[2];
    let end = |row: usize, end: usize| {
        let place = std::array::from_fn(|i| columns[3 * end + i].get(row).copied().unwrap_or(f64::NAN));
        let height = heights[end].get(row).filter(|height| height.is_finite()).map(|height| height * unit);
        Standing { height, ..standing(frame.local_from_file(place)) }
    };
    let pairs = (0..table.row_count()).map(|row| [end(row, 0), end(row, 1)]).collect();
    Ok((pairs, table.into_text()))
}

/// The first and the last corner of each line, local metres.
fn ends_of_lines(path: &Path, features: &[MapFeature], frame: &Frame) -> Result<Vec<[Standing; 2]>> {
    let unit = frame.crs.metres_per_unit_xyz()[2];
    let local = |corner: &[f64; 3]| std::array::from_fn(|axis| corner[axis] - frame.origin[axis]);
    let end = |corner: &[f64; 3], feature: &MapFeature, name: &str| {
        let height = property(&feature.properties, name).and_then(Value::as_f64).map(|height| height * unit);
        Standing { height, ..standing(local(corner)) }
    };
    let ends = |(number, feature): (usize, &MapFeature)| match &feature.shape {
        FeatureShape::Line(corners) if corners.len() > 1 => {
            let [above_observer, above_target] = HEIGHTS;
            Ok([end(&corners[0], feature, above_observer), end(&corners[corners.len() - 1], feature, above_target)])
        }
        _ => bail!("{}: feature {} is not a line; lines of sight need lines", path.display(), number + 1),
    };
    let pairs: Vec<_> = features.iter().enumerate().map(ends).collect::<Result<_>>()?;
    if pairs.is_empty() {
        bail!("{}: the file has no line", path.display());
    }
    Ok(pairs)
}

fn standing(place: [f64; 3]) -> Standing {
    Standing { place, height: None }
}
