//! Stations of a scanner from tables.

use crate::files::source::{Source, refuse_other_shapes};
use crate::points::rows::to_u16;
use crate::text::table::read_table;
use belvedere_data::crs::Crs;
use belvedere_data::{Error, Result};

/// Reads the positions of a scanner from a table (.csv .txt) with the columns station (the point source id of its
/// points), x, y and z. Coordinates are those of the cloud's file, whose system is `crs`. Returns ids and positions,
/// metres in that system.
///
/// # Errors
/// [`Error::UnknownFormat`], [`Error::Malformed`] for missing columns, empty cells, ids that are no whole number up to
/// 65 535 or occur twice, and files without stations; the errors of [`read_table`].
pub fn read_stations<'a>(source: impl Into<Source<'a>>, crs: &Crs) -> Result<Vec<(u16, [f64; 3])>> {
    let source = source.into();
    let name = source.name().to_owned();
    let path = name.as_path();
    refuse_other_shapes(path)?;
    if !matches!(source.extension().as_str(), "csv" | "txt") {
        return Err(Error::UnknownFormat { path: path.to_owned(), kind: "stations", supported: ".csv .txt" });
    }
    let table = read_table(source)?;
    let [x, y, z] = table.full_columns(path, ["x", "y", "z"])?;
    let scale = crs.metres_per_unit_xyz();
    let mut stations: Vec<(u16, [f64; 3])> = Vec::new();
    for (row, &number) in table.full_column(path, "station")?.iter().enumerate() {
        let id = to_u16(number);
        if f64::from(id) != number {
            let what = format!("row {}: station {number} is not a point source id, 0 to 65535", row + 1);
            return Err(Error::malformed(path, what));
        }
        if stations.iter().any(|(other, _)| *other == id) {
            return Err(Error::malformed(path, format!("row {}: station {id} is there twice", row + 1)));
        }
        stations.push((id, [x[row] * scale[0], y[row] * scale[1], z[row] * scale[2]]));
    }
    if stations.is_empty() {
        return Err(Error::malformed(path, "the file has no station"));
    }
    Ok(stations)
}
